// What materials of several parts cost beside the rheological force: work at each node by itself.
//
//   w_k' = growth_k v - decay_k w_k        for each branch, a row (l_x, l_y, m_x, m_y) a node
//   p    = elastic u + viscous v + sum over k of w_k        the row that kernels gather (edge_form.hpp)
//
// Shapes   w, p: 4 a node; u, v: 2 a node
// Errors   none
#pragma once

#include <cstdint>

#include "kernels/edge_sweep.hpp"

namespace rheo {

// out_p = elastic u + viscous v of `count` nodes.
struct ParallelPart {
  double elastic[4] = {}, viscous[4] = {};  // lambda twice, mu twice
};

struct BranchRows {
  // p from u and v alone.
  void (*begin)(const ParallelPart& part, const double* u, const double* v, double* p, std::int64_t count);
  // out_w = base_w + h (growth x_v - decay x_w), added to p.
  void (*advance)(const SweepMaterial& material, double h, const double* x_v, const double* x_w,
                  const double* base_w, double* out_w, double* p, std::int64_t count);
};

BranchRows branch_rows(SimdLevel level);

}  // namespace rheo
