// What AVX2 and AVX-512 code over the edge form's runs has in common; for .cpp files of such code only.
//
// Errors   none
#pragma once

#include "kernels/edge_form.hpp"

#if defined(__x86_64__) && defined(__GNUC__)
#ifndef RHEO_X86_SWEEPS
#define RHEO_X86_SWEEPS 1
#endif

// GCC 12 warns of its own header (its bug 105593).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif
#include <immintrin.h>

#define RHEO_AVX2 "avx2,fma"
#define RHEO_AVX512 "avx2,fma,avx512f,avx512vl,avx512dq"
#define RHEO_INLINE(instructions) [[gnu::always_inline, gnu::target(instructions)]] inline

namespace rheo {

// An edge's level in the lanes (xx, yy, 2 xx + yy, 2 yy + xx) of which two are kept.
RHEO_INLINE(RHEO_AVX2) __m256d summed_level(const double* kept) {
  const __m256d twice = _mm256_broadcast_pd(reinterpret_cast<const __m128d*>(kept));
  const __m256d other = _mm256_blend_pd(_mm256_setzero_pd(), _mm256_permute_pd(twice, 0b0101), 0b1100);
  return _mm256_fmadd_pd(_mm256_set_pd(2, 2, 1, 1), twice, other);
}

// The k-th edge's.
template <Level kept>
RHEO_INLINE(RHEO_AVX2)
__m256d level_of(const double* level, int k) {
  if constexpr (kept == Level::summed) return summed_level(level + 2 * k);
  return _mm256_loadu_pd(level + 4 * k);
}

}  // namespace rheo

#endif
