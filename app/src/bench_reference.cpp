#include "bench_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "bench_setting.hpp"
#include "failure.hpp"
#include "rheo/dense_flow.hpp"
#include "sheet_frames.hpp"

namespace app {
namespace {

using rheo::forever;

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The dense way: so many nodes, and exponentials (some two between neighbouring events), at about a second of
// 64 nodes each.
constexpr int dense_nodes = 64;
double dense_seconds(const rheo::Scene& scene) {
  const auto pieces = static_cast<double>(event_times(scene).size() + 1);
  return 2.0 * pieces * std::pow(scene.mesh.node_count() / static_cast<double>(dense_nodes), 3);
}

// A product of as many rounded exponentials as there are outputs; measured on scenes of all kinds: 1e-13 to
// 1e-12.
constexpr double dense_uncertainty = 2e-12;

// Whether the exponential integrator accepts the scene.
bool has_exponential(const rheo::Scene& scene) {
  return scene.constraints.empty() && (scene.time.constraints == rheo::ConstraintMethod::automatic ||
                                       (scene.fixes.empty() && scene.moves.empty()));
}

// RK4 with `factor` steps in the place of every one that `step` asks for, so that runs of different factors
// share all their coarse times. Ends early, with fewer states, after so many seconds. nullopt: diverged.
std::optional<Trajectory> rk4(const rheo::Scene& scene, const rheo::SimulationOptions& options, double step,
                              int factor, const std::vector<double>& times, double seconds) {
  rheo::Simulation simulation(scene_with(scene, {rheo::IntegratorKind::rk4, step, 0.0}), options);
  std::vector<double> stops = event_times(scene);
  stops.insert(stops.end(), times.begin(), times.end());
  std::ranges::sort(stops);
  Trajectory trajectory{times, {}};
  const Clock::time_point start = Clock::now();
  std::size_t next = 0;
  double from = 0.0;
  for (const double stop : stops) {
    if (stop > times.back() || since(start) > seconds) break;
    const double coarse = std::ceil((stop - from) / step * (1.0 - 1e-12));
    const auto count = static_cast<std::int64_t>(coarse) * factor;
    const std::int64_t before = simulation.counters().steps;
    for (std::int64_t i = 1; i <= count; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(count);
      // At rest until the stop: no step was needed.
      if (i == 2 && simulation.counters().steps == before) i = count;
      if (simulation.advance(i == count ? stop : from + (stop - from) * part)) return std::nullopt;
    }
    from = stop;
    if (next < times.size() && times[next] == stop) {
      copy_state(simulation, trajectory.states.emplace_back());
      ++next;
    }
  }
  return trajectory;
}

void extrapolate(const Trajectory& coarse, Trajectory& fine) {
  for (std::size_t k = 0; k < fine.states.size(); ++k)
    for (std::size_t i = 0; i < fine.states[k].size(); ++i)
      fine.states[k][i] += (fine.states[k][i] - coarse.states[k][i]) / 15.0;
}

struct Rk4Cost {
  double stable = 0.0;
  double seconds = 0.0;  // of a run at the stable step

