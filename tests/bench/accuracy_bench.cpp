// Time and error of whole runs: the paper's beam, refined and jittered, lumped, 2 s, 60 outputs a second,
// traction on for 1 s.
//
//   integrate/exponential/<tolerance>/<triangles>       the exponential integrator with this tolerance
//   integrate/rk4/<divisor>/<triangles>                 RK4 with the largest stable step over the divisor
//   integrate/accuracy/<accuracy>/<triangles>           [time] accuracy: what the engine chooses, the choice
//   included integrate/accuracy_rk4/<accuracy>/<triangles>       likewise with integrator = "rk4"
//
// Counters: error as [time] accuracy means it (against a run of the exponential integrator at 1e-13), force
// evaluations, time an evaluation. Label: the hash of the state at the last output. Without energies.
// Seconds: of a run from its start to its end, building the simulation apart except where the choice is part
// of it. Compare medians of a machine that does nothing else:
// --benchmark_repetitions=5 --benchmark_enable_random_interleaving=true.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bench/counters.hpp"
#include "rheo/shapes.hpp"
#include "rheo/simulation.hpp"

namespace {

// 1 m x 0.25 m in about `triangles` triangles; inner nodes are moved by up to a quarter of their distance.
rheo::Scene beam(int triangles) {
  const int ny = std::max(2, static_cast<int>(std::lround(std::sqrt(triangles / 8.0))) + 1);
  const int nx = 4 * (ny - 1) + 1;
  rheo::Scene scene;
  scene.mesh = rheo::rectangle({1.0, 0.25}, nx, ny, rheo::Diagonal::alternating);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.25 / (nx - 1), 0.25 / (nx - 1));
  for (int row = 1; row + 1 < ny; ++row) {
    for (int column = 1; column + 1 < nx; ++column) {
      rheo::Vec2& point = scene.mesh.points[static_cast<std::size_t>(row * nx + column)];
      point.x += shift(random);
      point.y += shift(random);
    }
  }
  rheo::prepare(scene.mesh);
  scene.material = {7, 5, 4, 2, 0.2, rheo::Mass::lumped};
  scene.fixes.push_back({rheo::nodes_of(scene.mesh.edge_groups.at("left")), rheo::Axis::both, {}, ""});
  scene.tractions.push_back({scene.mesh.edge_groups.at("right"), {{0, {10, 0}}}, {0.0, 1.0}, ""});
  scene.time.duration = 2.0;
  return scene;
}

// u, v, w_lambda, w_mu at all outputs, block by block.
using States = std::vector<std::array<std::vector<double>, 4>>;

States run(rheo::Simulation& simulation) {
  States states;
  for (std::int64_t k = 0; k < rheo::output_count(simulation.scene().time); ++k) {
    if (simulation.advance(rheo::output_time(simulation.scene().time, k))) return {};
    const auto copy = [](std::span<const double> x) { return std::vector<double>(x.begin(), x.end()); };
    states.push_back(
        {copy(simulation.u()), copy(simulation.v()), copy(simulation.w_lambda()), copy(simulation.w_mu())});
  }
  return states;
}

double error_of(const States& states, const States& exact) {
  if (states.size() != exact.size()) return std::numeric_limits<double>::quiet_NaN();
  double error = 0.0;
  for (std::size_t block = 0; block < 4; ++block) {
    double largest = 0.0, difference = 0.0;
    for (std::size_t k = 0; k < states.size(); ++k) {
      double size = 0.0, distance = 0.0;
      for (std::size_t i = 0; i < exact[k][block].size(); ++i) {
        size += std::pow(exact[k][block][i], 2);
        distance += std::pow(exact[k][block][i] - states[k][block][i], 2);
      }
      largest = std::max(largest, std::sqrt(size));
      difference = std::max(difference, std::sqrt(distance));
    }
    error = std::max(error, difference / largest);
  }
  return error;
}

struct Case {
  rheo::Scene scene;
  States exact;
};

