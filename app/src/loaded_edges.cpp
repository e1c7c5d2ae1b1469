#include "loaded_edges.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace app {

LoadedEdges::LoadedEdges(const rheo::Scene& scene) {
  std::map<rheo::Edge, std::size_t> known;
  for (const rheo::Traction& traction : scene.tractions) {
    std::vector<std::size_t> slots;
    for (const auto& [i, j] : traction.edges) {
      const rheo::Edge edge{std::min(i, j), std::max(i, j)};
      const auto [at, is_new] = known.try_emplace(edge, edges_.size());
      if (is_new) edges_.push_back(edge);
      slots.push_back(at->second);
    }
    slots_.push_back(std::move(slots));
  }
}

std::vector<std::array<double, 2>> LoadedEdges::sums(
    std::span<const rheo::Simulation::ActiveTraction> tractions) const {
  std::vector<std::array<double, 2>> sums(edges_.size(), {0.0, 0.0});
  for (const rheo::Simulation::ActiveTraction& active : tractions)
    for (const std::size_t slot : slots_[static_cast<std::size_t>(active.index)]) {
      sums[slot][0] += active.p.x;
      sums[slot][1] += active.p.y;
    }
  return sums;
}

std::vector<render::TractionArrow> LoadedEdges::arrows(
    std::span<const rheo::Simulation::ActiveTraction> tractions, std::span<const double> positions) const {
  const std::vector<std::array<double, 2>> all = sums(tractions);
  std::vector<render::TractionArrow> out;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (all[e][0] == 0.0 && all[e][1] == 0.0) continue;
    out.push_back(arrow_on(edges_[e], all[e], positions));
  }
  return out;
}

render::TractionArrow arrow_on(const rheo::Edge& edge, const std::array<double, 2>& traction,
                               std::span<const double> positions) {
  const auto i = static_cast<std::size_t>(edge[0]), j = static_cast<std::size_t>(edge[1]);
  return {.at = {0.5 * (positions[2 * i] + positions[2 * j]),
                 0.5 * (positions[2 * i + 1] + positions[2 * j + 1])},
          .vector = traction};
}

}  // namespace app
