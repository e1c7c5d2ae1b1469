// Every kind of body under hands, for tests of what a tick does not do.
#pragma once

#include <ostream>
#include <vector>

#include "support/live_scenes.hpp"

namespace rheo::test {

struct LiveCase {
  const char* name;
  Mass mass;
  Kernel kernel;
  int threads;
  bool general_constraint;
  bool parallel = false;  // two branches, an elastic and a viscous part
};

inline std::ostream& operator<<(std::ostream& out, const LiveCase& each) {
  return out << each.name;
}

inline const std::vector<LiveCase> live_cases{
    {"edge", Mass::lumped, Kernel::edge, 1, false},
    {"edge_on_two_threads", Mass::lumped, Kernel::edge, 2, false},
    {"element", Mass::lumped, Kernel::element, 1, false},
    {"element_on_two_threads", Mass::lumped, Kernel::element, 2, false},
    {"csr", Mass::lumped, Kernel::csr, 1, false},
    {"csr_consistent", Mass::consistent, Kernel::csr, 1, false},
    {"csr_constraint", Mass::lumped, Kernel::csr, 1, true},
    {"edge_of_many_parts", Mass::lumped, Kernel::edge, 1, false, true},
    {"element_of_many_parts", Mass::lumped, Kernel::element, 1, false, true},
    {"csr_of_many_parts", Mass::consistent, Kernel::csr, 1, false, true}};

// At haptic rate; large enough for the threads to have work.
inline Live live_of(const LiveCase& each) {
  Scene scene = each.threads > 1 ? live_block(each.mass, 61, 41) : live_block(each.mass);
  scene.time.step = 0.0;
  if (each.parallel) {
    Material& m = scene.material;
    m.more_branches.push_back({m.lambda_ela, m.mu_ela, 0.1 * m.lambda_vis, 0.2 * m.mu_vis});
    m.elastic = {0.5 * m.lambda_ela, 0.5 * m.mu_ela};
    m.viscous = {1e-3 * m.lambda_ela, 1e-3 * m.mu_ela};
  }
  if (each.general_constraint) {
    scene.constraints.push_back({{{30, Axis::x, 1.0}, {31, Axis::x, -1.0}}, 0.0, "tie"});
  }
  LiveSettings settings = live_settings(scene);
  settings.rate = 1000.0;
  settings.simulation.kernel = each.kernel;
  settings.simulation.threads = each.threads;
  settings.record = 100'000;
  return Live(scene, settings);
}

// Pushes, drags, lets go and reads for so many ticks; whether all went well, with numbers.
inline bool work(Live& live, const LiveCase& each, int ticks) {
  double checked = 0.0;
  for (int k = 0; k < ticks; ++k) {
    // With factors to make, a hold of what was picked would make one.
    if (k % 120 != 25 || (each.mass == Mass::lumped && !each.general_constraint)) act(live, k % 120);
    if (live.tick()) return false;
    checked += live.read(grab_handle).force.x + live.simulation().u()[0] + live.simulation().energies().work;
  }
  return std::isfinite(checked);
}

}  // namespace rheo::test