const Case& case_of(int triangles) {
  static std::map<int, std::unique_ptr<Case>> cases;
  auto& one = cases[triangles];
  if (!one) {
    one = std::make_unique<Case>(Case{beam(triangles), {}});
    rheo::Scene exact = one->scene;
    exact.time.integrator = rheo::IntegratorKind::exponential;
    exact.time.tolerance = rheo::finest_tolerance;
    rheo::Simulation simulation(exact, {.energies = false});
    one->exact = run(simulation);
  }
  return *one;
}

void integrate(benchmark::State& state, const rheo::Scene& scene, const Case& c, int threads) {
  const bool choosing = scene.time.accuracy > 0.0;
  States states;
  double evaluations = 0.0, trials = 0.0, seconds = 0.0;
  for (auto _ : state) {
    using Clock = std::chrono::steady_clock;
    auto start = Clock::now();
    rheo::Simulation simulation(scene, {.energies = false, .threads = threads});
    if (!choosing) start = Clock::now();
    states = run(simulation);
    const double taken = std::chrono::duration<double>(Clock::now() - start).count();
    state.SetIterationTime(taken);
    seconds += taken;
    evaluations = static_cast<double>(simulation.counters().force_evaluations);
    if (simulation.plan()) trials = simulation.plan()->trial_evaluations;
  }
  bench::StateHash hash;
  if (!states.empty())
    for (const std::vector<double>& block : states.back()) hash.add(block);
  hash.report(state, error_of(states, c.exact));
  state.counters["evaluations"] = evaluations;
  state.counters["trial_evaluations"] = trials;
  state.counters["time/evaluation"] =
      benchmark::Counter((evaluations + trials) * static_cast<double>(state.iterations()) / seconds,
                         benchmark::Counter::kInvert);
}

void exponential(benchmark::State& state, double tolerance, int triangles) {
  const Case& c = case_of(triangles);
  rheo::Scene scene = c.scene;
  scene.time.integrator = rheo::IntegratorKind::exponential;
  scene.time.tolerance = tolerance;
  integrate(state, scene, c, 1);
}

void rk4(benchmark::State& state, double divisor, int triangles) {
  const Case& c = case_of(triangles);
  rheo::Scene scene = c.scene;
  scene.time.integrator = rheo::IntegratorKind::rk4;
  scene.time.step = rheo::Simulation(scene).stable_step() / divisor;
  integrate(state, scene, c, 1);
}

void accuracy(benchmark::State& state, double accuracy, int triangles, rheo::IntegratorKind integrator) {
  const Case& c = case_of(triangles);
  rheo::Scene scene = c.scene;
  scene.time.integrator = integrator;
  scene.time.accuracy = accuracy;
  integrate(state, scene, c, 1);
}

const bool registered = [] {
  const auto add = [](const std::string& name, auto function) {
    benchmark::RegisterBenchmark(name.c_str(), function)->UseManualTime()->Unit(benchmark::kMillisecond);
  };
  for (const int triangles : {1000, 10000}) {
    const std::string size = triangles == 1000 ? "/1000" : "/10000";
    for (const char* text : {"1e-3", "1e-5", "1e-9"}) {
      const double value = std::atof(text);
      add("integrate/exponential/" + std::string(text) + size,
          [=](benchmark::State& state) { exponential(state, value, triangles); });
      add("integrate/accuracy/" + std::string(text) + size, [=](benchmark::State& state) {
        accuracy(state, value, triangles, rheo::IntegratorKind::automatic);
      });
    }
    // 1e-9 would take RK4 some 170 times its stable step's evaluations: extrapolate by its order.
    for (const char* text : {"1e-3", "1e-5"}) {
      const double value = std::atof(text);
      add("integrate/accuracy_rk4/" + std::string(text) + size,
          [=](benchmark::State& state) { accuracy(state, value, triangles, rheo::IntegratorKind::rk4); });
    }
    for (const char* text : {"1", "2", "4", "8", "16"}) {
      const double divisor = std::atof(text);
      add("integrate/rk4/" + std::string(text) + size,
          [=](benchmark::State& state) { rk4(state, divisor, triangles); });
    }
  }
  return true;
}();

}  // namespace
