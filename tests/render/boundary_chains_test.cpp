#include "boundary_chains.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "bodies.hpp"

namespace {

using render::BoundaryChains;
using Edges = std::vector<std::array<int, 2>>;

Edges edges_of(const std::vector<int>& flat) {
  Edges edges;
  for (std::size_t i = 0; i + 1 < flat.size(); i += 2) edges.push_back({flat[i], flat[i + 1]});
  std::ranges::sort(edges);
  return edges;
}

void expect_chained(const BoundaryChains& chains) {
  for (std::size_t c = 0; c < chains.count(); ++c) {
    ASSERT_GT(chains.size(c), 0u);
    for (std::size_t e = chains.offsets[c] + 1; e < chains.offsets[c + 1]; ++e)
      EXPECT_EQ(chains.edges[2 * e - 1], chains.edges[2 * e]);
  }
}

TEST(BoundaryChains, ShuffledEdgesBecomeOneLoop) {
  const bodies::Body body = bodies::rectangle(2, 1, 20, 10);
  Edges edges = edges_of(body.boundary);
  std::shuffle(edges.begin(), edges.end(), std::mt19937(7));
  std::vector<int> flat;
  for (const auto& [a, b] : edges) flat.insert(flat.end(), {a, b});
  const BoundaryChains chains = render::chain_boundary(flat);
  EXPECT_EQ(chains.count(), 1u);
  EXPECT_TRUE(chains.closed(0));
  expect_chained(chains);
  EXPECT_EQ(edges_of(chains.edges), edges_of(body.boundary));
}

TEST(BoundaryChains, OpenOnesBeginAtTheirOpenEnd) {
  const std::vector<int> boundary{3, 4, 2, 3, 7, 8, 1, 2};
  const BoundaryChains chains = render::chain_boundary(boundary);
  EXPECT_EQ(chains.edges, (std::vector<int>{1, 2, 2, 3, 3, 4, 7, 8}));
  EXPECT_EQ(chains.offsets, (std::vector<std::size_t>{0, 3, 4}));
  EXPECT_FALSE(chains.closed(0));
}

TEST(BoundaryChains, LoopsThatTouchInANodeAreKeptWhole) {
  const std::vector<int> boundary{0, 1, 1, 2, 2, 0, 0, 3, 3, 4, 4, 0, 5, 6, 6, 7, 7, 5};
  const BoundaryChains chains = render::chain_boundary(boundary);
  expect_chained(chains);
  EXPECT_EQ(edges_of(chains.edges), edges_of(boundary));
  for (std::size_t c = 0; c < chains.count(); ++c) EXPECT_TRUE(chains.closed(c));
}

TEST(BoundaryChains, NoneOfNothing) {
  EXPECT_EQ(render::chain_boundary({}).count(), 0u);
}

}  // namespace
