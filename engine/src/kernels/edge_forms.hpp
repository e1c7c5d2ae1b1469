// Quadratic forms of the connection matrices by edges, for energies: sums over the edges of some runs.
//
//   x^T J_lambda w = - sum over edges of dx^T S dw          and the boundary's antisymmetric part,
//   x^T J_mu w     = - sum of dx^T (S + trace(S) I) dw      (h / 4) rot(w_next - w_previous), + and -
//
// Differences alone are looked at: a body's motion as a whole leaves no rounding of its own.
//
// Shapes   w: n x 4, rows (l, m); or n x 2, one vector that is both; x: n x 2; in the kernel's order
// Errors   none
// Not here combined branches (EdgeForm::moduli), whose edges keep other numbers
#pragma once

#include <cstdint>

#include "kernels/edge_form.hpp"
#include "kernels/edge_sweep.hpp"

namespace rheo {

// w_l^T J_lambda w_l, w_m^T J_mu w_m, and with x for the first w.
struct EdgeForms {
  double ll = 0.0, mm = 0.0, xl = 0.0, xm = 0.0;

  EdgeForms& operator+=(const EdgeForms& other) {
    ll += other.ll, mm += other.mm, xl += other.xl, xm += other.xm;
    return *this;
  }
};

// The edges' part, of the runs first_run .. last_run - 1.
using EdgeFormsFunction = EdgeForms (*)(const EdgeForm& form, const double* w, const double* x,
                                        std::int32_t first_run, std::int32_t last_run);

struct EdgeFormsFunctions {
  EdgeFormsFunction rows = nullptr;  // w: n x 4
  EdgeFormsFunction both = nullptr;  // w: n x 2
};
EdgeFormsFunctions edge_forms_functions(SimdLevel level, const EdgeForm& form);

// The boundary's part; stride: 4 or 2.
EdgeForms boundary_forms(const EdgeForm& form, const double* w, std::size_t stride, const double* x);

}  // namespace rheo
