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
    const std::uint32_t* offset = form.offset.data() + run.edge;
    for (std::int64_t i = run.first; i < run.last; ++i) {
      const double* p = a.x_p + 4 * i;
      double s0[4] = {}, s1[4] = {}, s2[4] = {};
      for (std::int32_t k = 0; k < run.valence; ++k, s += 3, ++offset) {
        const double* q = a.x_p + *offset;
        for (int c = 0; c < 4; ++c) {
          const double d = q[c] - p[c];
          s0[c] += s[0] * d;
          s1[c] += s[1] * d;
          s2[c] += s[2] * d;
        }
      }
      const double fx = s0[0] + 3 * s0[2] + (s1[0] + s1[2]) + (s2[1] + s2[3]);
      const double fy = s0[1] + 3 * s0[3] - (s1[1] + s1[3]) + (s2[0] + s2[2]);
      const double v[2] = {a.x_v[2 * i], a.x_v[2 * i + 1]};
      a.out_v[2 * i] = a.base_v[2 * i] - h * (inverse_mass[2 * i] * fx);
      a.out_v[2 * i + 1] = a.base_v[2 * i + 1] - h * (inverse_mass[2 * i + 1] * fy);
      for (int c = 0; c < 4; ++c) {
        a.out_p[4 * i + c] = a.base_p[4 * i + c] + h * (m.growth[c] * v[c % 2] - m.decay[c] * p[c]);
      }
      if (a.out_u != nullptr) {
        a.out_u[2 * i] = a.base_u[2 * i] + h * v[0];
        a.out_u[2 * i + 1] = a.base_u[2 * i + 1] + h * v[1];
      }
    }
  }
}

#ifdef RHEO_X86

// A run of nodes whose valence the compiler knows (or, as 0, does not): four lanes are the four numbers of a
// node, no shuffles inside. Written once; each target below compiles it with its own instructions (AVX-512VL
// broadcasts the three numbers of an edge inside the multiplications).
template <int valence>
[[gnu::always_inline, gnu::target("avx2,fma")]] inline void sweep_run(
    const EdgeForm::Run& run, const double* s, const std::uint32_t* offset, const double* inverse_mass,
    const SweepMaterial& m, double h, const SweepArrays& a) {
  const __m256d growth = _mm256_mul_pd(_mm256_set1_pd(h), _mm256_loadu_pd(m.growth));
  const __m256d decay = _mm256_mul_pd(_mm256_set1_pd(h), _mm256_loadu_pd(m.decay));
  const __m128d h2 = _mm_set1_pd(h);
  const __m128d three = _mm_set1_pd(3.0);
  const double* x = a.x_p;
  const int count = valence == 0 ? run.valence : valence;
  for (std::int64_t i = run.first; i < run.last; ++i) {
    const __m256d p = _mm256_loadu_pd(x + 4 * i);
    __m256d s0 = _mm256_setzero_pd(), s1 = _mm256_setzero_pd(), s2 = _mm256_setzero_pd();  // of - dw
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) {
      const __m256d d = _mm256_sub_pd(p, _mm256_loadu_pd(x + offset[k]));
      s0 = _mm256_fmadd_pd(_mm256_set1_pd(s[3 * k]), d, s0);
      s1 = _mm256_fmadd_pd(_mm256_set1_pd(s[3 * k + 1]), d, s1);
      s2 = _mm256_fmadd_pd(_mm256_set1_pd(s[3 * k + 2]), d, s2);
    }
    s += 3 * count;
    offset += count;
    // (x, y) pairs of - F.
    const __m128d level = _mm_fmadd_pd(three, _mm256_extractf128_pd(s0, 1), _mm256_castpd256_pd128(s0));
    const __m128d across = _mm_add_pd(_mm256_extractf128_pd(s1, 1), _mm256_castpd256_pd128(s1));
    const __m128d mixed = _mm_add_pd(_mm256_extractf128_pd(s2, 1), _mm256_castpd256_pd128(s2));
    const __m128d signed_across = _mm_xor_pd(across, _mm_set_pd(-0.0, 0.0));
    const __m128d pull = _mm_add_pd(_mm_add_pd(level, signed_across), _mm_shuffle_pd(mixed, mixed, 1));
    const __m128d acceleration = _mm_mul_pd(_mm_loadu_pd(inverse_mass + 2 * i), pull);
    const __m128d v = _mm_loadu_pd(a.x_v + 2 * i);
    const __m128d out_v = _mm_fmadd_pd(h2, acceleration, _mm_loadu_pd(a.base_v + 2 * i));
    const __m256d out_p = _mm256_fmadd_pd(growth, _mm256_set_m128d(v, v), _mm256_loadu_pd(a.base_p + 4 * i));
    _mm256_storeu_pd(a.out_p + 4 * i, _mm256_fnmadd_pd(decay, p, out_p));
    if (a.out_u != nullptr)
      _mm_storeu_pd(a.out_u + 2 * i, _mm_fmadd_pd(h2, v, _mm_loadu_pd(a.base_u + 2 * i)));
    _mm_storeu_pd(a.out_v + 2 * i, out_v);
  }
}

#define RHEO_SWEEP(name, instructions)                                                            \
  [[gnu::target(instructions)]] void name(const EdgeForm& form, const double* inverse_mass,       \
                                          const SweepMaterial& m, double h, const SweepArrays& a, \
                                          std::int32_t first_run, std::int32_t last_run) {        \
    for (std::int32_t r = first_run; r < last_run; ++r) {                                         \
      const EdgeForm::Run& run = form.runs[r];                                                    \
      const double* s = form.s.data() + 3 * run.edge;                                             \
      const std::uint32_t* offset = form.offset.data() + run.edge;                                \
      switch (run.valence) {                                                                      \
        case 4:                                                                                   \
          sweep_run<4>(run, s, offset, inverse_mass, m, h, a);                                    \
          break;                                                                                  \
        case 5:                                                                                   \
          sweep_run<5>(run, s, offset, inverse_mass, m, h, a);                                    \
          break;                                                                                  \
        case 6:                                                                                   \
          sweep_run<6>(run, s, offset, inverse_mass, m, h, a);                                    \
          break;                                                                                  \
        case 7:                                                                                   \
          sweep_run<7>(run, s, offset, inverse_mass, m, h, a);                                    \
          break;                                                                                  \
        case 8:                                                                                   \
          sweep_run<8>(run, s, offset, inverse_mass, m, h, a);                                    \
          break;                                                                                  \
        default:                                                                                  \
          sweep_run<0>(run, s, offset, inverse_mass, m, h, a);                                    \
          break;                                                                                  \
      }                                                                                           \
    }                                                                                             \
  }

RHEO_SWEEP(sweep_avx2, "avx2,fma")
RHEO_SWEEP(sweep_avx512, "avx2,fma,avx512f,avx512vl,avx512dq")

#undef RHEO_SWEEP

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
#ifdef RHEO_X86
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

SweepFunction sweep_function(SimdLevel level) {
  assert(has_simd_level(level));
#ifdef RHEO_X86
  if (level == SimdLevel::avx512) return sweep_avx512;
  if (level == SimdLevel::avx2) return sweep_avx2;
#endif
  (void)level;
  return sweep_baseline;
}

}  // namespace rheo
