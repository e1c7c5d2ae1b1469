#include "kernels/edge_form.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>

#include "kernels/node_blocks.hpp"
#include "kernels/node_order.hpp"

namespace rheo {
namespace {

// From this bandwidth on, what four sweeps have in hand (four blocks of some 450 bytes a node) is more than a
// core's own cache: bytes cost more than instructions.
constexpr std::int32_t far_bandwidth = 300;

constexpr int valence_window = 128;  // nodes that may change places to lengthen runs of equal valence

struct DirectedEdge {
  std::int32_t from = 0;
  std::int32_t to = 0;
  double xx = 0.0, yy = 0.0, xy = 0.0;
};

// Both directions of every edge with its S, sorted by (from, to), each once.
std::vector<DirectedEdge> directed_edges(const Mesh& mesh) {
  std::vector<DirectedEdge> edges;
  edges.reserve(mesh.triangles.size() * 6);
  for (int e = 0; e < mesh.triangle_count(); ++e) {
    const Triangle& t = mesh.triangles[e];
    const double scale = mesh.thickness / (4.0 * signed_area(mesh, e));
    std::array<Vec2, 3> q;  // (b, c)
    for (int i = 0; i < 3; ++i) {
      const Vec2& j = mesh.points[t[(i + 1) % 3]];
      const Vec2& k = mesh.points[t[(i + 2) % 3]];
      q[i] = {j.y - k.y, k.x - j.x};
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const double xx = scale * q[i].x * q[j].x;
      const double yy = scale * q[i].y * q[j].y;
      const double xy = 0.5 * scale * (q[i].x * q[j].y + q[i].y * q[j].x);
      const DirectedEdge edge{t[i], t[j], xx, yy, xy};
      edges.push_back(edge);
      edges.push_back({edge.to, edge.from, xx, yy, xy});
    }
  }
  // Counting sort by `from`, then a short sort in each node's list.
  const std::size_t n = mesh.points.size();
  std::vector<std::size_t> begin(n + 1, 0);
  for (const DirectedEdge& e : edges) ++begin[e.from + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<DirectedEdge> sorted(edges.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const DirectedEdge& e : edges) sorted[next[e.from]++] = e;
  edges.clear();
  for (std::size_t i = 0; i < n; ++i) {
    std::stable_sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin[i]),
                     sorted.begin() + static_cast<std::ptrdiff_t>(begin[i + 1]),
                     [](const DirectedEdge& a, const DirectedEdge& b) { return a.to < b.to; });
    for (std::size_t k = begin[i]; k < begin[i + 1]; ++k) {
      if (k > begin[i] && edges.back().to == sorted[k].to) {
        edges.back().xx += sorted[k].xx;
        edges.back().yy += sorted[k].yy;
        edges.back().xy += sorted[k].xy;
      } else {
        edges.push_back(sorted[k]);
      }
    }
  }
  return edges;
}

}  // namespace

std::optional<Combined> combined(const Material& material) {
  if (!material.is_one_branch()) return std::nullopt;
  const bool alike = same_rate(material.lambda_rate(), material.mu_rate());
  if (material.lambda_ela > 0.0 && material.mu_ela > 0.0 && !alike) return std::nullopt;
  return Combined{material.lambda_ela, material.mu_ela};
}

