#include "kernels/element_sweep.hpp"

#include <cassert>

#if defined(__x86_64__) && defined(__GNUC__)
#define RHEO_X86 1
#include <immintrin.h>
#ifndef __clang__
// GCC 12 takes the undefined inputs of its own AVX-512 intrinsics for a mistake of ours (its bug 105593).
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#endif

namespace rheo {
namespace {

void add_forces_baseline(const ElementForm& form, const double* p, double* force, std::int64_t first,
                         std::int64_t last) {
  for (std::int64_t e = first; e < last; ++e) {
    const double* q = form.gradient[e].data();  // b_1, c_1, b_2, c_2
    const auto& corner = form.offset[e];
    const double* p0 = p + corner[0];
    const double* p1 = p + corner[1];
    const double* p2 = p + corner[2];
    double gx[4], gy[4];
    for (int k = 0; k < 4; ++k) {
      const double d1 = p1[k] - p0[k], d2 = p2[k] - p0[k];
      gx[k] = q[0] * d1 + q[2] * d2;
      gy[k] = q[1] * d1 + q[3] * d2;
    }
    const double divergence = gx[0] + gy[1];
    const double s_xx = divergence + 2 * gx[2];
    const double s_yy = divergence + 2 * gy[3];
    const double s_xy = gx[3] + gy[2];
    const double f1x = q[0] * s_xx + q[1] * s_xy, f1y = q[0] * s_xy + q[1] * s_yy;
    const double f2x = q[2] * s_xx + q[3] * s_xy, f2y = q[2] * s_xy + q[3] * s_yy;
    double* f0 = force + corner[0] / 2;
    double* f1 = force + corner[1] / 2;
    double* f2 = force + corner[2] / 2;
    f0[0] -= f1x + f2x;
    f0[1] -= f1y + f2y;
    f1[0] += f1x;
    f1[1] += f1y;
    f2[0] += f2x;
    f2[1] += f2y;
  }
}

void advance_baseline(const NodeStretch& nodes, const SweepMaterial& m, double h) {
  const SweepArrays& a = nodes.arrays;
  for (std::int64_t i = 0; i < nodes.count; ++i) {
    const double v[2] = {a.x_v[2 * i], a.x_v[2 * i + 1]};
    for (std::int64_t k = 2 * i; k < 2 * i + 2; ++k) {
      a.out_v[k] = a.base_v[k] - h * (nodes.inverse_mass[k] * nodes.force[k]);
      nodes.force[k] = 0.0;
    }
    for (int c = 0; c < 4; ++c) {
      const std::int64_t k = 4 * i + c;
      a.out_p[k] = a.base_p[k] + h * (m.growth[c] * v[c % 2] - m.decay[c] * a.x_p[k]);
    }
    if (a.out_u != nullptr) {
      a.out_u[2 * i] = a.base_u[2 * i] + h * v[0];
      a.out_u[2 * i + 1] = a.base_u[2 * i + 1] + h * v[1];
    }
  }
}

#ifdef RHEO_X86

// A slot's force, 2 numbers, from its offset, 4 x slot: an address that needs no instruction of its own.
[[gnu::always_inline]] inline double* at(double* force, std::uint32_t corner) {
  return reinterpret_cast<double*>(reinterpret_cast<char*>(force) + sizeof(double) / 2 * std::size_t{corner});
}

[[gnu::always_inline, gnu::target("avx2,fma")]] inline void add(double* force, __m128d f) {
  _mm_storeu_pd(force, _mm_add_pd(_mm_loadu_pd(force), f));
}

// One triangle: four lanes are the four numbers of a node, then the pairs of two nodes' forces.
[[gnu::always_inline, gnu::target("avx2,fma")]] inline void add_force(
    const std::array<double, 4>& gradient, const std::array<std::uint32_t, 3>& corner, const double* p,
    double* force) {
  const double* g = gradient.data();
  const __m256d p0 = _mm256_loadu_pd(p + corner[0]);
  const __m256d d1 = _mm256_sub_pd(_mm256_loadu_pd(p + corner[1]), p0);
  const __m256d d2 = _mm256_sub_pd(_mm256_loadu_pd(p + corner[2]), p0);
  const __m256d x =  // d/dx of (l_x, l_y, m_x, m_y)
      _mm256_fmadd_pd(_mm256_set1_pd(g[2]), d2, _mm256_mul_pd(_mm256_set1_pd(g[0]), d1));
  const __m256d y = _mm256_fmadd_pd(_mm256_set1_pd(g[3]), d2, _mm256_mul_pd(_mm256_set1_pd(g[1]), d1));
  const __m256d along = _mm256_blend_pd(x, y, 0b1010);                 // l_x,x l_y,y m_x,x m_y,y
  const __m256d across = _mm256_shuffle_pd(x, y, 0b0101);              // l_y,x l_x,y m_y,x m_x,y
  const __m256d z = _mm256_blend_pd(along, across, 0b1100);            // l_x,x l_y,y m_y,x m_x,y
  const __m256d sum = _mm256_add_pd(z, _mm256_permute_pd(z, 0b0101));  // div div s_xy s_xy
  const __m256d normal = _mm256_fmadd_pd(_mm256_set1_pd(2.0), _mm256_permute4x64_pd(along, 0b11101110),
                                         _mm256_permute4x64_pd(sum, 0b01000100));  // s_xx s_yy twice
  const __m256d shear = _mm256_permute4x64_pd(sum, 0b11101110);
  const __m256d q = _mm256_loadu_pd(g);
  const __m256d c = _mm256_mul_pd(_mm256_permute_pd(q, 0b1111), _mm256_unpackhi_pd(shear, normal));
  const __m256d f = _mm256_fmadd_pd(_mm256_movedup_pd(q), _mm256_unpacklo_pd(normal, shear), c);
  const __m128d f1 = _mm256_castpd256_pd128(f), f2 = _mm256_extractf128_pd(f, 1);
  double* force0 = at(force, corner[0]);
  _mm_storeu_pd(force0, _mm_sub_pd(_mm_loadu_pd(force0), _mm_add_pd(f1, f2)));
  add(at(force, corner[1]), f1);
  add(at(force, corner[2]), f2);
}

[[gnu::target("avx2,fma")]] void add_forces_avx2(const ElementForm& form, const double* p, double* force,
                                                 std::int64_t first, std::int64_t last) {
  const std::array<double, 4>* gradient = form.gradient.data();
  const std::array<std::uint32_t, 3>* corner = form.offset.data();
  for (std::int64_t e = first; e < last; ++e) add_force(gradient[e], corner[e], p, force);
}

[[gnu::always_inline, gnu::target("avx2,fma,avx512f,avx512vl,avx512dq")]] inline __m512d side_by_side(
    const double* a, const double* b) {
  return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(a)), _mm256_loadu_pd(b), 1);
}

