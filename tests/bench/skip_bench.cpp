// What is left out where a scene does not need it: the time with against without, on about 10k triangles.
//
//   skip/constraints/...   fixed nodes eliminated; the same by Baumgarte's equation for each (KKT)
//   skip/branches/...      one rate: the branches combined; the same material with both advanced
//   skip/zero_modulus/...  mu_ela = 0: no branch; one so small that it changes nothing: advanced
//   skip/relaxation/...    nothing relaxes: residual forces taken from u; combined, advanced; both
//   skip/displacement/...  u advanced once a step; in every sweep
//   skip/energies/...      energies at no step; at every step
//   skip/norms/...         norms of w_lambda and w_mu at no step; at every step
//   skip/rest/...          a simulated second of a body at rest; of one that still moves
//   skip/rest/under_load/...   1k triangles under a traction: at rest; stepped on, as the traction changes by
//                          nothing that shows; likewise skip/rest/constraint/... with a general constraint
//   skip/denormals/...     a step from 1; after 1e6 s of relaxation, stepped through; there without flushing
//                          denormals (about 100 triangles)
//
// Colour and upload, with against without: rheo_bench_render, DrawAndReadBack...
//
// Counters: time a triangle and step; of rest: time a simulated second. Label: the hash of the state after
// the first, untimed steps; with and without differ by rounding, and by what is said above.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bench/counters.hpp"
#include "bench/step_case.hpp"
#include "kernels/edge_body.hpp"
#include "kernels/flush_denormals.hpp"
#include "rheo/simulation.hpp"

