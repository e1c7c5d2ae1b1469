#include "rheo/memory_need.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

#include "columns.hpp"
#include "rheo/error.hpp"
#include "rheo/memory_limit.hpp"
#include "rheo/simulation.hpp"
#include "timeline.hpp"

namespace rheo {
namespace {

constexpr double branch_bytes = 128.0;  // w_lambda and w_mu, x and y, in the state and in three buffers
// What any machine has: looking up how much it is would take longer than making a small body.
constexpr double always_there = 16e6;
constexpr double pair_bytes = 40.0;  // as a triplet, and in the matrix and its transpose

// Of each material: how many nodes its triangles touch.
std::vector<double> nodes_by_material(const Scene& scene) {
  std::vector<double> count(scene.regions.size() + 1, 0.0);
  if (scene.region_of_triangle.empty()) {
    count[0] = scene.mesh.node_count();
    return count;
  }
  // The first material seen at a node, and further ones, of which there are few.
  std::vector<std::int32_t> first(scene.mesh.points.size(), -1);
  std::vector<std::pair<int, std::int32_t>> further;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const std::int32_t material = scene.region_of_triangle[t];
    for (const int node : scene.mesh.triangles[t]) {
      std::int32_t& seen = first[static_cast<std::size_t>(node)];
      if (seen < 0) {
        seen = material;
        ++count[static_cast<std::size_t>(material)];
      } else if (seen != material) {
        further.emplace_back(node, material);
      }
    }
  }
  std::sort(further.begin(), further.end());
  further.erase(std::unique(further.begin(), further.end()), further.end());
  for (const auto& [node, material] : further) ++count[static_cast<std::size_t>(material)];
  return count;
}

// Beyond one branch at every node.
double further_branches(const Scene& scene) {
  const std::vector<double> nodes = nodes_by_material(scene);
  double slots = 0.0;
  for (std::size_t m = 0; m < nodes.size(); ++m)
    slots += nodes[m] * static_cast<double>(std::max<std::size_t>(1, material_of(scene, m).branch_count()));
  return branch_bytes * std::max(0.0, slots - scene.mesh.node_count());
}

double nodes_need(const Scene& scene) {
  const double nodes = scene.mesh.node_count();
  const bool lumped = scene.material.mass == Mass::lumped;
  double need = nodes * (!lumped ? 2700.0 : has_columns(scene) ? 2800.0 : 900.0);
  if (scene.time.integrator == IntegratorKind::implicit) {
    const double factor = 135.0 * std::log2(nodes) * nodes;
    need = nodes * (lumped ? 2400.0 : 4500.0) +
           std::max(fewest_factors * factor, std::min(most_factors * factor, factors_budget));
  }
  need += further_branches(scene);
  if (scene.time.accuracy > 0.0 && scene.time.integrator != IntegratorKind::exponential) {
    // Two trial runs side by side, whose states at the outputs may be kept (trial_runs.cpp).
    need += need + 2.0 * std::min(128e6, 64.0 * nodes * static_cast<double>(output_count(scene.time)));
  }
  return need;
}

double constraints_need(const Scene& scene) {
  const bool all = scene.time.constraints == ConstraintMethod::baumgarte;
  double held = 0.0;  // one constraint each, of one term, by Baumgarte's method for all
  const auto hold = [&](const auto& item) {
    held += static_cast<double>(item.nodes.size()) * (item.axis == Axis::both ? 2.0 : 1.0);
  };
  if (all) {
    for (const Fix& fix : scene.fixes) hold(fix);
    for (const Move& move : scene.moves) hold(move);
  }
  const double count = static_cast<double>(scene.constraints.size()) + held;
  if (count == 0.0) return 0.0;
  double entries = held, pairs = count * count;
  for (const Constraint& constraint : scene.constraints)
    entries += static_cast<double>(constraint.terms.size());
  if (scene.material.mass == Mass::lumped) {
    std::unordered_map<int, double> meeting;  // by degree of freedom
    for (const Constraint& constraint : scene.constraints)
      for (const ConstraintTerm& term : constraint.terms) ++meeting[2 * term.node + (term.axis == Axis::y)];
    pairs = 3.0 * held;  // and with constraints of the same degree of freedom
    for (const auto& [dof, constraints] : meeting) pairs += constraints * constraints;
  }
  return pair_bytes * pairs + 200.0 * count + 80.0 * entries;
}

double events_need(const Scene& scene) {
  const auto holders = static_cast<double>(scene.fixes.size() + scene.moves.size());
  return 3.0 * holders * std::min(static_cast<double>(event_times(scene).size()), 2.0 * holders + 1.0);
}

}  // namespace

MemoryNeed memory_need(const Scene& scene) {
  return {nodes_need(scene), constraints_need(scene), events_need(scene)};
}

void require_memory(const Scene& scene, double asked, double also, const std::string& remedy) {
  const MemoryNeed need = memory_need(scene);
  if (asked <= 0.0 && need.total() + also <= always_there) return;
  const MemoryLimit limit = memory_limit(asked);
  if (need.total() + also <= limit.bytes) return;
  const bool consistent = scene.material.mass == Mass::consistent;
  std::string what = fmt::format("{} nodes{}", scene.mesh.node_count(),
                                 scene.time.integrator == IntegratorKind::implicit ? " with implicit" : "");
  std::string cure = "take a coarser mesh" + std::string(consistent ? " or mass = \"lumped\"" : "");
  if (need.constraints > std::max(need.nodes, need.events)) {
    what = fmt::format("{} general constraints{}", scene.constraints.size(),
                       consistent ? " with mass = \"consistent\"" : "");
    cure = "take fewer [[constraint]]" + std::string(consistent ? " or mass = \"lumped\"" : "");
  } else if (need.events > need.nodes) {
    what = fmt::format("{} [[fix]] and [[move]] with times of their own",
                       scene.fixes.size() + scene.moves.size());
    cure = "let them begin and end together";
  } else if (also > need.total()) {
    cure.clear();
  }
  if (!remedy.empty()) cure += (cure.empty() ? "" : ", or ") + remedy;
  throw Error(Error::Kind::input, fmt::format("{} need about {} of memory, {}", what,
                                              memory_text(need.total() + also), beyond(limit, cure)));
}

}  // namespace rheo