// Two triangles side by side, each in the lanes of above.
[[gnu::target("avx2,fma,avx512f,avx512vl,avx512dq")]] void add_forces_avx512(const ElementForm& form,
                                                                             const double* p, double* force,
                                                                             std::int64_t first,
                                                                             std::int64_t last) {
  const std::array<double, 4>* gradient = form.gradient.data();
  const std::array<std::uint32_t, 3>* corner = form.offset.data();
  const __m512d two = _mm512_set1_pd(2.0);
  std::int64_t e = first;
  for (; e + 1 < last; e += 2) {
    const std::uint32_t* i = corner[e].data();
    const std::uint32_t* k = corner[e + 1].data();
    const __m512d q = _mm512_loadu_pd(gradient[e].data());
    const __m512d p0 = side_by_side(p + i[0], p + k[0]);
    const __m512d d1 = _mm512_sub_pd(side_by_side(p + i[1], p + k[1]), p0);
    const __m512d d2 = _mm512_sub_pd(side_by_side(p + i[2], p + k[2]), p0);
    const __m512d x = _mm512_fmadd_pd(_mm512_permutex_pd(q, 0b10101010), d2,
                                      _mm512_mul_pd(_mm512_permutex_pd(q, 0b00000000), d1));
    const __m512d y = _mm512_fmadd_pd(_mm512_permutex_pd(q, 0b11111111), d2,
                                      _mm512_mul_pd(_mm512_permutex_pd(q, 0b01010101), d1));
    const __m512d along = _mm512_mask_blend_pd(0b10101010, x, y);
    const __m512d across = _mm512_shuffle_pd(x, y, 0b01010101);
    const __m512d z = _mm512_mask_blend_pd(0b11001100, along, across);
    const __m512d sum = _mm512_add_pd(z, _mm512_permute_pd(z, 0b01010101));
    const __m512d normal =
        _mm512_fmadd_pd(two, _mm512_permutex_pd(along, 0b11101110), _mm512_permutex_pd(sum, 0b01000100));
    const __m512d shear = _mm512_permutex_pd(sum, 0b11101110);
    const __m512d c = _mm512_mul_pd(_mm512_permute_pd(q, 0b11111111), _mm512_unpackhi_pd(shear, normal));
    const __m512d f = _mm512_fmadd_pd(_mm512_movedup_pd(q), _mm512_unpacklo_pd(normal, shear), c);
    const __m256d fi = _mm512_castpd512_pd256(f), fk = _mm512_extractf64x4_pd(f, 1);
    const __m128d fi1 = _mm256_castpd256_pd128(fi), fi2 = _mm256_extractf128_pd(fi, 1);
    const __m128d fk1 = _mm256_castpd256_pd128(fk), fk2 = _mm256_extractf128_pd(fk, 1);
    double* fi0 = at(force, i[0]);
    _mm_storeu_pd(fi0, _mm_sub_pd(_mm_loadu_pd(fi0), _mm_add_pd(fi1, fi2)));
    add(at(force, i[1]), fi1);
    add(at(force, i[2]), fi2);
    double* fk0 = at(force, k[0]);
    _mm_storeu_pd(fk0, _mm_sub_pd(_mm_loadu_pd(fk0), _mm_add_pd(fk1, fk2)));
    add(at(force, k[1]), fk1);
    add(at(force, k[2]), fk2);
  }
  if (e < last) add_force(gradient[e], corner[e], p, force);
}