  double seconds_at(double step) const { return seconds * stable / step; }
  // The smallest step from a 256th of the stable one up whose run, `runs` times over, fits the seconds; 0
  // where none below half of the stable one does.
  double step_within(double budget, double runs) const {
    for (double part = 1.0 / 256.0; part <= 0.5; part *= 2.0)
      if (runs * seconds_at(part * stable) <= budget) return part * stable;
    return 0.0;
  }
};

Rk4Cost cost_of_rk4(const rheo::Scene& scene, const rheo::SimulationOptions& options) {
  Rk4Cost cost;
  rheo::Simulation probe(scene_with(scene, {rheo::IntegratorKind::rk4, 0.0, 0.0}), options);
  cost.stable = std::min(probe.stable_step(), scene.time.duration);
  const double steps = static_cast<double>(probe.planned_steps()) * probe.step_bound() / cost.stable;
  cost.seconds = seconds_per_step(probe) * steps;
  return cost;
}

// The time until which nothing moves.
double waking_time(const Trajectory& exact) {
  double t = 0.0;
  for (std::size_t k = 0; k < exact.times.size(); ++k) {
    if (std::ranges::any_of(exact.states[k], [](double x) { return x != 0.0; })) break;
    t = exact.times[k];
  }
  return t;
}

// About five of the times after one and up to another, spread.
std::vector<double> few_of(const std::vector<double>& times, double after, double end) {
  std::vector<double> within;
  for (const double t : times)
    if (t > after && t <= end) within.push_back(t);
  std::vector<double> few;
  const std::size_t stride = std::max<std::size_t>(1, within.size() / 5);
  for (std::size_t k = within.size(); k >= stride && k > 0; k -= stride)
    few.insert(few.begin(), within[k - 1]);
  return few;
}

void check_by_rk4(Reference& reference, const rheo::Scene& scene, const rheo::SimulationOptions& options,
                  double budget) {
  // Of h and h / 2; each call for one step costs about half a step more.
  constexpr double runs = 1.5 * (1.0 + 2.0);
  // Coarse steps would check little: rather a part of the run with fine ones than all of it.
  constexpr double fine_part = 1.0 / 64.0, coarsest_part = 1.0 / 4.0;  // of the stable step
  const Rk4Cost cost = cost_of_rk4(scene, options);
  const double wakes = waking_time(reference.exact);
  const double whole = cost.step_within(budget, runs);
  double h = whole > 0.0 ? std::min(whole, fine_part * cost.stable) : fine_part * cost.stable;
  std::vector<double> times;
  for (;; h *= 2.0) {
    const double share = std::min(1.0, budget / (runs * cost.seconds_at(h)));
    times = few_of(reference.exact.times, wakes, wakes + scene.time.duration * share);
    if (!times.empty() || h > 0.5 * coarsest_part * cost.stable) break;
  }
  if (times.empty()) {
    reference.check = wakes >= reference.exact.times.back()
                          ? "nothing moves: no check was needed"
                          : "not checked against RK4, which would exceed the budget (--budget)";
    return;
  }
  const auto coarse = rk4(scene, options, h, 1, times, budget);
  auto fine = rk4(scene, options, h, 2, times, budget);
  if (!coarse || !fine) {
    reference.check = "not checked: RK4 diverges";
    return;
  }
  const std::size_t reached = std::min(coarse->states.size(), fine->states.size());
  if (reached == 0) {
    reference.check = "not checked against RK4, which exceeded the budget (--budget)";
    return;
  }
  fine->states.resize(reached);
  extrapolate(*coarse, *fine);
  // Relative to the largest block over all outputs, as the error is.
  ErrorMeter meter(reference.exact);
  for (std::size_t k = 0, next = 0; k < reference.exact.times.size() && next < reached; ++k)
    if (reference.exact.times[k] == times[next]) meter.include(k, fine->states[next++]);
  reference.uncertainty = std::max(reference.uncertainty, meter.error());
  reference.check = fmt::format(
      "RK4 extrapolated from steps of {:.3g} s and half of it agrees to {:.1e} at {} output{} up to {:.4g} s",
      h, meter.error(), reached, reached == 1 ? "" : "s", times[reached - 1]);
}

void follow_exponential(Reference& reference, const rheo::Scene& scene,
                        const rheo::SimulationOptions& options, double budget) {
  rheo::Scene fine = scene_with(scene, {rheo::IntegratorKind::exponential, 0.0, rheo::finest_tolerance});
  {
    rheo::Simulation probe(fine, options);
    const double seconds = seconds_per_step(probe) * static_cast<double>(probe.planned_steps());
    if (seconds > budget)
      throw Failure(
          ExitCode::usage,
          fmt::format(
              "bench: the exact solution would take about {:.2g} s, more than its share of the budget: "
              "give a shorter --duration or a larger --budget",
              seconds));
  }
  rheo::Simulation simulation(std::move(fine), options);
  const Clock::time_point start = Clock::now();
  const auto divergence = follow(simulation, reference.exact);
  reference.exponential_seconds = since(start);
  if (divergence)
    throw Failure(
        ExitCode::usage,
        fmt::format("bench: no exact solution: integrator exponential misses a tolerance of {:g} at t = "
                    "{:.4g} s: check the scene's loads and motions",
                    rheo::finest_tolerance, divergence->t));
  reference.method = fmt::format("integrator exponential at tolerance {:g}", rheo::finest_tolerance);
  reference.uncertainty = reference.claimed = rheo::finest_tolerance;
}

void extrapolate_rk4(Reference& reference, const rheo::Scene& scene, const rheo::SimulationOptions& options,
                     double budget) {
  const Rk4Cost cost = cost_of_rk4(scene, options);
  const double step = cost.step_within(budget, 1.5 * (0.5 + 1.0 + 2.0));  // of 2 h, h and h / 2, as above
  if (step == 0.0)
    throw Failure(
        ExitCode::usage,
        fmt::format("bench: the exact solution by RK4 would take about {:.2g} s, more than its share of the "
                    "budget: give a shorter --duration or a larger --budget",
                    1.5 * 7.0 * cost.seconds));
  const auto coarsest = rk4(scene, options, 2.0 * step, 1, reference.exact.times, forever);
  auto coarse = rk4(scene, options, 2.0 * step, 2, reference.exact.times, forever);
  auto fine = rk4(scene, options, 2.0 * step, 4, reference.exact.times, forever);
  if (!coarsest || !coarse || !fine)
    throw Failure(
        ExitCode::usage,
        "bench: no exact solution: RK4 diverges within its stable step: check the scene's loads and motions");
  extrapolate(*coarse, *fine);
  extrapolate(*coarsest, *coarse);
  reference.exact = std::move(*fine);
  reference.uncertainty = run_error(reference.exact, *coarse);
  reference.method =
      fmt::format("RK4 extrapolated from steps of {:.3g} s and half of it ([[constraint]] needs RK4)", step);
  reference.check =
      fmt::format("the extrapolation from twice these steps agrees to {:.1e}", reference.uncertainty);
}

}  // namespace

double seconds_per_step(rheo::Simulation& simulation) {
  constexpr double enough_seconds = 0.05;
  // Exponential steps are long enough for the clock, and one tells all.
  const std::int64_t chunk = simulation.scene().time.integrator == rheo::IntegratorKind::exponential ? 1 : 8;
  const rheo::TimeSettings& time = simulation.scene().time;
  const double step = std::min({simulation.step_bound(), 1.0 / time.frame_rate, time.duration});
  const std::vector<double> events = event_times(simulation.scene());
  // The first pays for cold memory. Of the rest the least of several counts: others may want the processor
  // too.
  if (simulation.advance(step)) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  std::int64_t steps = 0;
  const Clock::time_point start = Clock::now();
  while (simulation.time() < time.duration && (steps == 0 || since(start) < enough_seconds)) {
    const std::int64_t before = simulation.counters().steps;
    const Clock::time_point chunk_start = Clock::now();
    if (simulation.advance(std::min(simulation.time() + static_cast<double>(chunk) * step, time.duration)))
      break;
    const std::int64_t taken = simulation.counters().steps - before;
    steps += taken;
    if (taken > 0) {
      least = std::min(least, since(chunk_start) / static_cast<double>(taken));
      continue;
    }
    // At rest: only an event wakes it.
    const auto next = std::ranges::upper_bound(events, simulation.time());
    if (next == events.end() || simulation.advance(*next)) break;
  }
  return std::isfinite(least) ? least : 0.0;
}

Reference make_reference(const rheo::Scene& scene, const rheo::SimulationOptions& asked, double budget,
                         Progress& progress) {
  rheo::SimulationOptions options = asked;
  options.energies = false;
  Reference reference;
  reference.exact.times = compared_times(scene.time);
  const bool exponential = has_exponential(scene);
  progress.begin("exact", 1);
  if (scene.mesh.node_count() <= dense_nodes && dense_seconds(scene) <= budget) {
    reference.exact.states = rheo::dense_flow(scene, reference.exact.times);
    reference.method = "the exponential of the dense operator";
    reference.uncertainty = dense_uncertainty;
  } else if (exponential) {
    follow_exponential(reference, scene, options, budget);
  } else {
    extrapolate_rk4(reference, scene, options, budget);
  }
  progress.end();
  return reference;
}

void check_reference(Reference& reference, const rheo::Scene& scene, const rheo::SimulationOptions& asked,
                     double budget, Progress& progress) {
  if (!reference.by_exponential()) return;
  rheo::SimulationOptions options = asked;
  options.energies = false;
  progress.begin("check", 1);
  check_by_rk4(reference, scene, options, budget);
  progress.end();
}

}  // namespace app
