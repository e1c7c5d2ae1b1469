// One sweep of the edge form for a lumped body with eliminated constraints: out = base + h (A x + g), fused.
//
//   v' = (f - F(p)) / m,  p' = growth v - decay p,  u' = v
//   p = (l_x, l_y, m_x, m_y), l = w_lambda, m = w_mu, or, combined, p = (q_x, q_y)
//
// The same arithmetic in baseline, AVX2 and AVX-512 code, chosen at run time by what the processor has. Each
// rounds in its own way; each alone is deterministic, whatever the number of threads.
//
// Shapes   p: n x row (edge_form.hpp), v: n x 2, inverse_mass: n x 2 (zero where a degree of freedom is
// held),
//          all in the kernel's order
// Errors   none
#pragma once

#include <cstdint>

#include "kernels/edge_form.hpp"

namespace rheo {

struct SweepArrays {
  const double* x_p = nullptr;
  const double* x_v = nullptr;
  const double* base_p = nullptr;
  const double* base_v = nullptr;
  double* out_p = nullptr;
  double* out_v = nullptr;
  const double* base_u = nullptr;  // null where this sweep leaves u alone
  double* out_u = nullptr;
};

struct SweepMaterial {
  double growth[4] = {};  // lambda_ela twice, mu_ela twice; combined: 1
  double decay[4] = {};   // the rates
};

enum class SimdLevel { baseline, avx2, avx512 };

const char* name_of(SimdLevel level);
// The best that this processor and this build have.
SimdLevel best_simd_level();
bool has_simd_level(SimdLevel level);

// The runs first_run .. last_run - 1.
using SweepFunction = void (*)(const EdgeForm& form, const double* inverse_mass,
                               const SweepMaterial& material, double h, const SweepArrays& arrays,
                               std::int32_t first_run, std::int32_t last_run);
SweepFunction sweep_function(SimdLevel level, const EdgeForm& form);

}  // namespace rheo
