#include "kernels/branch_rows.hpp"

#include <cassert>

namespace rheo {
namespace {

#if defined(__x86_64__) && defined(__GNUC__)
#define RHEO_X86_ROWS 1
#define RHEO_ALWAYS [[gnu::always_inline]] inline
#else
#define RHEO_ALWAYS inline
#endif

RHEO_ALWAYS void begin_rows(const ParallelPart& part, const double* u, const double* v, double* p,
                            std::int64_t count) {
  const ParallelPart m = part;
  for (std::int64_t i = 0; i < count; ++i) {
    for (int c = 0; c < 4; ++c)
      p[4 * i + c] = m.elastic[c] * u[2 * i + c % 2] + m.viscous[c] * v[2 * i + c % 2];
  }
}

// The state that is read may be the one that is written: each number is read before it is.
RHEO_ALWAYS void advance_rows(const SweepMaterial& material, double h, const double* x_v, const double* x_w,
                              const double* base_w, double* out_w, double* p, std::int64_t count) {
  double growth[4], decay[4];
  for (int c = 0; c < 4; ++c) {
    growth[c] = h * material.growth[c];
    decay[c] = h * material.decay[c];
  }
  for (std::int64_t i = 0; i < count; ++i) {
    double w[4];
    for (int c = 0; c < 4; ++c)
      w[c] = base_w[4 * i + c] + growth[c] * x_v[2 * i + c % 2] - decay[c] * x_w[4 * i + c];
    for (int c = 0; c < 4; ++c) out_w[4 * i + c] = w[c];
    for (int c = 0; c < 4; ++c) p[4 * i + c] += w[c];
  }
}

void begin_baseline(const ParallelPart& part, const double* u, const double* v, double* p,
                    std::int64_t count) {
  begin_rows(part, u, v, p, count);
}
void advance_baseline(const SweepMaterial& material, double h, const double* x_v, const double* x_w,
                      const double* base_w, double* out_w, double* p, std::int64_t count) {
  advance_rows(material, h, x_v, x_w, base_w, out_w, p, count);
}

#ifdef RHEO_X86_ROWS

[[gnu::target("avx2,fma")]] void begin_avx2(const ParallelPart& part, const double* u, const double* v,
                                            double* p, std::int64_t count) {
  begin_rows(part, u, v, p, count);
}
[[gnu::target("avx2,fma")]] void advance_avx2(const SweepMaterial& material, double h, const double* x_v,
                                              const double* x_w, const double* base_w, double* out_w,
                                              double* p, std::int64_t count) {
  advance_rows(material, h, x_v, x_w, base_w, out_w, p, count);
}

#endif

}  // namespace

BranchRows branch_rows(SimdLevel level) {
  assert(has_simd_level(level));
#ifdef RHEO_X86_ROWS
  // Four numbers a node: wider registers bring nothing.
  if (level != SimdLevel::baseline) return {begin_avx2, advance_avx2};
#endif
  (void)level;
  return {begin_baseline, advance_baseline};
}

}  // namespace rheo
