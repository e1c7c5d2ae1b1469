#include "boundary_chains.hpp"

#include <algorithm>

namespace render {

BoundaryChains chain_boundary(std::span<const int> boundary) {
  const std::size_t count = boundary.size() / 2;
  int nodes = 0;
  for (const int node : boundary.first(2 * count)) nodes = std::max(nodes, node + 1);
  // The edges that begin at a node: a list through `other`, headed by `first`.
  const std::size_t none = count;
  std::vector<std::size_t> first(static_cast<std::size_t>(nodes), none), other(count, none);
  std::vector<int> surplus(static_cast<std::size_t>(nodes), 0);  // edges that begin here less those that end
  for (std::size_t e = count; e-- > 0;) {
    const auto a = static_cast<std::size_t>(boundary[2 * e]),
               b = static_cast<std::size_t>(boundary[2 * e + 1]);
    other[e] = first[a];
    first[a] = e;
    ++surplus[a];
    --surplus[b];
  }

  BoundaryChains chains;
  chains.edges.reserve(2 * count);
  chains.offsets.push_back(0);
  const auto walk = [&](std::size_t node) {
    while (first[node] != none) {
      const std::size_t e = first[node];
      first[node] = other[e];
      chains.edges.insert(chains.edges.end(), {boundary[2 * e], boundary[2 * e + 1]});
      node = static_cast<std::size_t>(boundary[2 * e + 1]);
    }
    if (chains.edges.size() / 2 > chains.offsets.back()) chains.offsets.push_back(chains.edges.size() / 2);
  };
  for (std::size_t node = 0; node < surplus.size(); ++node) {
    for (; surplus[node] > 0; --surplus[node]) walk(node);
  }
  for (std::size_t e = 0; e < count; ++e) walk(static_cast<std::size_t>(boundary[2 * e]));
  return chains;
}

}  // namespace render
