#include "kernels/element_form.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "kernels/node_order.hpp"

namespace rheo {
namespace {

// Triangles by their nodes in the kernel's order, rising.
struct Sorted {
  std::array<std::int32_t, 3> nodes{};
  std::int32_t triangle = 0;
};

std::vector<Sorted> sorted_triangles(const Mesh& mesh, const std::vector<std::int32_t>& kernel_node) {
  std::vector<Sorted> unsorted(mesh.triangles.size());
  std::vector<std::size_t> begin(mesh.points.size() + 1, 0);
  for (std::size_t e = 0; e < unsorted.size(); ++e) {
    for (std::size_t k = 0; k < 3; ++k) unsorted[e].nodes[k] = kernel_node[mesh.triangles[e][k]];
    std::sort(unsorted[e].nodes.begin(), unsorted[e].nodes.end());
    unsorted[e].triangle = static_cast<std::int32_t>(e);
    ++begin[unsorted[e].nodes[0] + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Sorted> sorted(unsorted.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const Sorted& t : unsorted) sorted[next[t.nodes[0]]++] = t;
  for (std::size_t i = 0; i + 1 < begin.size(); ++i) {
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin[i]),
              sorted.begin() + static_cast<std::ptrdiff_t>(begin[i + 1]),
              [](const Sorted& a, const Sorted& b) { return a.nodes < b.nodes; });
  }
  return sorted;
}

// (b, c) without scale of a triangle's corner k.
std::array<double, 2> gradient_of(const Mesh& mesh, const Triangle& t, std::size_t k) {
  const Vec2& j = mesh.points[t[(k + 1) % 3]];
  const Vec2& l = mesh.points[t[(k + 2) % 3]];
  return {j.y - l.y, l.x - j.x};
}

std::int32_t region_of(const Regions& regions, std::int32_t triangle) {
  return regions.of_triangle.empty() ? 0 : regions.of_triangle[static_cast<std::size_t>(triangle)];
}

// By node of the mesh: the regions that touch it, rising.
using RegionsAround = std::vector<std::vector<std::int32_t>>;

RegionsAround regions_around(const Mesh& mesh, const Regions& regions) {
  RegionsAround around(mesh.points.size());
  for (std::int32_t e = 0; e < mesh.triangle_count(); ++e) {
    const std::int32_t region = region_of(regions, e);
    for (const int node : mesh.triangles[e]) {
      auto& list = around[node];
      const auto at = std::lower_bound(list.begin(), list.end(), region);
      if (at == list.end() || *at != region) list.insert(at, region);
    }
  }
  return around;
}

// Nodes of one region side by side, inside short windows: longer runs, and still near their neighbours.
void group_by_region(std::vector<std::int32_t>& order, const RegionsAround& around) {
  constexpr std::size_t window = 32;  // nodes
  const auto kind = [&](std::int32_t node) { return std::pair(around[node].size(), around[node].front()); };
  for (std::size_t first = 0; first < order.size(); first += window) {
    const std::size_t last = std::min(order.size(), first + window);
    std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first),
                     order.begin() + static_cast<std::ptrdiff_t>(last),
                     [&](std::int32_t a, std::int32_t b) { return kind(a) < kind(b); });
  }
}

}  // namespace

