// Whole runs on a mesh that is so fine in one corner that the largest stable RK4 step is 100,000 times
// shorter than a frame (support/graded.hpp).
//
//   integrate/implicit_graded/<steps a frame>  the run, its factor included, construction left out. Counters:
//   the
//                                              error at the outputs against a run of 16 steps a frame,
//                                              factors, steps; label: the hash of the last state
//   integrate/rk4_graded                       1,000 steps of RK4 at its stable limit. run_seconds: what all
//   steps of
//                                              the run would take at this rate; no shorter RK4 run exists,
//                                              whatever the error allowed
//
// The quotient of run_seconds and implicit_graded's time, at an error below 1e-2, is the gain.
// That run of 16 steps a frame is within 1e-3 of one of 256, and the implicit integrator within that of the
// exponential one on the first tenth of a second.

#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <utility>

#include "bench/counters.hpp"
#include "rheo/simulation.hpp"
#include "support/exact.hpp"
#include "support/graded.hpp"

namespace {

using rheo::test::ExactState;

constexpr double finest = 4e-7;  // m

rheo::Scene implicit_scene(std::int64_t steps_a_frame) {
  rheo::Scene scene = rheo::test::graded_block(finest);
  scene.time.integrator = rheo::IntegratorKind::implicit;
  scene.time.step = 1.0 / scene.time.frame_rate / static_cast<double>(steps_a_frame);
  return scene;
}

std::vector<ExactState> run(rheo::Simulation& simulation) {
  const rheo::TimeSettings& time = simulation.scene().time;
  const auto copy = [](std::span<const double> x) -> Eigen::VectorXd {
    return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  };
  std::vector<ExactState> states;
  for (std::int64_t k = 1; k < rheo::output_count(time); ++k) {
    const double t = rheo::output_time(time, k);
    if (simulation.advance(t)) return {};
    states.push_back({t, copy(simulation.u()), copy(simulation.v()), copy(simulation.w_lambda()),
                      copy(simulation.w_mu())});
  }
  return states;
}

const std::vector<ExactState>& reference() {
  static const std::vector<ExactState> states = [] {
    rheo::Simulation simulation(implicit_scene(16), {.energies = false});
    return run(simulation);
  }();
  return states;
}

void implicit_graded(benchmark::State& state) {
  const rheo::Scene scene = implicit_scene(state.range(0));
  std::vector<ExactState> states;
  rheo::Counters counters;
  for (auto _ : state) {
    state.PauseTiming();
    rheo::Simulation simulation(scene, {.energies = false});
    state.ResumeTiming();
    states = run(simulation);
    counters = simulation.counters();
  }
  if (states.empty()) {
    state.SkipWithError("diverged");
    return;
  }
  state.counters["steps"] = static_cast<double>(counters.steps);
  state.counters["factors"] = static_cast<double>(counters.factors);
  const ExactState& last = states.back();
  bench::StateHash hash;
  for (const auto* block : {&last.u, &last.v, &last.w_lambda, &last.w_mu})
    hash.add({block->data(), static_cast<std::size_t>(block->size())});
  hash.report(state, rheo::test::run_error(reference(), states));
}

void rk4_graded(benchmark::State& state) {
  rheo::Scene scene = rheo::test::graded_block(finest);
  const double limit = rheo::Simulation(scene).stable_step();
  scene.time.step = 0.999 * limit;
  rheo::Simulation simulation(scene, {.energies = false});
  constexpr int steps = 1000;
  bool first = true;  // the hash is that after so many steps, whatever the number of iterations
  for (auto _ : state) {
    if (simulation.advance(simulation.time() + steps * scene.time.step)) {
      state.SkipWithError("diverged");
      return;
    }
    if (std::exchange(first, false)) bench::StateHash().add(simulation).report(state);
    benchmark::ClobberMemory();
  }
  const double iterations = scene.time.duration / scene.time.step / steps;
  state.counters["run_seconds"] = bench::seconds_over(1.0 / iterations);
  state.counters["frame/limit"] = 1.0 / scene.time.frame_rate / limit;
}

BENCHMARK(implicit_graded)
    ->Name("integrate/implicit_graded")
    ->Arg(1)
    ->Arg(2)
    ->Arg(4)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(rk4_graded)->Name("integrate/rk4_graded")->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
