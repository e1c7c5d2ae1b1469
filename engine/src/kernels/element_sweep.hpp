// The two loops of a sweep over the element form: forces by triangle, then the step of the nodes.
//
//   add_forces   F += B^T s of each triangle at its slots (element_form.hpp)
//   advance      v_out = v + h (- F / m),  p_out = p + h (growth v - decay p),  u_out = u + h v,  F = 0
//
// The same arithmetic in baseline, AVX2 and AVX-512 code, chosen at run time by what the processor has. Each
// rounds in its own way; each alone is deterministic.
//
// Shapes   p: s x 4 (l_x, l_y, m_x, m_y), force: s x 2; v, u, inverse_mass (zero where a degree of freedom is
//          held): n x 2
// Errors   none
#pragma once

#include <cstdint>

#include "kernels/edge_sweep.hpp"
#include "kernels/element_form.hpp"

namespace rheo {

// Nodes with one slot each, of one region; pointers to the first of them.
struct NodeStretch {
  std::int64_t count = 0;
  SweepArrays arrays;
  const double* inverse_mass = nullptr;
  double* force = nullptr;
};

struct ElementSweep {
  void (*add_forces)(const ElementForm& form, const double* p, double* force, std::int64_t first_triangle,
                     std::int64_t last_triangle) = nullptr;
  void (*advance)(const NodeStretch& nodes, const SweepMaterial& material, double h) = nullptr;
};

ElementSweep element_sweep(SimdLevel level);

}  // namespace rheo
