#include "kernels/edge_sweep_x86.hpp"

#ifdef RHEO_X86_SWEEPS

#include "kernels/edge_lanes_x86.hpp"

namespace rheo {
namespace {

// Where a run's edges and nodes are, and copies of the arrays: the compiler takes every store for a change of
// what a reference leads to.
struct Cursor {
  Cursor(const EdgeForm& form, const EdgeForm::Run& run)
      : level(form.level.data() + form.level_row * run.edge),
        mixed(form.mixed.data() + run.edge),
        offset(form.offset.data() + run.edge),
        node(run.first),
        last(run.last) {}

  void pass(std::int64_t edges, int level_row) {
    level += level_row * edges;
    mixed += edges;
    offset += edges;
  }

  const double* level;
  const double* mixed;
  const std::uint32_t* offset;
  std::int64_t node;
  std::int64_t last;
};

// Of two edges in a row.
template <Level kept>
RHEO_INLINE(RHEO_AVX512)
__m512d levels_of(const double* level, int k) {
  if constexpr (kept == Level::ready) return _mm512_loadu_pd(level + 4 * k);
  const __m512d both = _mm512_castpd256_pd512(_mm256_loadu_pd(level + 2 * k));
  const __m512d straight = _mm512_permutexvar_pd(_mm512_set_epi64(3, 2, 3, 2, 1, 0, 1, 0), both);
  const __m512d crossed =
      _mm512_maskz_permutexvar_pd(0b11001100, _mm512_set_epi64(2, 3, 0, 0, 0, 1, 0, 0), both);
  return _mm512_fmadd_pd(_mm512_set_pd(2, 2, 1, 1, 2, 2, 1, 1), straight, crossed);
}

// Sums of -F in lanes (l_x, l_y, m_x, m_y), of `level` and of `mixed`: (x, y) of -F.
RHEO_INLINE(RHEO_AVX2) __m128d pull_of(__m256d along, __m256d across) {
  const __m128d straight = _mm_add_pd(_mm256_extractf128_pd(along, 1), _mm256_castpd256_pd128(along));
  const __m128d crossed = _mm_add_pd(_mm256_extractf128_pd(across, 1), _mm256_castpd256_pd128(across));
  return _mm_add_pd(straight, _mm_shuffle_pd(crossed, crossed, 1));
}

// v and p of one node from its pull.
RHEO_INLINE(RHEO_AVX2)
void finish_node(std::int64_t i, __m256d p, __m128d pull, const double* inverse_mass, __m256d growth,
                 __m256d decay, __m128d h, const SweepArrays& a) {
  const __m128d acceleration = _mm_mul_pd(_mm_loadu_pd(inverse_mass + 2 * i), pull);
  const __m128d v = _mm_loadu_pd(a.x_v + 2 * i);
  const __m128d out_v = _mm_fmadd_pd(h, acceleration, _mm_loadu_pd(a.base_v + 2 * i));
  const __m256d out_p = _mm256_fmadd_pd(growth, _mm256_set_m128d(v, v), _mm256_loadu_pd(a.base_p + 4 * i));
  _mm256_storeu_pd(a.out_p + 4 * i, _mm256_fnmadd_pd(decay, p, out_p));
  if (a.out_u != nullptr) _mm_storeu_pd(a.out_u + 2 * i, _mm_fmadd_pd(h, v, _mm_loadu_pd(a.base_u + 2 * i)));
  _mm_storeu_pd(a.out_v + 2 * i, out_v);
}

// A last node without a partner.
template <Level kept>
RHEO_INLINE(RHEO_AVX2)
void single(const Cursor& c, int valence, const double* inverse_mass, __m256d growth, __m256d decay,
            __m128d h, const SweepArrays& a) {
  const __m256d p = _mm256_loadu_pd(a.x_p + 4 * c.node);
  __m256d along = _mm256_setzero_pd(), across = _mm256_setzero_pd();
  for (int k = 0; k < valence; ++k) {
    const __m256d d = _mm256_sub_pd(p, _mm256_loadu_pd(a.x_p + c.offset[k]));
    along = _mm256_fmadd_pd(level_of<kept>(c.level, k), d, along);
    across = _mm256_fmadd_pd(_mm256_set1_pd(c.mixed[k]), d, across);
  }
  finish_node(c.node, p, pull_of(along, across), inverse_mass, growth, decay, h, a);
}

// A run of nodes whose valence the compiler knows (or, as 0, does not).
template <int known, Level kept>
RHEO_INLINE(RHEO_AVX2)
void run_avx2(Cursor c, int valence, const double* inverse_mass, const SweepMaterial& m, double step,
              const SweepArrays a) {
  const __m256d growth = _mm256_mul_pd(_mm256_set1_pd(step), _mm256_loadu_pd(m.growth));
  const __m256d decay = _mm256_mul_pd(_mm256_set1_pd(step), _mm256_loadu_pd(m.decay));
  const __m128d h = _mm_set1_pd(step);
  const int count = known == 0 ? valence : known;
  for (; c.node + 1 < c.last; c.node += 2, c.pass(2 * count, kept == Level::ready ? 4 : 2)) {
    const __m256d p0 = _mm256_loadu_pd(a.x_p + 4 * c.node);
    const __m256d p1 = _mm256_loadu_pd(a.x_p + 4 * c.node + 4);
    __m256d along0 = _mm256_setzero_pd(), along1 = along0, across0 = along0, across1 = along0;
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) {
      const __m256d d0 = _mm256_sub_pd(p0, _mm256_loadu_pd(a.x_p + c.offset[2 * k]));
      const __m256d d1 = _mm256_sub_pd(p1, _mm256_loadu_pd(a.x_p + c.offset[2 * k + 1]));
      along0 = _mm256_fmadd_pd(level_of<kept>(c.level, 2 * k), d0, along0);
      along1 = _mm256_fmadd_pd(level_of<kept>(c.level, 2 * k + 1), d1, along1);
      across0 = _mm256_fmadd_pd(_mm256_set1_pd(c.mixed[2 * k]), d0, across0);
      across1 = _mm256_fmadd_pd(_mm256_set1_pd(c.mixed[2 * k + 1]), d1, across1);
    }
    finish_node(c.node, p0, pull_of(along0, across0), inverse_mass, growth, decay, h, a);
    finish_node(c.node + 1, p1, pull_of(along1, across1), inverse_mass, growth, decay, h, a);
  }
  if (c.node < c.last) single<kept>(c, count, inverse_mass, growth, decay, h, a);
}

// Both nodes in one register, the first in its lower half.
template <int known, Level kept>
RHEO_INLINE(RHEO_AVX512)
void run_avx512(Cursor c, int valence, const double* inverse_mass, const SweepMaterial& m, double step,
                const SweepArrays a) {
  const __m256d growth = _mm256_mul_pd(_mm256_set1_pd(step), _mm256_loadu_pd(m.growth));
  const __m256d decay = _mm256_mul_pd(_mm256_set1_pd(step), _mm256_loadu_pd(m.decay));
  const __m512d growths = _mm512_broadcast_f64x4(growth), decays = _mm512_broadcast_f64x4(decay);
  const __m256d h = _mm256_set1_pd(step);
  // The k-th pair of eight numbers, each over its node's half.
  const __m512i spread[4] = {
      _mm512_set_epi64(1, 1, 1, 1, 0, 0, 0, 0), _mm512_set_epi64(3, 3, 3, 3, 2, 2, 2, 2),
      _mm512_set_epi64(5, 5, 5, 5, 4, 4, 4, 4), _mm512_set_epi64(7, 7, 7, 7, 6, 6, 6, 6)};
  const __m512i twice = _mm512_set_epi64(3, 2, 3, 2, 1, 0, 1, 0);
  const __m512i once = _mm512_set_epi64(5, 4, 1, 0, 5, 4, 1, 0);
  const int count = known == 0 ? valence : known;
  for (; c.node + 1 < c.last; c.node += 2, c.pass(2 * count, kept == Level::ready ? 4 : 2)) {
    const __m512d p = _mm512_loadu_pd(a.x_p + 4 * c.node);
    __m512d along = _mm512_setzero_pd(), across = _mm512_setzero_pd(), mixed = _mm512_setzero_pd();
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) {
      if (k % 4 == 0) mixed = _mm512_loadu_pd(c.mixed + 2 * k);
      const __m512d q = _mm512_insertf64x4(_mm512_zextpd256_pd512(_mm256_loadu_pd(a.x_p + c.offset[2 * k])),
                                           _mm256_loadu_pd(a.x_p + c.offset[2 * k + 1]), 1);
      const __m512d d = _mm512_sub_pd(p, q);
      along = _mm512_fmadd_pd(levels_of<kept>(c.level, 2 * k), d, along);
      across = _mm512_fmadd_pd(_mm512_permutexvar_pd(spread[k % 4], mixed), d, across);
    }
    // Lanes (x, y) of lambda and mu of each node; `mixed` pulls x by y.
    const __m512d lanes = _mm512_add_pd(along, _mm512_permute_pd(across, 0x55));
    const __m512d sums = _mm512_add_pd(lanes, _mm512_shuffle_f64x2(lanes, lanes, 0b10110001));
    const __m256d pull = _mm512_castpd512_pd256(_mm512_permutexvar_pd(once, sums));
    const std::int64_t i = 2 * c.node;
    const __m256d acceleration = _mm256_mul_pd(_mm256_loadu_pd(inverse_mass + i), pull);
    const __m256d v = _mm256_loadu_pd(a.x_v + i);
    const __m256d out_v = _mm256_fmadd_pd(h, acceleration, _mm256_loadu_pd(a.base_v + i));
    const __m512d both_v = _mm512_permutexvar_pd(twice, _mm512_zextpd256_pd512(v));
    const __m512d out_p = _mm512_fmadd_pd(growths, both_v, _mm512_loadu_pd(a.base_p + 2 * i));
    _mm512_storeu_pd(a.out_p + 2 * i, _mm512_fnmadd_pd(decays, p, out_p));
    if (a.out_u != nullptr)
      _mm256_storeu_pd(a.out_u + i, _mm256_fmadd_pd(h, v, _mm256_loadu_pd(a.base_u + i)));
    _mm256_storeu_pd(a.out_v + i, out_v);
  }
  if (c.node < c.last) single<kept>(c, count, inverse_mass, growth, decay, _mm256_castpd256_pd128(h), a);
}

