#include "kernels/node_order.hpp"

#include <algorithm>
#include <numeric>

namespace rheo {

std::vector<std::int32_t> narrow_order(const Mesh& mesh) {
  const std::size_t n = mesh.points.size();
  // Triangles by node.
  std::vector<std::size_t> begin(n + 1, 0);
  for (const Triangle& t : mesh.triangles) {
    for (int node : t) ++begin[static_cast<std::size_t>(node) + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::int32_t> around(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (std::int32_t e = 0; e < mesh.triangle_count(); ++e) {
    for (int node : mesh.triangles[e]) around[next[node]++] = e;
  }

  std::vector<std::int32_t> order;
  order.reserve(n);
  std::vector<char> seen(n, 0);
  const auto valence = [&](std::int32_t i) { return begin[i + 1] - begin[i]; };
  const auto pass = [&](std::int32_t start, std::vector<std::int32_t>& out) {
    const std::size_t first = out.size();
    out.push_back(start);
    seen[start] = 1;
    for (std::size_t k = first; k < out.size(); ++k) {
      const std::size_t before = out.size();
      const std::int32_t node = out[k];
      for (std::size_t e = begin[node]; e < begin[node + 1]; ++e) {
        for (std::int32_t other : mesh.triangles[around[e]]) {
          if (seen[other]) continue;
          seen[other] = 1;
          out.push_back(other);
        }
      }
      std::stable_sort(out.begin() + static_cast<std::ptrdiff_t>(before), out.end(),
                       [&](std::int32_t a, std::int32_t b) { return valence(a) < valence(b); });
    }
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (seen[i]) continue;
    std::vector<std::int32_t> part;
    pass(static_cast<std::int32_t>(i), part);
    for (std::int32_t node : part) seen[node] = 0;
    pass(part.back(), order);
  }
  std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace rheo