EdgeForm::EdgeForm(const Mesh& mesh, const std::optional<Combined>& both, const std::optional<Level>& wanted)
    : moduli(both), row(both ? 2 : 4), nodes(mesh.node_count()), corner_factor(mesh.thickness / 4) {
  assert(mesh.thickness_of_node.empty());
  if (moduli) corner_factor *= moduli->lambda - moduli->mu;
  const auto n = static_cast<std::size_t>(nodes);
  const std::vector<DirectedEdge> edges = directed_edges(mesh);
  std::vector<std::size_t> begin(n + 1, 0);
  for (const DirectedEdge& e : edges) ++begin[e.from + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());

  std::vector<std::int32_t> neighbours(edges.size());
  std::transform(edges.begin(), edges.end(), neighbours.begin(), [](const auto& e) { return e.to; });
  mesh_node = narrow_order(begin, neighbours);
  const auto valence = [&](std::int32_t node) {
    return static_cast<std::int32_t>(begin[node + 1] - begin[node]);
  };
  for (std::size_t first = 0; first < n; first += valence_window) {
    const std::size_t last = std::min(n, first + valence_window);
    std::stable_sort(mesh_node.begin() + static_cast<std::ptrdiff_t>(first),
                     mesh_node.begin() + static_cast<std::ptrdiff_t>(last),
                     [&](std::int32_t a, std::int32_t b) { return valence(a) < valence(b); });
  }
  kernel_node.resize(n);
  for (std::size_t k = 0; k < n; ++k) kernel_node[mesh_node[k]] = static_cast<std::int32_t>(k);

  std::vector<std::int32_t> farthest(n);  // the highest of a node's neighbours
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t e = begin[mesh_node[k]]; e < begin[mesh_node[k] + 1]; ++e)
      farthest[k] = std::max(farthest[k], kernel_node[edges[e].to]);
    bandwidth = std::max(bandwidth, farthest[k] - static_cast<std::int32_t>(k));
  }
  const Level kept = wanted.value_or(bandwidth < far_bandwidth ? Level::ready : Level::summed);
  level_row = moduli || kept == Level::summed ? 2 : 4;
  std::int64_t count = 0;
  std::int32_t reached = 0;  // highest neighbour of the block's nodes so far: the next block's, at most
  std::int32_t end = 0;      // where the block ends
  for (std::int32_t k = 0; k < nodes; ++k) {
    const std::int32_t node = mesh_node[k];
    const bool new_block = k == end;
    if (new_block) {
      end = std::max(k + smallest_block, reached + 1);
      const auto run = static_cast<std::int32_t>(runs.size());
      blocks.push_back({run, run, k, k});
    }
    if (new_block || runs.back().valence != valence(node)) {
      count += count % 2;  // wide loads of a pair's edges stay in one cache line
      runs.push_back({k, k, valence(node), count});
    }
    reached = std::max(reached, farthest[k]);
    ++runs.back().last;
    blocks.back().last_run = static_cast<std::int32_t>(runs.size());
    blocks.back().last_node = k + 1;
    count += valence(node);
  }

  constexpr std::size_t widest_load = 8;
  const auto width = static_cast<std::ptrdiff_t>(level_row);
  const auto places = static_cast<std::size_t>(count);
  offset.resize(places);
  level.resize(static_cast<std::size_t>(level_row) * places);
  mixed.assign(places + widest_load, 0.0);
  for (const Run& run : runs) {
    for (std::int32_t k = run.first; k < run.last; ++k) {
      const Edges place = run.edges_of(k);
      auto at = static_cast<std::size_t>(place.edge);
      for (std::size_t e = begin[mesh_node[k]]; e < begin[mesh_node[k] + 1]; ++e) {
        const double xx = edges[e].xx, yy = edges[e].yy;
        const std::array<double, 4> weights{xx, yy, 2 * xx + yy, 2 * yy + xx};
        offset[at] = static_cast<std::uint32_t>(row * kernel_node[edges[e].to]);
        if (moduli) {
          for (std::size_t c = 0; c < 2; ++c)
            level[2 * at + c] = moduli->lambda * weights[c] + moduli->mu * weights[2 + c];
          mixed[at] = (moduli->lambda + moduli->mu) * edges[e].xy;
        } else {
          std::copy_n(weights.begin(), width, level.begin() + width * static_cast<std::ptrdiff_t>(at));
          mixed[at] = edges[e].xy;
        }
        at += static_cast<std::size_t>(place.stride);
      }
    }
  }

  // Follow the boundary through each of its nodes; at a node where two loops touch, each gives a passage.
  const auto& boundary = mesh.edge_groups.at("boundary");
  std::vector<std::vector<std::int32_t>> next(n);
  for (const Edge& edge : boundary) next[edge[0]].push_back(edge[1]);
  std::vector<std::size_t> used(n, 0);
  for (const Edge& edge : boundary) {
    const std::int32_t node = edge[1];
    // The sum over a node's passages does not depend on how ends and beginnings are paired.
    corners.push_back({kernel_node[node], kernel_node[edge[0]], kernel_node[next[node][used[node]++]]});
  }
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) { return a.node < b.node; });
}

}  // namespace rheo
