#include "rheo/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "rheo/error.hpp"
#include "rheo/limits.hpp"
#include "rheo/memory_limit.hpp"

namespace rheo {
namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& text) {
  throw Error(Error::Kind::input, where.empty() ? text : where + " " + text);
}

// Finite, and of a size that can be computed with.
bool usable(Vec2 value) {
  return within_size(value.x) && within_size(value.y);
}
const std::string usable_numbers = fmt::format("finite numbers of at most {:g} in size", largest_size);

void check_node(const std::string& where, int node, const Mesh& mesh) {
  if (node >= 0 && node < mesh.node_count()) return;
  refuse(where, fmt::format("node {}: the nodes are numbered 0 to {}", node, mesh.node_count() - 1));
}

void check_nodes(const std::string& where, std::vector<int> nodes, const Mesh& mesh) {
  if (nodes.empty()) refuse(where, "no nodes: at least one is needed");
  for (const int node : nodes) check_node(where, node, mesh);
  std::sort(nodes.begin(), nodes.end());
  const auto twice = std::adjacent_find(nodes.begin(), nodes.end());
  if (twice != nodes.end()) refuse(where, fmt::format("node {} twice: each node once", *twice));
}

void check_window(const std::string& where, Window window) {
  if (!(window.from >= 0.0) || !std::isfinite(window.from)) {
    refuse(where, fmt::format("from = {}: a finite time >= 0 (s) is needed", window.from));
  }
  if (!(window.until > window.from)) {
    refuse(where, fmt::format("until = {}: a time after from = {} (s) is needed; inf: never let go",
                              window.until, window.from));
  }
}

// `values_are_usable(key)` says whether all but the time is usable.
template <typename Key, typename ValuesAreUsable>
void check_keys(const std::string& where, const std::vector<Key>& keys, ValuesAreUsable values_are_usable) {
  if (keys.empty()) refuse(where, "no keys: at least one is needed");
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (!within_size(keys[i].t) || !values_are_usable(keys[i])) {
      refuse(where, fmt::format("key {} at t = {}: {} are needed", i, keys[i].t, usable_numbers));
    }
    if (i > 0 && !(keys[i].t > keys[i - 1].t)) {
      refuse(where, fmt::format("key {} at t = {} is not after key {} at t = {}: times must rise", i,
                                keys[i].t, i - 1, keys[i - 1].t));
    }
  }
}

void check_constraint(const Constraint& constraint, const Mesh& mesh) {
  if (constraint.terms.empty()) refuse(constraint.where, "no terms: at least one is needed");
  std::set<std::pair<int, Axis>> seen;
  for (const ConstraintTerm& term : constraint.terms) {
    check_node(constraint.where, term.node, mesh);
    if (term.axis == Axis::both) refuse(constraint.where, "axis both: a term needs \"x\" or \"y\"");
    if (!of_usable_size(std::abs(term.coefficient))) {
      refuse(constraint.where,
             fmt::format("coefficient {} of node {}: a number of {:g} to {:g} in size is needed",
                         term.coefficient, term.node, smallest_size, largest_size));
    }
    if (!seen.insert({term.node, term.axis}).second) {
      refuse(constraint.where, fmt::format("node {} twice along {}: add the coefficients up", term.node,
                                           term.axis == Axis::x ? 'x' : 'y'));
    }
  }
  if (!within_size(constraint.value)) {
    refuse(constraint.where, fmt::format("value = {}: a finite number of at most {:g} m is needed",
                                         constraint.value, largest_size));
  }
}

// What prepare() made sure of and a later change by hand may have undone, as far as a step would go wrong.
void check_mesh(const Mesh& mesh) {
  const std::string where = "[mesh]";
  const char* const remedy = "; call prepare() after a change of the mesh";
  if (!mesh.edge_groups.contains("boundary")) refuse(where, fmt::format("no group \"boundary\"{}", remedy));
  std::vector<char> used(mesh.points.size(), 0);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (const int node : mesh.triangles[static_cast<std::size_t>(t)]) {
      if (node < 0 || node >= mesh.node_count()) {
        refuse(where, fmt::format("triangle {}: node {}: the nodes are numbered 0 to {}{}", t, node,
                                  mesh.node_count() - 1, remedy));
      }
      used[static_cast<std::size_t>(node)] = 1;
    }
    if (!(signed_area(mesh, t) > 0.0))
      refuse(where, fmt::format("triangle {}: no positive area (counter-clockwise){}", t, remedy));
  }
  const auto idle = std::find(used.begin(), used.end(), 0);
  if (idle != used.end())
    refuse(where, fmt::format("node {}: in no triangle{}", idle - used.begin(), remedy));
}

const char* name_of(Mass mass) {
  return mass == Mass::lumped ? "lumped" : "consistent";
}