[[gnu::always_inline, gnu::target("avx2,fma")]] inline void advance_node(const NodeStretch& nodes,
                                                                         const SweepMaterial& m, double h,
                                                                         std::int64_t i) {
  const SweepArrays& a = nodes.arrays;
  const __m256d growth = _mm256_mul_pd(_mm256_set1_pd(h), _mm256_loadu_pd(m.growth));
  const __m256d decay = _mm256_mul_pd(_mm256_set1_pd(h), _mm256_loadu_pd(m.decay));
  const __m128d v = _mm_loadu_pd(a.x_v + 2 * i);
  const __m128d braking =
      _mm_mul_pd(_mm_loadu_pd(nodes.inverse_mass + 2 * i), _mm_loadu_pd(nodes.force + 2 * i));
  _mm_storeu_pd(nodes.force + 2 * i, _mm_setzero_pd());
  const __m256d grown = _mm256_fmadd_pd(growth, _mm256_set_m128d(v, v), _mm256_loadu_pd(a.base_p + 4 * i));
  _mm256_storeu_pd(a.out_p + 4 * i, _mm256_fnmadd_pd(decay, _mm256_loadu_pd(a.x_p + 4 * i), grown));
  if (a.out_u != nullptr)
    _mm_storeu_pd(a.out_u + 2 * i, _mm_fmadd_pd(_mm_set1_pd(h), v, _mm_loadu_pd(a.base_u + 2 * i)));
  _mm_storeu_pd(a.out_v + 2 * i, _mm_fnmadd_pd(_mm_set1_pd(h), braking, _mm_loadu_pd(a.base_v + 2 * i)));
}

