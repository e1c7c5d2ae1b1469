// Every eigenvalue of the operator on (v, w_lambda, w_mu) of a small body, for limits that hang on the
// damping of single modes.
//
//   v' = - P M^-1 (J_lambda w_lambda + J_mu w_mu),  w_lambda' = ela v - rate w_lambda, w_mu' likewise
//
// P is the projection by the constraints; u feeds on nothing and is left out. Dense: (3 n)^3 operations for n
// free degrees of freedom, hence for small ones only.
//
// Source   design: full operator where rates matter; Eigen's QR algorithm for the eigenvalues
// Units    eigenvalues [1/s]
// Errors   none: empty beyond `most_free_dofs`
#pragma once

#include <complex>
#include <vector>

#include "constraints.hpp"
#include "model.hpp"

namespace rheo {

inline constexpr int most_free_dofs = 160;

std::vector<std::complex<double>> full_spectrum(const Model& model, const ConstraintSolver& solver);

}  // namespace rheo