// Combined branches: two numbers a node, both nodes in one register of four lanes.
template <int known>
RHEO_INLINE(RHEO_AVX2)
void run_combined(Cursor c, int valence, const double* inverse_mass, const SweepMaterial& m, double step,
                  const SweepArrays a) {
  const __m256d growth = _mm256_set1_pd(step * m.growth[0]);
  const __m256d decay = _mm256_set1_pd(step * m.decay[0]);
  const __m256d h = _mm256_set1_pd(step);
  const int count = known == 0 ? valence : known;
  for (; c.node + 1 < c.last; c.node += 2, c.pass(2 * count, 2)) {
    const std::int64_t i = 2 * c.node;
    const __m256d p = _mm256_loadu_pd(a.x_p + i);
    __m256d along = _mm256_setzero_pd(), across = _mm256_setzero_pd(), mixed = _mm256_setzero_pd();
#pragma GCC unroll 8
    for (int k = 0; k < count; ++k) {
      if (k % 2 == 0) mixed = _mm256_loadu_pd(c.mixed + 2 * k);
      const __m256d q = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(a.x_p + c.offset[2 * k])),
                                             _mm_loadu_pd(a.x_p + c.offset[2 * k + 1]), 1);
      const __m256d d = _mm256_sub_pd(p, q);
      along = _mm256_fmadd_pd(_mm256_loadu_pd(c.level + 4 * k), d, along);
      const __m256d kxy =
          k % 2 == 0 ? _mm256_permute4x64_pd(mixed, 0b01010000) : _mm256_permute4x64_pd(mixed, 0b11111010);
      across = _mm256_fmadd_pd(kxy, d, across);
    }
    const __m256d pull = _mm256_add_pd(along, _mm256_permute_pd(across, 0b0101));
    const __m256d acceleration = _mm256_mul_pd(_mm256_loadu_pd(inverse_mass + i), pull);
    const __m256d v = _mm256_loadu_pd(a.x_v + i);
    const __m256d out_v = _mm256_fmadd_pd(h, acceleration, _mm256_loadu_pd(a.base_v + i));
    const __m256d out_p = _mm256_fmadd_pd(growth, v, _mm256_loadu_pd(a.base_p + i));
    _mm256_storeu_pd(a.out_p + i, _mm256_fnmadd_pd(decay, p, out_p));
    if (a.out_u != nullptr)
      _mm256_storeu_pd(a.out_u + i, _mm256_fmadd_pd(h, v, _mm256_loadu_pd(a.base_u + i)));
    _mm256_storeu_pd(a.out_v + i, out_v);
  }
  if (c.node == c.last) return;
  const std::int64_t i = 2 * c.node;
  const __m128d p = _mm_loadu_pd(a.x_p + i);
  __m128d along = _mm_setzero_pd(), across = _mm_setzero_pd();
  for (int k = 0; k < count; ++k) {
    const __m128d d = _mm_sub_pd(p, _mm_loadu_pd(a.x_p + c.offset[k]));
    along = _mm_fmadd_pd(_mm_loadu_pd(c.level + 2 * k), d, along);
    across = _mm_fmadd_pd(_mm_set1_pd(c.mixed[k]), d, across);
  }
  const __m128d pull = _mm_add_pd(along, _mm_permute_pd(across, 0b01));
  const __m128d acceleration = _mm_mul_pd(_mm_loadu_pd(inverse_mass + i), pull);
  const __m128d v = _mm_loadu_pd(a.x_v + i);
  const __m128d half_h = _mm256_castpd256_pd128(h);
  const __m128d out_v = _mm_fmadd_pd(half_h, acceleration, _mm_loadu_pd(a.base_v + i));
  const __m128d out_p = _mm_fmadd_pd(_mm256_castpd256_pd128(growth), v, _mm_loadu_pd(a.base_p + i));
  _mm_storeu_pd(a.out_p + i, _mm_fnmadd_pd(_mm256_castpd256_pd128(decay), p, out_p));
  if (a.out_u != nullptr) _mm_storeu_pd(a.out_u + i, _mm_fmadd_pd(half_h, v, _mm_loadu_pd(a.base_u + i)));
  _mm_storeu_pd(a.out_v + i, out_v);
}

}  // namespace