// Two nodes' pairs (x, y) side by side.
[[gnu::always_inline, gnu::target("avx2,fma")]] inline void advance_pairs(const NodeStretch& nodes, __m256d h,
                                                                          std::int64_t i, __m256d v) {
  const SweepArrays& a = nodes.arrays;
  const __m256d braking =
      _mm256_mul_pd(_mm256_loadu_pd(nodes.inverse_mass + 2 * i), _mm256_loadu_pd(nodes.force + 2 * i));
  _mm256_storeu_pd(nodes.force + 2 * i, _mm256_setzero_pd());
  if (a.out_u != nullptr)
    _mm256_storeu_pd(a.out_u + 2 * i, _mm256_fmadd_pd(h, v, _mm256_loadu_pd(a.base_u + 2 * i)));
  _mm256_storeu_pd(a.out_v + 2 * i, _mm256_fnmadd_pd(h, braking, _mm256_loadu_pd(a.base_v + 2 * i)));
}

[[gnu::target("avx2,fma")]] void advance_avx2(const NodeStretch& nodes, const SweepMaterial& m, double h) {
  const __m256d growth = _mm256_mul_pd(_mm256_set1_pd(h), _mm256_loadu_pd(m.growth));
  const __m256d decay = _mm256_mul_pd(_mm256_set1_pd(h), _mm256_loadu_pd(m.decay));
  const SweepArrays& a = nodes.arrays;
  const auto residual = [&](std::int64_t k, __m256d v) __attribute__((target("avx2,fma"))) {
    const __m256d grown = _mm256_fmadd_pd(growth, v, _mm256_loadu_pd(a.base_p + k));
    _mm256_storeu_pd(a.out_p + k, _mm256_fnmadd_pd(decay, _mm256_loadu_pd(a.x_p + k), grown));
  };
  std::int64_t i = 0;
  for (; i + 1 < nodes.count; i += 2) {
    const __m256d v = _mm256_loadu_pd(a.x_v + 2 * i);
    residual(4 * i, _mm256_permute4x64_pd(v, 0b01000100));
    residual(4 * i + 4, _mm256_permute4x64_pd(v, 0b11101110));
    advance_pairs(nodes, _mm256_set1_pd(h), i, v);
  }
  if (i < nodes.count) advance_node(nodes, m, h, i);
}

[[gnu::target("avx2,fma,avx512f,avx512vl,avx512dq")]] void advance_avx512(const NodeStretch& nodes,
                                                                          const SweepMaterial& m, double h) {
  const __m512d growth = _mm512_mul_pd(_mm512_set1_pd(h), _mm512_broadcast_f64x4(_mm256_loadu_pd(m.growth)));
  const __m512d decay = _mm512_mul_pd(_mm512_set1_pd(h), _mm512_broadcast_f64x4(_mm256_loadu_pd(m.decay)));
  const SweepArrays& a = nodes.arrays;
  std::int64_t i = 0;
  for (; i + 1 < nodes.count; i += 2) {
    const __m256d v = _mm256_loadu_pd(a.x_v + 2 * i);
    const __m512d both = _mm512_castpd256_pd512(v);
    const __m512d grown = _mm512_fmadd_pd(growth, _mm512_shuffle_f64x2(both, both, 0b01010000),
                                          _mm512_loadu_pd(a.base_p + 4 * i));
    _mm512_storeu_pd(a.out_p + 4 * i, _mm512_fnmadd_pd(decay, _mm512_loadu_pd(a.x_p + 4 * i), grown));
    advance_pairs(nodes, _mm256_set1_pd(h), i, v);
  }
  if (i < nodes.count) advance_node(nodes, m, h, i);
}

#endif

}  // namespace

ElementSweep element_sweep(SimdLevel level) {
  assert(has_simd_level(level));
#ifdef RHEO_X86
  if (level == SimdLevel::avx512) return {add_forces_avx512, advance_avx512};
  if (level == SimdLevel::avx2) return {add_forces_avx2, advance_avx2};
#endif
  (void)level;
  return {add_forces_baseline, advance_baseline};
}

}  // namespace rheo