void check_regions(const Scene& scene) {
  for (std::size_t k = 0; k < scene.regions.size(); ++k) {
    const Region& region = scene.regions[k];
    const std::string where = region.where.empty() ? fmt::format("region {}", k + 1) : region.where;
    region.material.validate(where);
    if (region.material.mass != scene.material.mass) {
      refuse(where,
             fmt::format(
                 "mass = \"{}\" (the default is \"lumped\"): all materials of a scene need the same, the "
                 "first{} has \"{}\"",
                 name_of(region.material.mass),
                 scene.material_name.empty() ? "" : ", of " + scene.material_name + ",",
                 name_of(scene.material.mass)));
    }
  }
  const std::vector<std::int32_t>& of = scene.region_of_triangle;
  if (!of.empty() && of.size() != scene.mesh.triangles.size()) {
    refuse("[[region]]",
           fmt::format("regions of {} triangles: the mesh has {}", of.size(), scene.mesh.triangles.size()));
  }
  for (std::size_t e = 0; e < of.size(); ++e) {
    if (of[e] >= 0 && static_cast<std::size_t>(of[e]) <= scene.regions.size()) continue;
    refuse("[[region]]",
           fmt::format("triangle {}: region {}: 0 to {} are there", e, of[e], scene.regions.size()));
  }
}

// Every edge of the tractions is a side of some triangle.
void check_edges(const std::vector<Traction>& tractions, const Mesh& mesh) {
  std::vector<char> loaded(mesh.points.size(), 0);
  std::set<Edge> missing;
  for (const Traction& traction : tractions) {
    for (const Edge& edge : traction.edges) {
      missing.insert({std::min(edge[0], edge[1]), std::max(edge[0], edge[1])});
      for (const int node : edge) loaded[static_cast<std::size_t>(node)] = 1;
    }
  }
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3 && !missing.empty(); ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (loaded[static_cast<std::size_t>(a)] && loaded[static_cast<std::size_t>(b)])
        missing.erase({std::min(a, b), std::max(a, b)});
    }
  }
  if (missing.empty()) return;
  const Edge edge = *missing.begin();
  for (const Traction& traction : tractions) {
    for (const Edge& e : traction.edges) {
      if (std::minmax(e[0], e[1]) == std::minmax(edge[0], edge[1]))
        refuse(traction.where, fmt::format("edge ({}, {}): no triangle has it", e[0], e[1]));
    }
  }
}

void check_traction(const Traction& traction, const Mesh& mesh) {
  if (traction.edges.empty()) refuse(traction.where, "no edges: at least one is needed");
  for (const Edge& edge : traction.edges) {
    for (const int node : edge) check_node(traction.where, node, mesh);
    if (edge[0] == edge[1])
      refuse(traction.where, fmt::format("edge ({0}, {0}): two different nodes", edge[0]));
  }
  check_keys(traction.where, traction.keys, [](const TractionKey& key) { return usable(key.p); });
  check_window(traction.where, traction.window);
}

void check_probes(const std::vector<Probe>& probes, const Mesh& mesh) {
  std::set<std::string_view> names;
  for (const Probe& probe : probes) {
    const bool plain = std::all_of(probe.name.begin(), probe.name.end(), [](unsigned char c) {
      return c < 128 && (std::isalnum(c) != 0 || c == '_' || c == '-');
    });
    if (probe.name.empty() || !plain) {
      refuse(probe.where, "name: letters A-Z, a-z, digits, _ and - are allowed, and at least one of them");
    }
    if (!names.insert(probe.name).second) {
      refuse(probe.where,
             fmt::format("name = \"{}\": taken by an earlier probe; each needs its own", probe.name));
    }
    check_nodes(probe.where, probe.nodes, mesh);
  }
}

}  // namespace

void validate(const TimeSettings& time) {
  const std::string where = "[time]";
  const auto positive = [&](const char* name, double value, const char* unit) {
    if (!(value > 0.0) || !std::isfinite(value))
      refuse(where, fmt::format("{} = {}: a finite number > 0 ({}) is needed", name, value, unit));
    if (!of_usable_size(value))
      refuse(where, fmt::format("{} = {}: {:g} to {:g} ({}) is allowed", name, value, smallest_size,
                                largest_size, unit));
  };
  positive("duration", time.duration, "s");
  positive("frame_rate", time.frame_rate, "outputs per second");
  if (time.baumgarte != 0.0) positive("baumgarte", time.baumgarte, "1/s");
  if (const double outputs = time.duration * time.frame_rate; !(outputs <= time.most_outputs)) {
    refuse(where,
           fmt::format("frame_rate = {}: {:.3g} outputs in {} s, {} of memory for their names alone; at "
                       "most {:.0e} are allowed: lower it, or the duration, or raise the limit with "
                       "--output-limit",
                       time.frame_rate, outputs, time.duration, memory_text(bytes_an_output * outputs),
                       time.most_outputs));
  }
  if (!(time.step >= 0.0) || !std::isfinite(time.step)) {
    refuse(where, fmt::format("step = {}: \"auto\" or a finite number > 0 (s) is needed", time.step));
  }
  if (!(time.refinement >= 1.0) || !std::isfinite(time.refinement))
    refuse(where, fmt::format("refinement = {}: a finite number >= 1 is needed", time.refinement));
  if (!(time.tolerance >= finest_tolerance && time.tolerance <= coarsest_tolerance)) {
    refuse(where, fmt::format("tolerance = {}: {:g} to {:g} is allowed", time.tolerance, finest_tolerance,
                              coarsest_tolerance));
  }
  if (time.accuracy != 0.0) {
    if (!(time.accuracy >= finest_accuracy && time.accuracy <= coarsest_accuracy)) {
      refuse(where, fmt::format("accuracy = {}: {:g} to {:g} is allowed", time.accuracy, finest_accuracy,
                                coarsest_accuracy));
    }
    if (time.step > 0.0) {
      refuse(where, fmt::format("accuracy = {:g} and step = {:g}: one of them decides, leave out the other",
                                time.accuracy, time.step));
    }
  }
  if (time.step > 0.0 && !(time.refinement * time.duration / time.step <= max_steps)) {
    refuse(where, fmt::format("step = {}: {:.3g} steps in {} s; at most {:.0e} are allowed", time.step,
                              time.refinement * time.duration / time.step, time.duration, max_steps));
  }
}