namespace {

constexpr int triangles = 10000;
constexpr int hashed_steps = 8;

// Whole steps of the engine, no output between them.
void simulate(benchmark::State& state, rheo::Scene scene, bool energies) {
  constexpr int steps = 16;
  scene.time.duration = 1e6;
  scene.time.frame_rate = 1e-6;
  rheo::SimulationOptions options;
  options.threads = 1;
  options.energies = energies;
  rheo::Simulation simulation(std::move(scene), options);
  const double length = steps * simulation.step_bound();
  double t = length;
  if (simulation.advance(t)) state.SkipWithError("diverged");
  bench::StateHash().add(simulation).report(state);
  for (auto _ : state) {
    t += length;
    if (simulation.advance(t)) {
      state.SkipWithError("diverged");
      return;
    }
  }
  bench::report_time(state, steps * simulation.scene().mesh.triangle_count());
}

rheo::Scene block() {
  return bench::case_of(triangles).scene;
}

void constraints(benchmark::State& state, rheo::ConstraintMethod method) {
  rheo::Scene scene = block();
  scene.time.constraints = method;
  simulate(state, std::move(scene), false);
}

void energies(benchmark::State& state, bool asked) {
  simulate(state, block(), asked);
}

enum class Norms { never, at_every_step };

// As many steps one by one, and what history.csv says of each where it is wanted.
void norms(benchmark::State& state, Norms wanted) {
  rheo::Scene scene = block();
  scene.time.duration = 1e6;
  scene.time.frame_rate = 1e-6;
  rheo::Simulation simulation(std::move(scene), {.energies = false, .threads = 1});
  const auto norm = [](std::span<const double> x) {
    double sum = 0.0;
    for (const double value : x) sum += value * value;
    return std::sqrt(sum);
  };
  double t = 0.0;
  bool fine = true;
  const auto step = [&] {
    t += simulation.step_bound();
    fine = !simulation.advance(t) && fine;
    if (wanted == Norms::never) return;
    benchmark::DoNotOptimize(norm(simulation.w_lambda()));
    benchmark::DoNotOptimize(norm(simulation.w_mu()));
  };
  for (int k = 0; k < hashed_steps; ++k) step();
  bench::StateHash().add(simulation).report(state);
  for (auto _ : state) step();
  if (!fine) state.SkipWithError("diverged");
  bench::report_time(state, simulation.scene().mesh.triangle_count());
}

// Steps of the edge kernel alone, with what it is told of the material.
void edge_steps(benchmark::State& state, const rheo::Material& material, const rheo::EdgeForm& form,
                const std::function<void(rheo::EdgeBody&, double)>& step) {
  const bench::Case& c = bench::case_of(triangles);
  const rheo::Model model(c.scene.mesh, material);
  const rheo::EdgeForce force(std::make_shared<rheo::EdgeForm>(form), rheo::best_simd_level());
  rheo::EdgeBody body(model, force, 1);
  body.enter(c.interval, c.base);
  body.load(c.y);
  for (int k = 0; k < hashed_steps; ++k) step(body, c.step);
  bench::StateHash().add(body.state()).report(state);
  for (auto _ : state) step(body, c.step);
  bench::report_time(state, c.scene.mesh.triangle_count());
}

rheo::Material one_rate() {
  return {7, 5, 14, 10, 0.2, rheo::Mass::lumped};
}
rheo::Material elastic() {
  return {7, 5, rheo::forever, rheo::forever, 0.2, rheo::Mass::lumped};
}
// All but elastic: rates that change nothing in a benchmark's time.
rheo::Material nearly_elastic() {
  return {7, 5, 7e9, 5e9, 0.2, rheo::Mass::lumped};
}

rheo::Material without_mu() {
  return {7, 0, 4, 2, 0.2, rheo::Mass::lumped};
}
rheo::Material nearly_without_mu() {
  return {7, 1e-12, 4, 2, 0.2, rheo::Mass::lumped};
}

enum class Branches { apart, together };

void branches(benchmark::State& state, const rheo::Material& material, Branches way) {
  const rheo::Mesh& mesh = bench::case_of(triangles).scene.mesh;
  const rheo::EdgeForm form =
      way == Branches::together ? rheo::EdgeForm(mesh, rheo::combined(material)) : rheo::EdgeForm(mesh);
  std::unique_ptr<rheo::Integrator> rk4;
  edge_steps(state, material, form, [&](rheo::EdgeBody& body, double h) {
    if (!rk4) rk4 = rheo::make_integrator(rheo::IntegratorKind::rk4, body.size());
    rk4->step(body, 0.0, h, body.state(), {});
  });
}

void displacement(benchmark::State& state, rheo::Result inner) {
  const bench::Case& c = bench::case_of(triangles);
  std::vector<double> a, b;
  edge_steps(state, c.scene.material, rheo::EdgeForm(c.scene.mesh), [&](rheo::EdgeBody& body, double h) {
    a.resize(body.size());
    b.resize(body.size());
    const auto y = body.state();
    const rheo::Forcing none{};
    const std::array<rheo::LinearOperator::Sweep, 4> sweeps{{{h / 4, y, y, none, a, inner},
                                                             {h / 3, a, y, none, b, inner},
                                                             {h / 2, b, y, none, a, inner},
                                                             {h, a, y, none, y, rheo::Result::step}}};
    body.chain(sweeps);
  });
}

void rest(benchmark::State& state, bool moving) {
  rheo::Scene scene = block();
  scene.tractions[0].window.until = 0.01;
  scene.time.duration = 1e7;
  scene.time.frame_rate = 1e-3;
  if (moving) {
    scene.material.lambda_vis = scene.material.mu_vis = rheo::forever;  // for ever
  } else {
    scene.material = {7, 5, 0.7, 0.5, 0.2, rheo::Mass::lumped};
  }
  rheo::SimulationOptions options;
  options.threads = 1;
  rheo::Simulation simulation(std::move(scene), options);
  double t = moving ? 0.02 : 30.0;
  if (simulation.advance(t)) state.SkipWithError("diverged");
  bench::StateHash().add(simulation).report(state);
  const double length = moving ? 0.01 : 1.0;
  for (auto _ : state) {
    t += length;
    benchmark::DoNotOptimize(simulation.advance(t));
  }
  state.counters["time/s"] = bench::seconds_over(length);
}

enum class Load { constant, changing };
enum class Bound { free, by_constraint };

// A hundred of its steps; a body that finds back and is damped strongly, so that it soon rests.
void loaded(benchmark::State& state, Load load, Bound bound) {
  rheo::Scene scene = bench::case_of(triangles / 10).scene;
  scene.material = {7, 5, 0.7, 0.5, 0.2, rheo::Mass::lumped};
  scene.material.elastic = {6, 4};
  scene.fixes[0].nodes = rheo::nodes_of(scene.mesh.edge_groups.at("bottom"));
  rheo::Traction& traction = scene.tractions[0];
  traction.window = {};
  traction.keys = {{0.0, {1.0, 0.0}}};
  if (load == Load::changing) traction.keys.push_back({1e7, {1.0 + 1e-12, 0.0}});
  if (bound == Bound::by_constraint) {
    const auto nodes = rheo::nodes_of(scene.mesh.edge_groups.at("right"));
    scene.constraints.push_back(
        {{{nodes[nodes.size() / 2], rheo::Axis::x, 1.0}, {nodes.back(), rheo::Axis::x, -1.0}}, 0.0, ""});
  }
  scene.time.duration = 1e7;
  scene.time.frame_rate = 1e-3;
  rheo::Simulation simulation(std::move(scene), {.energies = false, .threads = 1});
  double t = load == Load::constant ? 60.0 : 0.1;  // steps take as long at any time
  if (simulation.advance(t)) state.SkipWithError("diverged");
  if (load == Load::constant && simulation.counters().steps_at_rest == 0)
    state.SkipWithError("it does not come to rest");
  bench::StateHash().add(simulation).report(state);
  const double length = load == Load::constant ? 1.0 : 100.0 * simulation.step_bound();
  for (auto _ : state) {
    t += length;
    benchmark::DoNotOptimize(simulation.advance(t));
  }
  state.counters["time/s"] = bench::seconds_over(length);
}

enum class State { fresh, relaxed };
enum class Denormals { flushed, kept };

// A body so soft and heavy that 1e6 s are as long for it as it takes to relax to the smallest normal numbers.
// There a state stays whose denormal increments are taken for zero; kept, they are what its steps are made
// of.
struct SlowBody {
  SlowBody()
      : material{7e-5, 5e-5, 7e-5 / rate, 5e-5 / rate, 0.2, rheo::Mass::lumped},
        model(bench::case_of(100).scene.mesh, material),
        force(std::make_shared<rheo::EdgeForm>(bench::case_of(100).scene.mesh), rheo::best_simd_level()),
        unloaded(bench::case_of(100).interval),
        step(1.0 / model.element_omega) {  // of a stable 2.8
    unloaded.force.setZero();
  }

