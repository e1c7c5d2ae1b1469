#include "kernels/edge_forms.hpp"

#include "kernels/edge_lanes_x86.hpp"

namespace rheo {
namespace {

template <std::size_t stride>
EdgeForms forms_baseline(const EdgeForm& form, const double* w, const double* x, std::int32_t first_run,
                         std::int32_t last_run) {
  constexpr std::size_t mu = stride == 4 ? 2 : 0;
  EdgeForms sums;
  for (std::int32_t r = first_run; r < last_run; ++r) {
    const EdgeForm::Run& run = form.runs[static_cast<std::size_t>(r)];
    for (auto i = static_cast<std::size_t>(run.first); i < static_cast<std::size_t>(run.last); ++i) {
      const EdgeForm::Edges edges = run.edges_of(static_cast<std::int64_t>(i));
      auto e = static_cast<std::size_t>(edges.edge);
      for (std::int32_t k = 0; k < run.valence; ++k, e += static_cast<std::size_t>(edges.stride)) {
        const std::size_t j = form.offset[e] / 4;
        if (j < i) continue;  // each edge once
        const std::array<double, 4> level = form.full_level(e);
        const double mixed = form.mixed[e];
        const double *wi = w + stride * i, *wj = w + stride * j;
        const double dx = x[2 * j] - x[2 * i], dy = x[2 * j + 1] - x[2 * i + 1];
        const double lx = wj[0] - wi[0], ly = wj[1] - wi[1];
        const double mx = wj[mu] - wi[mu], my = wj[mu + 1] - wi[mu + 1];
        const double slx = level[0] * lx + mixed * ly, sly = mixed * lx + level[1] * ly;
        const double smx = level[2] * mx + mixed * my, smy = mixed * mx + level[3] * my;
        sums.ll -= lx * slx + ly * sly;
        sums.xl -= dx * slx + dy * sly;
        sums.mm -= mx * smx + my * smy;
        sums.xm -= dx * smx + dy * smy;
      }
    }
  }
  return sums;
}

#ifdef RHEO_X86_SWEEPS

// A node's row of w in four lanes.
template <std::size_t stride>
RHEO_INLINE(RHEO_AVX2)
__m256d row_of(const double* w, std::size_t node) {
  if constexpr (stride == 4) return _mm256_loadu_pd(w + 4 * node);
  return _mm256_broadcast_pd(reinterpret_cast<const __m128d*>(w + 2 * node));
}

// Sums of one stream of edges; several of them, as each waits for its last one.
struct Lanes {
  __m256d squares, products;
};

template <Level kept, std::size_t stride>
RHEO_INLINE(RHEO_AVX2)
void add_edge(const double* w, const double* x, __m256d wi, __m256d xi, const double* level,
              const double* mixed, const std::uint32_t* offset, int k, Lanes& sum) {
  const std::size_t j = offset[k] / 4;
  const __m256d d = _mm256_sub_pd(row_of<stride>(w, j), wi);
  const __m256d across = _mm256_mul_pd(_mm256_broadcast_sd(mixed + k), _mm256_permute_pd(d, 0b0101));
  const __m256d s = _mm256_fmadd_pd(level_of<kept>(level, k), d, across);
  sum.squares = _mm256_fmadd_pd(d, s, sum.squares);
  sum.products = _mm256_fmadd_pd(_mm256_sub_pd(row_of<2>(x, j), xi), s, sum.products);
}

// Every edge from both of its ends, two nodes at a time as in the sweeps: no branch, and half of the sum.
template <Level kept, std::size_t stride>
[[gnu::target(RHEO_AVX2)]] EdgeForms forms_avx2(const EdgeForm& form, const double* w, const double* x,
                                                std::int32_t first_run, std::int32_t last_run) {
  const __m256d zero = _mm256_setzero_pd();
  Lanes a{zero, zero}, b = a, c = a, d = a;
  constexpr int kept_numbers = kept == Level::ready ? 4 : 2;
  for (std::int32_t r = first_run; r < last_run; ++r) {
    const EdgeForm::Run& run = form.runs[static_cast<std::size_t>(r)];
    const double* level = form.level.data() + kept_numbers * run.edge;
    const double* mixed = form.mixed.data() + run.edge;
    const std::uint32_t* offset = form.offset.data() + run.edge;
    const int edges = 2 * run.valence;  // of two nodes, which alternate
    auto i = static_cast<std::size_t>(run.first);
    const auto last = static_cast<std::size_t>(run.last);
    for (; i + 1 < last; i += 2, level += kept_numbers * edges, mixed += edges, offset += edges) {
      const __m256d w0 = row_of<stride>(w, i), w1 = row_of<stride>(w, i + 1);
      const __m256d x0 = row_of<2>(x, i), x1 = row_of<2>(x, i + 1);
      int k = 0;
      for (; k + 2 < edges; k += 4) {
        add_edge<kept, stride>(w, x, w0, x0, level, mixed, offset, k, a);
        add_edge<kept, stride>(w, x, w1, x1, level, mixed, offset, k + 1, b);
        add_edge<kept, stride>(w, x, w0, x0, level, mixed, offset, k + 2, c);
        add_edge<kept, stride>(w, x, w1, x1, level, mixed, offset, k + 3, d);
      }
      if (k == edges) continue;
      add_edge<kept, stride>(w, x, w0, x0, level, mixed, offset, k, a);
      add_edge<kept, stride>(w, x, w1, x1, level, mixed, offset, k + 1, b);
    }
    if (i == last) continue;
    for (int k = 0; k < run.valence; ++k)
      add_edge<kept, stride>(w, x, row_of<stride>(w, i), row_of<2>(x, i), level, mixed, offset, k, a);
  }
  double square[4], product[4];
  _mm256_storeu_pd(square,
                   _mm256_add_pd(_mm256_add_pd(a.squares, b.squares), _mm256_add_pd(c.squares, d.squares)));
  _mm256_storeu_pd(
      product, _mm256_add_pd(_mm256_add_pd(a.products, b.products), _mm256_add_pd(c.products, d.products)));
  return {-0.5 * (square[0] + square[1]), -0.5 * (square[2] + square[3]), -0.5 * (product[0] + product[1]),
          -0.5 * (product[2] + product[3])};
}

#endif

}  // namespace

EdgeFormsFunctions edge_forms_functions(SimdLevel level, const EdgeForm& form) {
#ifdef RHEO_X86_SWEEPS
  if (level != SimdLevel::baseline) {  // AVX-512 would not be faster: single rows are what is loaded
    if (form.level_row == 2) return {forms_avx2<Level::summed, 4>, forms_avx2<Level::summed, 2>};
    return {forms_avx2<Level::ready, 4>, forms_avx2<Level::ready, 2>};
  }
#endif
  (void)level, (void)form;
  return {forms_baseline<4>, forms_baseline<2>};
}

EdgeForms boundary_forms(const EdgeForm& form, const double* w, std::size_t stride, const double* x) {
  const std::size_t mu = stride == 4 ? 2 : 0;
  const double q = form.corner_factor;
  EdgeForms sums;
  for (const EdgeForm::Corner& c : form.corners) {
    const double* next = w + stride * static_cast<std::size_t>(c.next);
    const double* previous = w + stride * static_cast<std::size_t>(c.previous);
    const double* wi = w + stride * static_cast<std::size_t>(c.node);
    const double* xi = x + 2 * static_cast<std::size_t>(c.node);
    const double lx = next[0] - previous[0], ly = next[1] - previous[1];
    const double mx = next[mu] - previous[mu], my = next[mu + 1] - previous[mu + 1];
    sums.ll += q * (wi[0] * ly - wi[1] * lx);
    sums.xl += q * (xi[0] * ly - xi[1] * lx);
    sums.mm -= q * (wi[mu] * my - wi[mu + 1] * mx);
    sums.xm -= q * (xi[0] * my - xi[1] * mx);
  }
  return sums;
}

}  // namespace rheo