// All runs, each by its valence.
#define RHEO_SWEEP(name, instructions, run_function, ...)                                         \
  [[gnu::target(instructions)]] void name(const EdgeForm& form, const double* inverse_mass,       \
                                          const SweepMaterial& m, double h, const SweepArrays& a, \
                                          std::int32_t first_run, std::int32_t last_run) {        \
    for (std::int32_t r = first_run; r < last_run; ++r) {                                         \
      const EdgeForm::Run& run = form.runs[r];                                                    \
      const Cursor cursor(form, run);                                                             \
      switch (run.valence) {                                                                      \
        case 4:                                                                                   \
          run_function<4 __VA_OPT__(, ) __VA_ARGS__>(cursor, 4, inverse_mass, m, h, a);           \
          break;                                                                                  \
        case 5:                                                                                   \
          run_function<5 __VA_OPT__(, ) __VA_ARGS__>(cursor, 5, inverse_mass, m, h, a);           \
          break;                                                                                  \
        case 6:                                                                                   \
          run_function<6 __VA_OPT__(, ) __VA_ARGS__>(cursor, 6, inverse_mass, m, h, a);           \
          break;                                                                                  \
        case 7:                                                                                   \
          run_function<7 __VA_OPT__(, ) __VA_ARGS__>(cursor, 7, inverse_mass, m, h, a);           \
          break;                                                                                  \
        case 8:                                                                                   \
          run_function<8 __VA_OPT__(, ) __VA_ARGS__>(cursor, 8, inverse_mass, m, h, a);           \
          break;                                                                                  \
        default:                                                                                  \
          run_function<0 __VA_OPT__(, ) __VA_ARGS__>(cursor, run.valence, inverse_mass, m, h, a); \
          break;                                                                                  \
      }                                                                                           \
    }                                                                                             \
  }

RHEO_SWEEP(sweep_avx2, RHEO_AVX2, run_avx2, Level::ready)
RHEO_SWEEP(sweep_avx512, RHEO_AVX512, run_avx512, Level::ready)
RHEO_SWEEP(sweep_summed_avx2, RHEO_AVX2, run_avx2, Level::summed)
RHEO_SWEEP(sweep_summed_avx512, RHEO_AVX512, run_avx512, Level::summed)
RHEO_SWEEP(sweep_combined_avx2, RHEO_AVX2, run_combined)
RHEO_SWEEP(sweep_combined_avx512, RHEO_AVX512, run_combined)

#undef RHEO_SWEEP

}  // namespace rheo

#endif