  static constexpr double rate = 1.4e-3;
  rheo::Material material;
  rheo::Model model;
  rheo::EdgeForce force;
  rheo::Interval unloaded;
  double step;
};

struct Relaxed {
  std::vector<double> y;  // the body's order
  double seconds = 0.0;   // simulated
  double left = 0.0;      // the largest number but of u, which stays
};

// Every step of it is taken.
const Relaxed& relaxed(const SlowBody& slow) {
  static const Relaxed result = [&] {
    const rheo::FlushDenormals flush;
    const bench::Case& c = bench::case_of(100);
    rheo::EdgeBody body(slow.model, slow.force, 1);
    body.enter(slow.unloaded, c.base);
    body.load(c.y);
    const auto rk4 = rheo::make_integrator(rheo::IntegratorKind::rk4, body.size());
    const std::size_t moving = body.size() - 2 * static_cast<std::size_t>(slow.force.form().nodes);
    Relaxed r;
    for (std::int64_t k = 1; r.seconds < 1e6; ++k) {
      rk4->step(body, 0.0, slow.step, body.state(), {});
      r.seconds = static_cast<double>(k) * slow.step;
    }
    for (const double x : body.state().first(moving)) r.left = std::max(r.left, std::abs(x));
    r.y.assign(body.state().begin(), body.state().end());
    return r;
  }();
  return result;
}

void denormals(benchmark::State& state, State size, Denormals way) {
  static const SlowBody slow;
  const bench::Case& c = bench::case_of(100);
  rheo::EdgeBody body(slow.model, slow.force, 1);
  body.enter(slow.unloaded, c.base);
  body.load(c.y);
  if (size == State::relaxed) {
    const Relaxed& r = relaxed(slow);
    std::copy(r.y.begin(), r.y.end(), body.state().begin());
    state.counters["relaxed_s"] = r.seconds;
    state.counters["left"] = r.left;
  }
  std::unique_ptr<rheo::FlushDenormals> flush;
  if (way == Denormals::flushed) flush = std::make_unique<rheo::FlushDenormals>();
  const auto rk4 = rheo::make_integrator(rheo::IntegratorKind::rk4, body.size());
  const auto step = [&] { rk4->step(body, 0.0, slow.step, body.state(), {}); };
  for (int k = 0; k < hashed_steps; ++k) step();
  bench::StateHash().add(body.state()).report(state);
  for (auto _ : state) step();
  bench::report_time(state, c.scene.mesh.triangle_count());
}

BENCHMARK_CAPTURE(constraints, eliminated, rheo::ConstraintMethod::automatic)
    ->Name("skip/constraints/eliminated")
    ->UseRealTime();
BENCHMARK_CAPTURE(constraints, solved, rheo::ConstraintMethod::baumgarte)
    ->Name("skip/constraints/solved_for")
    ->UseRealTime();
BENCHMARK_CAPTURE(branches, one, one_rate(), Branches::together)
    ->Name("skip/branches/combined")
    ->UseRealTime();
BENCHMARK_CAPTURE(branches, two, one_rate(), Branches::apart)->Name("skip/branches/both")->UseRealTime();
BENCHMARK_CAPTURE(branches, zero, without_mu(), Branches::together)
    ->Name("skip/zero_modulus/no_branch")
    ->UseRealTime();
BENCHMARK_CAPTURE(branches, tiny, nearly_without_mu(), Branches::together)
    ->Name("skip/zero_modulus/advanced")
    ->UseRealTime();
BENCHMARK_CAPTURE(branches, elastic, elastic(), Branches::together)
    ->Name("skip/relaxation/from_u")
    ->UseRealTime();
BENCHMARK_CAPTURE(branches, advanced, nearly_elastic(), Branches::together)
    ->Name("skip/relaxation/combined")
    ->UseRealTime();
BENCHMARK_CAPTURE(branches, both, elastic(), Branches::apart)->Name("skip/relaxation/both")->UseRealTime();
BENCHMARK_CAPTURE(displacement, once, rheo::Result::intermediate)
    ->Name("skip/displacement/once")
    ->UseRealTime();
BENCHMARK_CAPTURE(displacement, always, rheo::Result::step)
    ->Name("skip/displacement/every_sweep")
    ->UseRealTime();
BENCHMARK_CAPTURE(energies, never, false)->Name("skip/energies/never")->UseRealTime();
BENCHMARK_CAPTURE(energies, always, true)->Name("skip/energies/every_step")->UseRealTime();
BENCHMARK_CAPTURE(norms, never, Norms::never)->Name("skip/norms/never")->UseRealTime();
BENCHMARK_CAPTURE(norms, always, Norms::at_every_step)->Name("skip/norms/every_step")->UseRealTime();
BENCHMARK_CAPTURE(rest, still, false)->Name("skip/rest/at_rest")->UseRealTime();
BENCHMARK_CAPTURE(rest, moving, true)->Name("skip/rest/moving")->UseRealTime();
BENCHMARK_CAPTURE(loaded, rest, Load::constant, Bound::free)
    ->Name("skip/rest/under_load/at_rest")
    ->UseRealTime();
BENCHMARK_CAPTURE(loaded, stepped, Load::changing, Bound::free)
    ->Name("skip/rest/under_load/stepped")
    ->UseRealTime();
BENCHMARK_CAPTURE(loaded, bound_rest, Load::constant, Bound::by_constraint)
    ->Name("skip/rest/constraint/at_rest")
    ->UseRealTime();
BENCHMARK_CAPTURE(loaded, bound_stepped, Load::changing, Bound::by_constraint)
    ->Name("skip/rest/constraint/stepped")
    ->UseRealTime();
BENCHMARK_CAPTURE(denormals, fresh, State::fresh, Denormals::flushed)
    ->Name("skip/denormals/fresh")
    ->UseRealTime();
BENCHMARK_CAPTURE(denormals, relaxed, State::relaxed, Denormals::flushed)
    ->Name("skip/denormals/relaxed")
    ->UseRealTime();
BENCHMARK_CAPTURE(denormals, kept, State::relaxed, Denormals::kept)
    ->Name("skip/denormals/relaxed_unflushed")
    ->UseRealTime();

}  // namespace
