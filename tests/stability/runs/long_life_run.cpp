#include "stability/runs/long_life_run.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>

#include "rheo/shapes.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

std::int64_t resident_memory() {
  std::ifstream file("/proc/self/statm");
  std::int64_t all = 0, resident = 0;
  if (!(file >> all >> resident)) return 0;
  return resident * sysconf(_SC_PAGESIZE);
}

// One period; the second half is the first one's opposite to the bit, so that the mean is 0.
std::vector<double> wave_of(std::int64_t ticks) {
  std::vector<double> wave(static_cast<std::size_t>(ticks));
  const std::size_t half = wave.size() / 2;
  for (std::size_t k = 0; k < half; ++k) {
    wave[k] = std::sin(std::numbers::pi * static_cast<double>(k) / static_cast<double>(half));
    wave[half + k] = -wave[k];
  }
  return wave;
}

// u, v, w_lambda, w_mu.
using Blocks = std::vector<std::vector<double>>;

Blocks blocks_of(const Simulation& s) {
  Blocks all;
  for (const auto x : {s.u(), s.v(), s.w_lambda(), s.w_mu()}) all.emplace_back(x.begin(), x.end());
  return all;
}

void include(const Simulation& s, std::vector<double>& largest) {
  const std::span<const double> all[] = {s.u(), s.v(), s.w_lambda(), s.w_mu()};
  for (std::size_t b = 0; b < largest.size(); ++b) {
    for (const double x : all[b]) largest[b] = std::max(largest[b], std::abs(x));
  }
}

}  // namespace

std::int64_t LongLifeOutcome::steps() const {
  std::int64_t sum = 0;
  for (const Tenth& tenth : tenths) sum += tenth.steps;
  return sum;
}

double LongLifeOutcome::worst_drift() const {
  double worst = 0.0;
  for (const Tenth& tenth : tenths) worst = std::max(worst, tenth.drift);
  return worst;
}

double LongLifeOutcome::allowed_drift() const {
  return std::numeric_limits<double>::epsilon() * static_cast<double>(steps()) + tolerance;
}

LongLife long_lived_beam(IntegratorKind integrator, std::int64_t periods) {
  LongLife life;
  life.name = "beam";
  life.scene = paper_beam(Mass::lumped);
  life.pulled = life.scene.mesh.edge_groups.at("right");
  life.scene.tractions.clear();
  life.scene.time.integrator = integrator;
  life.pull = {0.5, 0.1};
  life.periods = periods;
  return life;
}

LongLife long_lived_block(IntegratorKind integrator, int nx, int ny, std::int64_t periods) {
  LongLife life;
  life.name = "block";
  life.scene.mesh = rectangle({0.1, 0.05}, nx, ny, Diagonal::alternating);
  life.scene.mesh.thickness = 0.01;
  life.scene.material = {4000.0, 1500.0, 40.0, 15.0, 1000.0, Mass::lumped};
  life.scene.material.elastic = {1000.0, 500.0};
  life.scene.fixes.push_back({nodes_of(life.scene.mesh.edge_groups.at("bottom")), Axis::both, {}, "floor"});
  life.scene.time.duration = 10.0;
  life.scene.time.integrator = integrator;
  life.pulled = life.scene.mesh.edge_groups.at("top");
  life.pull = {20.0, 10.0};
  life.rate = 600.0;
  life.periods = periods;
  return life;
}

LongLifeOutcome live_long(const LongLife& life) {
  LiveSettings settings;
  settings.rate = life.rate;
  settings.handles = {{"grip", {}, life.pulled}};
  settings.simulation = life.options;
  Scene scene = life.scene;
  if (scene.time.integrator == IntegratorKind::exponential) {
    // Its tolerance is that of the whole run, shared out among the outputs.
    scene.time.duration = static_cast<double>(life.periods * life.ticks_a_period) / life.rate;
    scene.time.frame_rate = life.rate;
  }
  Live live(scene, settings);
  const std::vector<double> wave = wave_of(life.ticks_a_period);
  LongLifeOutcome outcome;
  if (scene.time.integrator == IntegratorKind::exponential) outcome.tolerance = scene.time.tolerance;
  Blocks first;
  std::vector<double> largest(4, 0.0);
  const std::int64_t periods = life.periods / 10;
  for (int part = 0; part < 10; ++part) {
    Tenth tenth;
    const Counters before = live.simulation().counters();
    const auto begin = std::chrono::steady_clock::now();
    for (std::int64_t period = 0; period < periods; ++period) {
      for (std::int64_t k = 0; k < life.ticks_a_period; ++k) {
        // Where this tick ends.
        const double share = wave[static_cast<std::size_t>((k + 1) % life.ticks_a_period)];
        live.push(0, {share * life.pull.x, share * life.pull.y});
        if (live.tick()) {
          outcome.diverged = true;
          return outcome;
        }
        if (part == 0 && period + 1 == periods) include(live.simulation(), largest);
      }
    }
    tenth.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const Counters& now = live.simulation().counters();
    tenth.steps = now.steps - before.steps;
    tenth.evaluations = static_cast<double>(now.force_evaluations - before.force_evaluations) /
                        static_cast<double>(tenth.steps);
    tenth.memory = resident_memory();
    const Energies e = live.simulation().energies();
    tenth.balance = (e.kinetic + e.stored + e.dissipated - e.work) / e.dissipated;
    const Blocks state = blocks_of(live.simulation());
    if (part == 0) first = state;
    for (std::size_t b = 0; b < state.size(); ++b) {
      for (std::size_t i = 0; i < state[b].size(); ++i) {
        outcome.finite = outcome.finite && std::isfinite(state[b][i]);
        tenth.drift = std::max(tenth.drift, std::abs(state[b][i] - first[b][i]) / largest[b]);
      }
    }
    outcome.tenths.push_back(tenth);
  }
  return outcome;
}

}  // namespace rheo::test
