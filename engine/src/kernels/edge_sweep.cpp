#include "kernels/edge_sweep.hpp"

#include <cassert>

#include "kernels/edge_sweep_x86.hpp"

namespace rheo {
namespace {

// Baseline: two lanes or none, as the compiler likes.
template <int row, int level_row>
void sweep_baseline(const EdgeForm& form, const double* inverse_mass, const SweepMaterial& m, double h,
                    const SweepArrays& a, std::int32_t first_run, std::int32_t last_run) {
  for (std::int32_t r = first_run; r < last_run; ++r) {
    const EdgeForm::Run& run = form.runs[r];
    for (std::int64_t i = run.first; i < run.last; ++i) {
      const double* p = a.x_p + row * i;
      double along[row] = {}, across[row] = {};
      const EdgeForm::Edges edges = run.edges_of(i);
      std::int64_t e = edges.edge;
      for (std::int32_t k = 0; k < run.valence; ++k, e += edges.stride) {
        const double* kept = form.level.data() + level_row * e;
        double level[row];
        for (int c = 0; c < row; ++c)
          level[c] = c < level_row ? kept[c] : 2 * kept[c % 2] + kept[(c + 1) % 2];
        const double mixed = form.mixed[e];
        const double* q = a.x_p + form.offset[e];
        for (int c = 0; c < row; ++c) {
          const double d = q[c] - p[c];
          along[c] += level[c] * d;
          across[c] += mixed * d;
        }
      }
      double fx = along[0] + across[1], fy = along[1] + across[0];
      if constexpr (row == 4) {
        fx += along[2] + across[3];
        fy += along[3] + across[2];
      }
      const double v[2] = {a.x_v[2 * i], a.x_v[2 * i + 1]};
      a.out_v[2 * i] = a.base_v[2 * i] - h * (inverse_mass[2 * i] * fx);
      a.out_v[2 * i + 1] = a.base_v[2 * i + 1] - h * (inverse_mass[2 * i + 1] * fy);
      for (int c = 0; c < row; ++c) {
        a.out_p[row * i + c] = a.base_p[row * i + c] + h * (m.growth[c] * v[c % 2] - m.decay[c] * p[c]);
      }
      if (a.out_u != nullptr) {
        a.out_u[2 * i] = a.base_u[2 * i] + h * v[0];
        a.out_u[2 * i + 1] = a.base_u[2 * i + 1] + h * v[1];
      }
    }
  }
}

}  // namespace

const char* name_of(SimdLevel level) {
  switch (level) {
    case SimdLevel::avx512:
      return "avx512";
    case SimdLevel::avx2:
      return "avx2";
    case SimdLevel::baseline:
      break;
  }
  return "baseline";
}

bool has_simd_level(SimdLevel level) {
#ifdef RHEO_X86_SWEEPS
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (level == SimdLevel::avx2) return avx2;
  if (level == SimdLevel::avx512) {
    return avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512dq");
  }
#endif
  return level == SimdLevel::baseline;
}

SimdLevel best_simd_level() {
  if (has_simd_level(SimdLevel::avx512)) return SimdLevel::avx512;
  return has_simd_level(SimdLevel::avx2) ? SimdLevel::avx2 : SimdLevel::baseline;
}

SweepFunction sweep_function(SimdLevel level, const EdgeForm& form) {
  assert(has_simd_level(level));
  const auto pick = [&](SweepFunction ready, SweepFunction summed, SweepFunction combined) {
    return form.row == 2 ? combined : form.level_row == 2 ? summed : ready;
  };
#ifdef RHEO_X86_SWEEPS
  if (level == SimdLevel::avx512) return pick(sweep_avx512, sweep_summed_avx512, sweep_combined_avx512);
  if (level == SimdLevel::avx2) return pick(sweep_avx2, sweep_summed_avx2, sweep_combined_avx2);
#endif
  (void)level;
  return pick(sweep_baseline<4, 4>, sweep_baseline<4, 2>, sweep_baseline<2, 2>);
}

}  // namespace rheo