void validate(const PictureSettings& picture) {
  const std::string where = "[render]";
  for (std::size_t i = 0; i < 2; ++i) {
    if (picture.size[i] >= min_picture_size[i] && picture.size[i] <= max_picture_side) continue;
    refuse(where,
           fmt::format(
               "size = [{}, {}]: about {} of memory; a width of {} to {} and a height of {} to {} pixels "
               "are allowed, which OpenGL draws",
               picture.size[0], picture.size[1],
               memory_text(bytes_a_pixel * std::abs(1.0 * picture.size[0] * picture.size[1])),
               min_picture_size[0], max_picture_side, min_picture_size[1], max_picture_side));
  }
  if (picture.sheet.size() > most_sheet_times)
    refuse(where, fmt::format("sheet = {} times: at most {} shapes are drawn", picture.sheet.size(),
                              most_sheet_times));
  if (!(picture.arrow_scale >= 0.0) || !within_size(picture.arrow_scale))
    refuse(where, fmt::format("arrow_scale = {}: a traction (Pa) > 0, or 0 for the run's largest",
                              picture.arrow_scale));
  if (picture.every < 1 || picture.every > most_every)
    refuse(where, fmt::format("every = {}: a whole number of outputs from one frame to the next, 1 to {}",
                              picture.every, most_every));
  if (picture.branch < 0)
    refuse(where, fmt::format("branch = {}: 0 for all, or a Maxwell branch from 1 on", picture.branch));
  const auto [low, high] = picture.range;
  if (!picture.range_auto && (!(low < high) || !std::isfinite(low) || !std::isfinite(high))) {
    refuse(where, fmt::format("range = [{}, {}]: \"auto\" or two finite numbers [low, high], low < high", low,
                              high));
  }
}

std::size_t most_branches(const Scene& scene) {
  std::size_t most = scene.material.branch_count();
  for (const Region& region : scene.regions) most = std::max(most, region.material.branch_count());
  return most;
}

void validate(const Scene& scene) {
  const Mesh& mesh = scene.mesh;
  if (mesh.triangles.empty()) refuse("[mesh]", "the mesh has no triangles: at least one is needed");
  check_mesh(mesh);
  scene.material.validate("[material]");
  check_regions(scene);
  if (!usable(scene.body_acceleration)) {
    refuse("[body_force]", fmt::format("acceleration = [{}, {}]: {} (m/s^2) are needed",
                                       scene.body_acceleration.x, scene.body_acceleration.y, usable_numbers));
  }
  for (const Fix& fix : scene.fixes) {
    check_nodes(fix.where, fix.nodes, mesh);
    check_window(fix.where, fix.window);
  }
  for (const Move& move : scene.moves) {
    check_nodes(move.where, move.nodes, mesh);
    check_window(move.where, move.window);
    check_keys(move.where, move.keys, [](const MoveKey& key) { return usable(key.u) && usable(key.v); });
  }
  for (const Constraint& constraint : scene.constraints) check_constraint(constraint, mesh);
  for (const Traction& traction : scene.tractions) check_traction(traction, mesh);
  check_edges(scene.tractions, mesh);
  check_probes(scene.probes, mesh);
  validate(scene.time);
  validate(scene.picture);
  const std::size_t branches = most_branches(scene);
  if (static_cast<std::size_t>(scene.picture.branch) > branches) {
    refuse("[render]",
           fmt::format("branch = {}: {} {} Maxwell branch{}, 0 is all of them", scene.picture.branch,
                       scene.regions.empty() ? "the material has" : "the materials have at most", branches,
                       branches == 1 ? "" : "es"));
  }
}

}  // namespace rheo