ElementForm::ElementForm(const Mesh& mesh, const Regions& regions)
    : nodes(mesh.node_count()), materials(regions.materials), mesh_node(narrow_order(mesh)) {
  assert(!materials.empty());
  assert(regions.of_triangle.empty() || regions.of_triangle.size() == mesh.triangles.size());
  const RegionsAround around = regions_around(mesh, regions);
  group_by_region(mesh_node, around);
  const auto n = static_cast<std::size_t>(nodes);
  kernel_node.resize(n);
  for (std::size_t k = 0; k < n; ++k) kernel_node[mesh_node[k]] = static_cast<std::int32_t>(k);

  slot_begin.reserve(n + 1);
  for (std::int32_t k = 0; k < nodes; ++k) {
    const std::vector<std::int32_t>& here = around[mesh_node[k]];
    const auto count = static_cast<std::int32_t>(here.size());
    if (runs.empty() || count > 1 || runs.back().slots_a_node > 1 || runs.back().region != here.front())
      runs.push_back({k, k, slots, count, here.front()});
    ++runs.back().last;
    slot_begin.push_back(slots);
    slot_region.insert(slot_region.end(), here.begin(), here.end());
    slot_node.insert(slot_node.end(), here.size(), k);
    slots += count;
  }
  slot_begin.push_back(slots);

  node_mass.assign(n, 0.0);
  for (std::int32_t e = 0; e < mesh.triangle_count(); ++e) {
    const double mass = materials[region_of(regions, e)].density * mesh.thickness_of(mesh.triangles[e]) *
                        signed_area(mesh, e);
    for (const int node : mesh.triangles[e]) node_mass[kernel_node[node]] += mass / 3;
  }

  const std::vector<Sorted> sorted = sorted_triangles(mesh, kernel_node);
  gradient.reserve(sorted.size());
  offset.reserve(sorted.size());
  for (const Sorted& s : sorted) {
    bandwidth = std::max(bandwidth, s.nodes[2] - s.nodes[0]);
    const Triangle& t = mesh.triangles[s.triangle];
    const double scale = std::sqrt(mesh.thickness_of(t) / (4.0 * signed_area(mesh, s.triangle)));
    const auto q1 = gradient_of(mesh, t, 1), q2 = gradient_of(mesh, t, 2);
    gradient.push_back({scale * q1[0], scale * q1[1], scale * q2[0], scale * q2[1]});
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::int32_t slot = slot_begin[kernel_node[t[k]]];
      while (slot_region[slot] != region_of(regions, s.triangle)) ++slot;
      corners[k] = 4 * static_cast<std::uint32_t>(slot);
    }
    offset.push_back(corners);
  }

  node_begin.assign(n + 1, 0);
  for (const Sorted& s : sorted) {
    for (const std::int32_t node : s.nodes) ++node_begin[static_cast<std::size_t>(node) + 1];
  }
  std::partial_sum(node_begin.begin(), node_begin.end(), node_begin.begin());
  node_triangles.resize(3 * sorted.size());
  std::vector<std::size_t> next(node_begin.begin(), node_begin.end() - 1);
  for (std::size_t e = 0; e < sorted.size(); ++e) {
    for (const std::int32_t node : sorted[e].nodes)
      node_triangles[next[node]++] = static_cast<std::int32_t>(e);
  }
}

std::vector<ElementForm::Block> ElementForm::blocks(std::int32_t smallest) const {
  const std::int32_t size = std::max({bandwidth, smallest, 1});
  // Triangles whose lowest node is below `node` come first.
  const auto triangles_below = [&](std::int32_t node) {
    const std::uint32_t end = 4 * static_cast<std::uint32_t>(slot_begin[node]);
    return std::partition_point(
               offset.begin(), offset.end(),
               [&](const auto& corners) { return *std::min_element(corners.begin(), corners.end()) < end; }) -
           offset.begin();
  };
  std::vector<Block> result;
  std::int32_t run = 0;
  for (std::int32_t first = 0; first < nodes; first += size) {
    Block block;
    block.first_node = first;
    block.last_node = std::min(nodes, first + size);
    while (runs[run].last <= first) ++run;
    block.first_run = block.last_run = run;
    while (block.last_run < static_cast<std::int32_t>(runs.size()) &&
           runs[block.last_run].first < block.last_node)
      ++block.last_run;
    block.first_triangle = triangles_below(block.first_node);
    block.last_triangle = triangles_below(block.last_node);
    block.reaching = block.first_triangle;
    if (!result.empty()) {
      const std::uint32_t mine = 4 * static_cast<std::uint32_t>(slot_begin[first]);
      block.reaching = result.back().first_triangle;
      while (block.reaching < block.first_triangle &&
             *std::max_element(offset[block.reaching].begin(), offset[block.reaching].end()) < mine)
        ++block.reaching;
    }
    result.push_back(block);
  }
  return result;
}

}  // namespace rheo
