#include "stability/runs/stress_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "rheo/error.hpp"
#include "rheo/simulation.hpp"

namespace rheo::test {
namespace {

int loaded_steps(const StressLength& length) {
  return std::max(1, length.steps / 10);
}

// The scene in `length.steps` steps of h, its load let go after a tenth of them.
Scene in_steps(const Scene& scene, IntegratorKind integrator, double h, const StressLength& length) {
  Scene s = scene;
  s.time.integrator = integrator;
  s.time.step = h;
  s.time.duration = length.steps * h;
  s.time.frame_rate = 1.0 / s.time.duration;
  for (Traction& traction : s.tractions) traction.window.until = loaded_steps(length) * h;
  return s;
}

constexpr int first_steps = 5;
constexpr double first_overshoot = 0.2;

struct Course {
  bool diverged = false;
  double worst_energy = 0.0;  // of kinetic + stored, over the work, at the looks before it diverged
  double first_energy = 0.0;  // the same in the first steps
  bool finite = true;
};

// After how many steps it is looked at, rising.
std::set<int> looks_of(const StressLength& length) {
  std::set<int> looks;
  for (int k = 1; k <= std::min(length.one_by_one, length.steps); ++k) looks.insert(k);
  // Where the load is let go, and as many steps behind it.
  const int let_go = loaded_steps(length);
  for (int k = let_go; k <= std::min(let_go + length.one_by_one, length.steps); ++k) looks.insert(k);
  const int first = std::min(length.one_by_one, length.steps);
  for (std::int64_t k = 1; k <= length.later; ++k)
    looks.insert(first + static_cast<int>((length.steps - first) * k / length.later));
  return looks;
}

// What the loads would give a body that nothing resists, by the lightest node: rounding leaves a share of it
// where constraints hold against all of them.
double unresisted_energy(const Scene& scene) {
  double lightest = std::numeric_limits<double>::infinity(), force = 0.0;
  for (int t = 0; t < scene.mesh.triangle_count(); ++t) {
    const std::size_t r =
        scene.region_of_triangle.empty() ? 0 : static_cast<std::size_t>(scene.region_of_triangle[t]);
    const double density = r == 0 ? scene.material.density : scene.regions[r - 1].material.density;
    lightest = std::min(lightest, density * scene.mesh.thickness * signed_area(scene.mesh, t) / 12);
  }
  double until = 0.0;
  for (const Traction& traction : scene.tractions) {
    for (const Edge& e : traction.edges) {
      const Vec2 a = scene.mesh.points[static_cast<std::size_t>(e[0])],
                 b = scene.mesh.points[static_cast<std::size_t>(e[1])];
      force += scene.mesh.thickness * std::hypot(b.x - a.x, b.y - a.y) *
               std::hypot(traction.keys[0].p.x, traction.keys[0].p.y);
    }
    until = std::max(until, std::min(traction.window.until, scene.time.duration));
  }
  return force * force * until * until / (2 * lightest);
}

Course course_of(const Scene& scene, const SimulationOptions& options, const StressLength& length,
                 double rounding) {
  Simulation simulation(scene, options);
  Course course;
  const bool euler = scene.time.integrator == IntegratorKind::euler;
  const bool tied = !scene.constraints.empty() || scene.time.constraints == ConstraintMethod::baumgarte;
  double largest_work = 0.0, work_before = 0.0, way = 0.0, let_go = 0.0;
  int before = 0;
  const double unresisted = unresisted_energy(scene);
  const double unresisted_in_a_step = unresisted * std::pow(loaded_steps(length), -2);
  for (const int steps : looks_of(length)) {
    if (simulation.advance(std::min(steps * scene.time.step, scene.time.duration))) {
      course.diverged = true;
      return course;
    }
    const Energies now = simulation.energies();
    const double energy = now.kinetic + now.stored;
    course.finite = course.finite && std::isfinite(energy);
    const bool loaded = steps <= loaded_steps(length);
    largest_work = std::max(largest_work, now.work);
    // Euler's speed is a step ahead of its way: of the work, what the load does in a step (twice: no two are
    // alike).
    if (euler && loaded) way = std::max(way, 2.0 * std::abs(now.work - work_before) / (steps - before));
    work_before = now.work;
    before = steps;
    if (loaded) let_go = energy;
    // Afterwards Euler's start is the moment at which the load lets go.
    const double explained =
        euler ? (loaded ? largest_work + way : std::min(let_go, largest_work + way)) : now.work;
    const double scale = euler ? explained : largest_work;
    if (euler && steps == 1) continue;  // all of its work is a step late
    // Each step may leave a speed of eps of the loads' own, which nothing brings to rest without Baumgarte.
    const double drift = tied ? std::max(rounding, std::numeric_limits<double>::epsilon() * steps) : rounding;
    if (!(energy > drift * drift * unresisted)) continue;
    // Where constraints cancel loads the work is a difference: to eps of what the loads would do in a step.
    if (tied && energy - explained <= std::numeric_limits<double>::epsilon() * unresisted_in_a_step) continue;
    // A load's jump is the first steps': rates that they do not resolve leave their error in the speeds.
    double& worst = steps <= first_steps ? course.first_energy : course.worst_energy;
    worst = std::max(worst, 1.0 + (energy - explained) / scale);
  }
  return course;
}

// At any step, for what it says of the scene.
Scene for_a_look(const Scene& scene, IntegratorKind integrator) {
  Scene probe = in_steps(scene, integrator, 1.0, {1});
  for (Traction& traction : probe.tractions) traction.window = {};
  return probe;
}

}  // namespace

Redundancy settle(StressScene& stress) {
  Redundancy found;
  if (stress.redundant.empty()) return found;
  found.any = true;
  Scene all = stress.scene;
  all.constraints.insert(all.constraints.end(), stress.redundant.begin(), stress.redundant.end());
  stress.redundant.clear();
  try {
    const Simulation taken(for_a_look(all, IntegratorKind::rk4), {.allow_unstable = true});
    stress.scene = std::move(all);
  } catch (const Error& error) {
    found.refused = true;
    const std::string text = error.what();
    const bool says_why =
        text.find("follows from") != std::string::npos || text.find("follow from") != std::string::npos;
    if (error.kind() != Error::Kind::input || !says_why || text.find('\n') != std::string::npos)
      found.broken.push_back({Promise::named, text});
  }
  return found;
}

StressOutcome stress(const StressScene& stress, const TrueSpectrum& truth, IntegratorKind integrator,
                     const StressLength& length) {
  StressOutcome out;
  const auto broken = [&](Promise promise, std::string text) {
    out.broken.push_back({promise, std::move(text)});
  };
  // Of the speed that nothing resists; where constraints hold nearly all, what is left is their conditioning.
  const double rounding =
      stress.scene.constraints.size() + 1 >= 2 * static_cast<std::size_t>(stress.scene.mesh.node_count())
          ? 1e-9
          : 1e-13;
  out.predicted = Simulation(for_a_look(stress.scene, integrator), {.allow_unstable = true}).stable_step();
  out.truth = truth.limit(integrator);
  if (out.truth.determined() && out.predicted > out.truth.high * (1 + 1e-9))
    broken(Promise::limit,
           fmt::format("predicted {:.6g} s, true limit {:.6g} s", out.predicted, out.truth.high));
  if (out.truth.determined() && out.predicted < 0.95 * out.truth.low)
    broken(Promise::nearness,
           fmt::format("predicted {:.4f} of the true limit", out.predicted / out.truth.low));
  if (std::isfinite(out.predicted) && out.predicted > 0.0) {
    const Course course =
        course_of(in_steps(stress.scene, integrator, 0.99 * out.predicted, length), {}, length, rounding);
    out.worst_energy = course.worst_energy;
    out.first_energy = course.first_energy;
    if (course.diverged) broken(Promise::stable, "diverged at 0.99 of the predicted step");
    if (!course.finite) broken(Promise::stable, "a number that is not finite");
    // Euler's steps feed energy, h^2 / 2 |y'|^2 in its measure, before what is damped takes it back.
    const double overshoot = integrator == IntegratorKind::euler ? 0.03 : 1e-9;
    if (integrator == IntegratorKind::rk4 && course.first_energy > 1 + first_overshoot)
      broken(Promise::stable,
             fmt::format("energy {:.9g} of the work in the first steps", course.first_energy));
    if (course.worst_energy > 1 + overshoot)
      broken(Promise::stable,
             fmt::format("energy {:.9g} of the work at 0.99 of the predicted step", course.worst_energy));
  }
  if (!out.truth.determined() || !std::isfinite(out.truth.high) || !(out.truth.high > 0.0)) return out;
  const Scene beyond = in_steps(stress.scene, integrator, 1.05 * out.truth.high, length);
  try {
    const Simulation accepted(beyond);
    out.refused_beyond = false;
    broken(Promise::refused, "1.05 of the true limit is accepted");
  } catch (const Error&) {
  }
  const Course wild = course_of(beyond, {.allow_unstable = true}, length, rounding);
  out.grew = wild.diverged;
  if (!wild.finite) broken(Promise::noticed, "beyond the limit: a number that is not finite");
  if (wild.worst_energy > 1.04)
    broken(Promise::noticed,
           fmt::format("beyond the limit: a look shows {:.4g} of the work", wild.worst_energy));
  return out;
}

}  // namespace rheo::test
