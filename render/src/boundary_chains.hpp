// Boundary edges in the order in which one walks along them, so that dashes and hatches run on from edge to
// edge.
//
// Shapes   boundary k x 2, directed edges in any order
// Errors   none
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace render {

struct BoundaryChains {
  std::vector<int> edges;  // k x 2, the given ones; within a chain each begins where the last one ended
  std::vector<std::size_t> offsets;  // chain c: the edges offsets[c] to offsets[c + 1] - 1

  std::size_t count() const { return offsets.size() - 1; }
  std::size_t size(std::size_t chain) const { return offsets[chain + 1] - offsets[chain]; }
  bool closed(std::size_t chain) const {
    return edges[2 * offsets[chain]] == edges[2 * offsets[chain + 1] - 1];
  }
};

// Open chains begin at their open end. Where loops touch in a node, walks go on along any of them.
BoundaryChains chain_boundary(std::span<const int> boundary);

}  // namespace render
