#include "check.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "check_plots.hpp"
#include "failure.hpp"
#include "frame_outputs.hpp"
#include "material_rows.hpp"
#include "memory_need.hpp"
#include "option_values.hpp"
#include "overrides.hpp"
#include "printable.hpp"
#include "progress.hpp"
#include "rheo/deformation.hpp"
#include "rheo/error.hpp"
#include "rheo/simulation.hpp"
#include "run_notes.hpp"
#include "scene_parts.hpp"

namespace app {
namespace {

// At most so many lines of fixes, moves or tractions; the rest is counted.
constexpr std::size_t most_items = 12;

template <typename... Values>
void row(const char* name, fmt::format_string<Values...> format, Values&&... values) {
  fmt::print("  {:<14} {}\n", name, printable(fmt::format(format, std::forward<Values>(values)...)));
}

std::string window_text(const rheo::Window& window) {
  if (std::isinf(window.until)) return fmt::format("from {:g} s on", window.from);
  return fmt::format("from {:g} s until {:g} s", window.from, window.until);
}

const char* axis_text(rheo::Axis axis) {
  return axis == rheo::Axis::both ? "x and y" : axis == rheo::Axis::x ? "x" : "y";
}

const char* plural(std::size_t count) {
  return count == 1 ? "" : "s";
}

template <typename Items, typename Text>
void list(const char* name, const Items& items, Text text) {
  std::size_t shown = 0;
  for (const auto& item : items) {
    if (shown == most_items) {
      row(name, "and {} more", items.size() - shown);
      return;
    }
    row(name, "{}", text(item));
    ++shown;
  }
}

double area_of(const rheo::Mesh& mesh) {
  double area = 0.0;
  for (int k = 0; k < mesh.triangle_count(); ++k) area += rheo::signed_area(mesh, k);
  return area;
}

void print_bodies(const rheo::Scene& scene, const std::vector<MaterialPart>& materials) {
  list("body", scene.bodies, [&](const rheo::BodyPart& body) {
    std::string names;
    for (const int number : materials_in(scene, body))
      names += (names.empty() ? "" : ", ") + materials[static_cast<std::size_t>(number)].name;
    return fmt::format("{}: {} nodes, {} triangles{}", body.name, body.node_count, body.triangle_count,
                       materials.size() > 1 ? "; material " + names : "");
  });
}

std::string thickness_text(const rheo::Mesh& mesh) {
  if (mesh.thickness_of_node.empty()) return fmt::format("{:g} m", mesh.thickness);
  const auto [least, most] = std::ranges::minmax(mesh.thickness_of_node);
  return fmt::format("{:g} to {:g} m", least, most);
}

void print_mesh(const rheo::Scene& scene) {
  const rheo::Mesh& mesh = scene.mesh;
  row("mesh", "{} nodes, {} triangles, {} boundary edges", mesh.node_count(), mesh.triangle_count(),
      mesh.edge_groups.at("boundary").size());
  std::string groups;
  for (const auto& [name, edges] : mesh.edge_groups)
    groups += fmt::format("{}{} ({})", groups.empty() ? "" : ", ", name, edges.size());
  row("edge groups", "{}", groups);
  const double area = area_of(mesh);
  row("area", "{:.6g} m^2, thickness {}", area, thickness_text(mesh));
  const std::vector<MaterialPart> materials = materials_of(scene);
  print_bodies(scene, materials);
  double mass = 0.0;
  for (const MaterialPart& part : materials) {
    if (materials.size() > 1)
      row("material", "{}: {} triangle{}, density {:g} kg/m^3", part.name, part.triangles,
          plural(static_cast<std::size_t>(part.triangles)), part.material->density);
    for (const auto& [name, text] : material_rows(*part.material, *part.origin))
      row(name.c_str(), "{}", text);
    mass += part.volume * part.material->density;
  }
  row("mass", "{:.6g} kg ({}){}", mass, scene.material.mass == rheo::Mass::lumped ? "lumped" : "consistent",
      materials.size() > 1 ? "" : fmt::format(", density {:g} kg/m^3", scene.material.density));
}

void print_loads(const rheo::Scene& scene) {
  list("fix", scene.fixes, [](const rheo::Fix& fix) {
    return fmt::format("{} node{}, {}, {}", fix.nodes.size(), plural(fix.nodes.size()), axis_text(fix.axis),
                       window_text(fix.window));
  });
  list("move", scene.moves, [](const rheo::Move& move) {
    return fmt::format("{} node{}, {}, {} key{}, {}", move.nodes.size(), plural(move.nodes.size()),
                       axis_text(move.axis), move.keys.size(), plural(move.keys.size()),
                       window_text(move.window));
  });
  list("constraint", scene.constraints, [](const rheo::Constraint& constraint) {
    return fmt::format("{} term{} = {:g}", constraint.terms.size(), plural(constraint.terms.size()),
                       constraint.value);
  });
  list("traction", scene.tractions, [](const rheo::Traction& traction) {
    const std::string value = traction.keys.size() == 1
                                  ? fmt::format("({:g}, {:g}) Pa", traction.keys[0].p.x, traction.keys[0].p.y)
                                  : fmt::format("{} keys", traction.keys.size());
    return fmt::format("{} edge{}, {}, {}", traction.edges.size(), plural(traction.edges.size()), value,
                       window_text(traction.window));
  });
  if (scene.body_acceleration != rheo::Vec2{})
    row("body force", "acceleration ({:g}, {:g}) m/s^2", scene.body_acceleration.x,
        scene.body_acceleration.y);
  list("probe", scene.probes, [](const rheo::Probe& probe) {
    return fmt::format("{}: {} node{}", probe.name, probe.nodes.size(), plural(probe.nodes.size()));
  });
}

std::string stable_text(double step) {
  if (step <= 0.0) return "none: undamped";
  if (std::isinf(step)) return "any: nothing oscillates or relaxes";
  return fmt::format("{:.6g} s", step);
}

// What a run would say to the step and the integrator.
enum class Verdict {
  accepted,
  too_long,  // beyond the stable limit, and not allowed
  no_step    // automatic, and no step is stable
};

struct Limit {
  double step = 0.0;
  bool bound = false;
};

struct Limits {
  Limit rk4, euler;
};

// As a run with that integrator would find it, by eigenvalues or the numerical range: up to where that takes
// some seconds; up to half a minute where the scene asks for it.
Limit limit_of(const rheo::Scene& scene, const rheo::Simulation& simulation, rheo::IntegratorKind integrator,
               Progress& progress) {
  constexpr int small = 12000, middle = 30000;  // nodes
  const auto of = [&](const rheo::Spectrum& spectrum) {
    return Limit{rheo::stable_step(spectrum, integrator), rheo::stable_step_is_bound(spectrum, integrator)};
  };
  const Limit known = of(simulation.spectrum());
  const rheo::TimeSettings& told = simulation.scene().time;
  const bool was_looked_for = told.integrator == integrator && told.step == 0.0;
  if (!known.bound || was_looked_for || scene.mesh.node_count() > middle) return known;
  rheo::Scene probe = scene;
  probe.time.integrator = integrator;
  probe.time.step = std::max(scene.time.duration, 2.0 * known.step);  // beyond what is sure
  rheo::SimulationOptions any_step;
  any_step.allow_unstable = true;
  if (scene.mesh.node_count() > small && scene.time.integrator != integrator)
    any_step.nearness = rheo::Nearness::range;
  any_step.searching = stable_step_on(progress);
  return of(rheo::Simulation(std::move(probe), any_step).spectrum());
}

std::string limit_text(const Limit& limit) {
  return stable_text(limit.step) + (limit.bound ? " at least (a safe bound)" : "");
}

void print_steps(const rheo::Simulation& simulation, rheo::IntegratorKind integrator, const Limits& limits,
                 Verdict verdict, const std::optional<rheo::AccuracyPlan>& plan) {
  const rheo::Spectrum& spectrum = simulation.spectrum();
  const rheo::TimeSettings& time = simulation.scene().time;
  row("omega_max", "{:.6g} rad/s ({} Lanczos steps); by single elements {:.6g} rad/s", spectrum.omega_max,
      spectrum.lanczos_steps, spectrum.element_bound);
  row("stable rk4", "{}", limit_text(limits.rk4));
  if (const std::string advice = stiffness_advice(simulation.scene(), spectrum); !advice.empty())
    row("advice", "{}", advice);
  if (limits.euler.bound && limits.euler.step <= 0.0)
    row("stable euler",
        "none that can be promised: a material that does not relax, in a body too large to tell");
  else
    row("stable euler", "{}", limit_text(limits.euler));
  if (plan) row("accuracy", "{}", plan_text(*plan));
  row("integrator", "{}", name_of(integrator));
  row("kernel", "{}", simulation.kernel());
  if (integrator == rheo::IntegratorKind::exponential) row("tolerance", "{:g}", time.tolerance);
  if (simulation.factor_bytes() > 0)
    row("factor", "{:.3g} MB for each step size in use",
        static_cast<double>(simulation.factor_bytes()) / 1e6);
  if (verdict == Verdict::no_step) {
    row("step", "none: no step of euler is stable here, some vibrations are not damped");
  } else if (std::isinf(simulation.step_bound())) {
    row("step", "auto: one an interval between events and outputs");
    row("steps", "{} in {:g} s", simulation.planned_steps(), time.duration);
  } else {
    row("step", "{:.6g} s at most ({}{})", simulation.step_bound(),
        plan              ? "for the accuracy"
        : time.step > 0.0 ? "as asked"
                          : "auto: a quarter of the stable step",
        verdict == Verdict::too_long ? ", beyond the stable step" : "");
    row("steps", "{} in {:g} s", simulation.planned_steps(), time.duration);
  }
  row("outputs", "{} at {:g} per second", rheo::output_count(time), time.frame_rate);
  const int every = simulation.scene().picture.every;
  row("frames", "{} with render, {}", frame_count(rheo::output_count(time), every),
      every == 1 ? std::string("one an output") : fmt::format("one every {} outputs and the last", every));
}

struct Cost {
  std::int64_t steps = 0;
  double seconds_per_step = 0.0;
  double seconds_per_output = 0.0;
  std::optional<rheo::Divergence> divergence;  // what was timed is no run then
  double rest_until = 0.0;                     // [s]; so long nothing moves and no step is taken
};

// Some real steps from the start, until there are enough of them and of seconds to be worth a quotient.
Cost measure(rheo::Simulation& simulation) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  constexpr double enough_seconds = 0.1;
  constexpr std::int64_t chunk = 16, few = 48;
  const double duration = simulation.scene().time.duration;
  Cost cost;
  const auto note_rest = [&] {
    const rheo::Counters& counters = simulation.counters();
    if (counters.steps == 0 && counters.steps_at_rest > 0) cost.rest_until = simulation.time();
  };
  // As in a run, from output to output at most.
  const bool takes_long_steps = std::isinf(simulation.stable_step());
  const double step = takes_long_steps
                          ? std::min(simulation.step_bound(), 1.0 / simulation.scene().time.frame_rate)
                          : simulation.step_bound();
  // The first step pays for cold memory; it is not counted.
  cost.divergence = simulation.advance(std::min(step, duration));
  if (cost.divergence) return cost;
  const std::int64_t before = simulation.counters().steps;
  note_rest();
  const Clock::time_point start = Clock::now();
  double last = 0.0;  // seconds until the latest steps were done
  while (simulation.time() < duration) {
    const double t = simulation.time() + (takes_long_steps ? step : static_cast<double>(chunk) * step);
    const std::int64_t taken = simulation.counters().steps + simulation.counters().steps_at_rest;
    cost.divergence = simulation.advance(std::min(t, duration));
    if (cost.divergence) return cost;
    // At the end but for rounding: nothing is left to do.
    if (simulation.counters().steps + simulation.counters().steps_at_rest == taken) break;
    cost.steps = simulation.counters().steps - before;
    note_rest();
    const double passed = last = since(start);
    if ((cost.steps >= few && passed > enough_seconds) || passed > 10.0 * enough_seconds) break;
  }
  if (cost.steps > 0) cost.seconds_per_step = last / static_cast<double>(cost.steps);
  const Clock::time_point output_start = Clock::now();
  rheo::check_linearity(simulation.scene().mesh, simulation.u());
  simulation.energies();
  for (const rheo::Probe& probe : simulation.scene().probes) simulation.read(probe);
  cost.seconds_per_output = since(output_start);
  return cost;
}

void print_cost(rheo::Simulation& simulation, Verdict verdict) {
  const rheo::Scene& scene = simulation.scene();
  const Cost cost = verdict == Verdict::accepted ? measure(simulation) : Cost{};
  const double outputs = static_cast<double>(rheo::output_count(scene.time));
  const double seconds = cost.seconds_per_step * static_cast<double>(simulation.planned_steps()) +
                         cost.seconds_per_output * outputs;
  if (verdict != Verdict::accepted)
    row("cost", "no forecast: the run would be refused");
  else if (cost.divergence)
    row("cost", "no forecast: the run diverges, noticed at t = {:.4g} s", cost.divergence->t);
  else if (cost.rest_until >= scene.time.duration)
    row("cost", "next to none: nothing moves and nothing acts, all {} steps are skipped",
        simulation.planned_steps());
  else if (cost.steps == 0 && cost.rest_until > 0.0)
    row("cost", "no forecast: nothing moves until t = {:.4g} s at least, steps are skipped so long",
        cost.rest_until);
  else if (cost.steps == 0)
    row("cost", "no forecast: the run takes fewer than two steps");
  else
    row("cost", "forecast {:.3g} s for run, from {} timed steps of {:.3g} s each", seconds, cost.steps,
        cost.seconds_per_step);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const std::int64_t shapes = most_kept(rheo::output_count(scene.time), scene.picture.every);
  const double per_node = scene.picture.color == rheo::ColorBy::none ? 8.0 : 12.0;
  row("memory", "{:.0f} MB; render keeps up to {:.3g} MB more between its passes",
      static_cast<double>(usage.ru_maxrss) / 1024.0,
      static_cast<double>(shapes) * per_node * scene.mesh.node_count() / 1e6);
}

// With any step that is given; with Euler where it has one; else as RK4.
rheo::Simulation built_for(const rheo::Scene& scene, const rheo::SimulationOptions& options) {
  if (scene.time.step > 0.0) return rheo::Simulation(scene, options);
  if (scene.time.integrator == rheo::IntegratorKind::euler) {
    try {
      return rheo::Simulation(scene, options);
    } catch (const rheo::Error&) {
      // Said below.
    }
  }
  rheo::Scene shown = scene;
  shown.time.integrator = rheo::IntegratorKind::rk4;
  return rheo::Simulation(std::move(shown), options);
}

void check_loaded(const Options& options, rheo::Scene scene) {
  std::optional<OutputFolder> folder;  // refused before all the work
  if (options.plot) folder.emplace(options.folder, options.force ? Replace::earlier_run : Replace::nothing);
  std::optional<rheo::AccuracyPlan> plan;
  Progress progress(options.quiet ? Verbosity::quiet : Verbosity::normal);
  if (scene.time.accuracy > 0.0) {
    rheo::SimulationOptions told = options.simulation;
    told.planning = trial_runs_on(progress);
    plan = rheo::plan_accuracy(scene, told);
    scene = rheo::with_plan(std::move(scene), *plan);
  }
  const rheo::TimeSettings& time = scene.time;
  // The report comes before a refusal: built with any step.
  rheo::SimulationOptions any_step = options.simulation;
  any_step.allow_unstable = true;
  any_step.searching = stable_step_on(progress);
  std::optional<rheo::Simulation> simulation = built_for(scene, any_step);
  const Limits limits{limit_of(scene, *simulation, rheo::IntegratorKind::rk4, progress),
                      limit_of(scene, *simulation, rheo::IntegratorKind::euler, progress)};
  const double limit = time.integrator == rheo::IntegratorKind::euler ? limits.euler.step
                       : time.integrator == rheo::IntegratorKind::rk4 ? limits.rk4.step
                                                                      : simulation->stable_step();
  Verdict verdict = Verdict::accepted;
  if (time.step == 0.0 && limit == 0.0) verdict = Verdict::no_step;
  // Rounding as the engine allows it.
  if (time.step > limit * (1.0 + 1e-12) && !options.simulation.allow_unstable) verdict = Verdict::too_long;
  if (verdict == Verdict::accepted && simulation->scene().time.integrator != time.integrator)
    simulation.emplace(scene, any_step);
  progress.end();
  fmt::print("{}: {}\n", printable(options.scene.string()), printable(scene.title));
  for (const std::string& note : run_notes(scene)) fmt::print("  note: {}\n", printable(note));
  print_mesh(scene);
  print_loads(scene);
  print_steps(*simulation, time.integrator, limits, verdict, plan);
  print_cost(*simulation, verdict);
  if (folder) {
    for (const std::string& note : write_plots(scene, options, *folder))
      fmt::print("  note: {}\n", printable(note));
    for (const std::string& name : folder->all_made()) row("wrote", "{}", (folder->path() / name).string());
  }
  // A run's own words for the refusal.
  simulation.reset();
  if (verdict != Verdict::accepted) simulation.emplace(scene, options.simulation);
}

}  // namespace

void check_scene(const Options& options) {
  rheo::Scene scene = load_scene(options);
  require_memory(scene, options);
  telling_need(scene, options, [&] { check_loaded(options, std::move(scene)); });
}

}  // namespace app
