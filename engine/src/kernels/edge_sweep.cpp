#include "kernels/edge_sweep.hpp"

#include <cassert>

#if defined(__x86_64__) && defined(__GNUC__)
#define RHEO_X86 1
#include <immintrin.h>
#endif

namespace rheo {
namespace {

// Baseline: two lanes or none, as the compiler likes.
void sweep_baseline(const EdgeForm& form, const double* inverse_mass, const SweepMaterial& m, double h,
                    const SweepArrays& a, std::int32_t first_run, std::int32_t last_run) {
  for (std::int32_t r = first_run; r < last_run; ++r) {
    const EdgeForm::Run& run = form.runs[r];
    const double* s = form.s.data() + 3 * run.edge;
    const std::int32_t* neighbour = form.neighbour.data() + run.edge;
    for (std::int32_t i = run.first; i < run.last; ++i) {
      const double* p = a.x_p + 4 * static_cast<std::int64_t>(i);
      double fx = 0.0, fy = 0.0;
      for (std::int32_t k = 0; k < run.valence; ++k, s += 3) {
        const double* q = a.x_p + 4 * static_cast<std::int64_t>(neighbour[k]);
        const double ax = q[1] - p[1];
        const double ay = q[3] - p[3];
        fx += s[0] * (q[0] - p[0]) + s[1] * ax + s[2] * ay;
        fy += s[0] * (q[2] - p[2]) - s[1] * ay + s[2] * ax;
      }
      neighbour += run.valence;
      const std::int64_t i2 = 2 * static_cast<std::int64_t>(i);
      const std::int64_t i4 = 4 * static_cast<std::int64_t>(i);
      const double v[2] = {a.x_v[i2], a.x_v[i2 + 1]};
      a.out_v[i2] = a.base_v[i2] - h * (inverse_mass[i2] * fx);
      a.out_v[i2 + 1] = a.base_v[i2 + 1] - h * (inverse_mass[i2 + 1] * fy);
      for (int k = 0; k < 4; ++k) {
        a.out_p[i4 + k] =
            a.base_p[i4 + k] + h * (m.growth[k] * v[k / 2] + m.own[k] * p[k] + m.cross[k] * p[k ^ 1]);
      }
      if (a.out_u != nullptr) {
        a.out_u[i2] = a.base_u[i2] + h * v[0];
        a.out_u[i2 + 1] = a.base_u[i2 + 1] + h * v[1];
      }
    }
  }
}

#ifdef RHEO_X86

// One node's neighbours, `valence` known to the compiler or, as 0, not.
template <int valence>
__attribute__((target("avx2,fma"), always_inline)) inline void run_avx2(
    const EdgeForm::Run& run, const double* s, const std::int32_t* neighbour, const double* inverse_mass,
    const SweepMaterial& m, double h, const SweepArrays& a) {
  const __m256d growth = _mm256_mul_pd(_mm256_set1_pd(h), _mm256_loadu_pd(m.growth));
  const __m256d own = _mm256_mul_pd(_mm256_set1_pd(h), _mm256_loadu_pd(m.own));
  const __m256d cross = _mm256_mul_pd(_mm256_set1_pd(h), _mm256_loadu_pd(m.cross));
  const __m128d minus_h = _mm_set1_pd(-h);
  const double* x = a.x_p;
  const int count = valence == 0 ? run.valence : valence;
  for (std::int64_t i = run.first; i < run.last; ++i) {
    const __m256d p = _mm256_loadu_pd(x + 4 * i);
    __m256d level = _mm256_setzero_pd();  // s0 db_x, s1 da_x, s0 db_y, s1 da_y
    __m256d mixed = _mm256_setzero_pd();  // -, s2 da_x, -, s2 da_y
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) {
      const __m256d d = _mm256_sub_pd(_mm256_loadu_pd(x + 4 * static_cast<std::int64_t>(neighbour[k])), p);
      level = _mm256_fmadd_pd(_mm256_broadcast_pd(reinterpret_cast<const __m128d*>(s + 3 * k)), d, level);
      mixed = _mm256_fmadd_pd(_mm256_broadcast_sd(s + 3 * k + 2), d, mixed);
    }
    s += 3 * count;
    neighbour += count;
    const __m128d lx = _mm256_castpd256_pd128(level);    // s0 db_x, s1 da_x
    const __m128d ly = _mm256_extractf128_pd(level, 1);  // s0 db_y, s1 da_y
    const __m128d mx = _mm256_castpd256_pd128(mixed);    // -, s2 da_x
    const __m128d my = _mm256_extractf128_pd(mixed, 1);  // -, s2 da_y
    const __m128d s0 = _mm_unpacklo_pd(lx, ly);          // s0 db_x, s0 db_y
    const __m128d s1 = _mm_unpackhi_pd(lx, ly);          // s1 da_x, s1 da_y
    const __m128d s2 = _mm_unpackhi_pd(my, mx);          // s2 da_y, s2 da_x
    const __m128d signed_s1 = _mm_xor_pd(s1, _mm_set_pd(-0.0, 0.0));
    const __m128d force = _mm_add_pd(_mm_add_pd(s0, signed_s1), s2);
    const __m128d v = _mm_loadu_pd(a.x_v + 2 * i);
    const __m128d acceleration = _mm_mul_pd(_mm_loadu_pd(inverse_mass + 2 * i), force);
    const __m128d base_v = _mm_loadu_pd(a.base_v + 2 * i);
    const __m256d base_p = _mm256_loadu_pd(a.base_p + 4 * i);
    const __m256d vv = _mm256_set_m128d(_mm_unpackhi_pd(v, v), _mm_unpacklo_pd(v, v));
    __m256d out = _mm256_fmadd_pd(growth, vv, base_p);
    out = _mm256_fmadd_pd(own, p, out);
    out = _mm256_fmadd_pd(cross, _mm256_permute_pd(p, 0b0101), out);
    _mm256_storeu_pd(a.out_p + 4 * i, out);
    if (a.out_u != nullptr) {
      _mm_storeu_pd(a.out_u + 2 * i, _mm_fmadd_pd(_mm_set1_pd(h), v, _mm_loadu_pd(a.base_u + 2 * i)));
    }
    _mm_storeu_pd(a.out_v + 2 * i, _mm_fmadd_pd(minus_h, acceleration, base_v));
  }
}

__attribute__((target("avx2,fma"))) void sweep_avx2(const EdgeForm& form, const double* inverse_mass,
                                                    const SweepMaterial& m, double h, const SweepArrays& a,
                                                    std::int32_t first_run, std::int32_t last_run) {
  for (std::int32_t r = first_run; r < last_run; ++r) {
    const EdgeForm::Run& run = form.runs[r];
    const double* s = form.s.data() + 3 * run.edge;
    const std::int32_t* neighbour = form.neighbour.data() + run.edge;
    switch (run.valence) {
      case 4:
        run_avx2<4>(run, s, neighbour, inverse_mass, m, h, a);
        break;
      case 5:
        run_avx2<5>(run, s, neighbour, inverse_mass, m, h, a);
        break;
      case 6:
        run_avx2<6>(run, s, neighbour, inverse_mass, m, h, a);
        break;
      case 7:
        run_avx2<7>(run, s, neighbour, inverse_mass, m, h, a);
        break;
      case 8:
        run_avx2<8>(run, s, neighbour, inverse_mass, m, h, a);
        break;
      default:
        run_avx2<0>(run, s, neighbour, inverse_mass, m, h, a);
        break;
    }
  }
}

#endif

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
  if (level == SimdLevel::baseline) return true;
#ifdef RHEO_X86
  if (level == SimdLevel::avx2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
  return false;
}

SimdLevel best_simd_level() {
  return has_simd_level(SimdLevel::avx2) ? SimdLevel::avx2 : SimdLevel::baseline;
}

SweepFunction sweep_function(SimdLevel level) {
  assert(has_simd_level(level));
#ifdef RHEO_X86
  if (level == SimdLevel::avx2) return sweep_avx2;
#endif
  (void)level;
  return sweep_baseline;
}

}  // namespace rheo
