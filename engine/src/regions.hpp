// Which material each triangle is of, for the engine: materials that some triangle has, each once.
//
// Bodies of several materials are the sum over their regions r:
//
//   M v' = f - sum over r of (J_lambda,r p_lambda,r + J_mu,r p_mu,r),  M = sum of M_r
//   p_lambda,r = sum over its branches of w_lambda + elastic_lambda,r u + viscous_lambda,r v
//
// with J_r summed over the region's triangles, and w on the nodes that these touch: where regions meet, a
// node has residual forces of its own for each of them.
//
// Shapes   of_triangle: m, an index into materials; empty: all 0
// Errors   none: scenes were validated before
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rheo/scene.hpp"

namespace rheo {

struct Regions {
  std::vector<Material> materials;
  std::vector<std::int32_t> of_triangle;

  bool several() const { return materials.size() > 1; }
};

// Equal materials are one region, unused ones none.
Regions regions_of(const Scene& scene);

// All springs of all regions that relax at one rate, by rising rate, each once (relaxations_of,
// material.hpp).
struct SharedRelaxation {
  double rate = 0.0;           // [1/s]
  std::vector<Moduli> moduli;  // by region [Pa]
};
std::vector<SharedRelaxation> relaxations_of(const std::vector<Material>& materials);

}  // namespace rheo
