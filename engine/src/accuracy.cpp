#include "rheo/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "exponential.hpp"
#include "rheo/error.hpp"
#include "schedule.hpp"
#include "trial_runs.hpp"

namespace rheo {
namespace {

// The exponential integrator's error over its tolerance, at most: 0.42 with lumped mass where vibrations are
// the fastest, on the scenes of the tests and seven hundred random ones; 0.75 with consistent mass, and where
// relaxation or a viscous part is faster, on four hundred. Seldom below 0.01, since steps' errors are
// estimated part by part and added up.
double error_of_tolerance(Mass mass, const Spectrum& spectrum) {
  return mass == Mass::lumped && spectrum.largest_rate() < spectrum.omega_max ? 0.5 : 1.0;
}
constexpr double largest_share = 0.95;  // of the stable step: the coarsest trial run
// An integrator with trial runs is worth them if its coarsest run costs so many times less.
constexpr double worth_trials = 8.0;
// Where constraints leave RK4 and implicit alone, implicit has to be so many times cheaper by its forecast:
// its trial runs all damp vibrations that their steps do not resolve, and agree on what may lack a part that
// goes on in truth. RK4's resolve everything.
constexpr double worth_damping = 30.0;
// Trial runs that have no yardstick but each other: of some hundred random scenes a few came out with up to
// three times the error that their halved steps had shown.
constexpr double caution = 3.0;
// A run of the exponential integrator may cost so many of the coarsest trial run to be their yardstick: what
// a run with half of its steps costs.
constexpr double yardstick_worth = 4.0;

// Rounding's part of the error, in machine epsilons: of any run; for each radian of the fastest vibration and
// each relaxation time while the body remembers; for each step of the edge kernel, whose small increments
// round alike; of the square root of the steps with assembled matrices, where they do not. Twice and more
// what was seen on the tests' scenes and on beams of up to 10k triangles over up to 10^7 steps.
constexpr double rounding = std::numeric_limits<double>::epsilon();
constexpr double rounding_of_run = 400.0;
constexpr double rounding_of_radian = 0.25;
constexpr double rounding_of_relaxation = 0.1;
constexpr double rounding_of_edge_step = 0.045;
constexpr double rounding_of_root_step = 2.0;
constexpr double memory = 4.0;  // relaxation times of the slower branch

// Integrators with an order among which the engine chooses, and what an evaluation of theirs costs in
// evaluations of the force.
struct Candidate {
  IntegratorKind kind;
  double cost;
};
// A sparse solve takes the time of some twenty sweeps of the edge kernel.
constexpr std::array candidates{Candidate{IntegratorKind::rk4, 1.0},
                                Candidate{IntegratorKind::implicit, 20.0}};

[[noreturn]] void refuse(const Scene& scene, const std::string& text) {
  const std::string& where = scene.time.where;
  throw Error(Error::Kind::input, where.empty() ? text : where + " " + text);
}

class Planner {
 public:
  Planner(const Scene& scene, const SimulationOptions& options)
      : scene_(scene), options_(options), stretches_(stretches_of(scene)), columns_(has_columns(scene)) {
    scene_.time.accuracy = 0.0;
    accuracy_ = scene.time.accuracy;
    Scene probe = scene_;
    if (probe.time.integrator == IntegratorKind::automatic) probe.time.integrator = IntegratorKind::rk4;
    SimulationOptions quiet = options;
    quiet.planning = {};
    const Simulation simulation(std::move(probe), quiet);
    spectrum_ = simulation.spectrum();
    edge_kernel_ = simulation.kernel() == "edge";
  }

  AccuracyPlan plan() {
    const IntegratorKind asked = scene_.time.integrator;
    if (asked == IntegratorKind::exponential) return exponential("as asked");
    if (asked != IntegratorKind::automatic) return with_order(asked, "as asked");
    const Candidate* cheapest = &candidates.front();
    for (const Candidate& each : candidates) {
      if (least_cost(each) < least_cost(*cheapest)) cheapest = &each;
    }
    if (columns_) {
      const Candidate& rk4 = candidates.front();
      if (least_cost(rk4) < worth_damping * least_cost(*cheapest)) cheapest = &rk4;
      return with_order(cheapest->kind, "general constraints stand against the exponential integrator");
    }
    AccuracyPlan plan = exponential("the cheapest by its forecast, and needs no trial runs");
    if (plan.evaluations < worth_trials * least_cost(*cheapest)) return plan;
    try {
      AccuracyPlan other =
          with_order(cheapest->kind, "cheaper than the exponential integrator by its forecast",
                     plan.evaluations / cheapest->cost);
      if (other.evaluations * cheapest->cost < plan.evaluations) return other;
      plan.trial_evaluations = other.trial_evaluations;
    } catch (const Error&) {
      // It does not come to the accuracy, or not for less.
    }
    return plan;
  }

 private:
  double coarsest(IntegratorKind kind) const {
    const TimeSettings& time = scene_.time;
    return std::min({largest_share * stable_step(spectrum_, kind), 1.0 / time.frame_rate, time.duration});
  }

  double least_evaluations(IntegratorKind kind) const {
    return make_integrator(kind, 1)->evaluations_per_step() * steps_at(stretches_, coarsest(kind));
  }
  double least_cost(const Candidate& candidate) const {
    return candidate.cost * least_evaluations(candidate.kind);
  }

  double largest_rate() const { return spectrum_.largest_rate(); }

  // The error that rounding alone comes to, in a run of so many steps with an order; 0: with the exponential
  // integrator, whose few steps do not count.
  double floor_of(double steps) const {
    const Spectrum& s = spectrum_;
    const double time = std::min(scene_.time.duration, memory / s.slowest_rate());
    const double by_steps =
        edge_kernel_ ? rounding_of_edge_step * steps : rounding_of_root_step * std::sqrt(steps);
    return rounding * (rounding_of_run + rounding_of_radian * s.omega_max * time +
                       rounding_of_relaxation * largest_rate() * time + by_steps);
  }

  [[noreturn]] void refuse_below(double reachable, std::string_view integrator, const char* instead) const {
    refuse(scene_, fmt::format("accuracy = {:g}: rounding keeps {} from it here; {:.1e} is what can be had{}",
                               accuracy_, integrator, 1.05 * reachable, instead));
  }

  // Of a run with the exponential integrator.
  double exponential_evaluations(double tolerance) const {
    Exponential integrator(1,
                           {spectrum_.omega_max, largest_rate(), tolerance / steps_at(stretches_, forever)});
    double evaluations = 0.0;
    for (const Stretch& stretch : stretches_)
      evaluations += static_cast<double>(stretch.count) * integrator.forecast(stretch.length);
    return evaluations;
  }

  AccuracyPlan exponential(std::string why) const {
    AccuracyPlan plan;
    plan.accuracy = accuracy_;
    plan.integrator = IntegratorKind::exponential;
    const double floor = floor_of(0.0);
    if (floor > accuracy_) refuse_below(floor, "any integrator", "");
    plan.tolerance = std::clamp((accuracy_ - floor) / error_of_tolerance(scene_.material.mass, spectrum_),
                                finest_tolerance, coarsest_tolerance);
    plan.estimate =
        std::min(error_of_tolerance(scene_.material.mass, spectrum_) * plan.tolerance + floor, accuracy_);
    plan.evaluations = exponential_evaluations(plan.tolerance);
    plan.why = std::move(why);
    return plan;
  }

  AccuracyPlan with_order(IntegratorKind kind, std::string why,
                          double most_trial_evaluations = forever) const {
    Scene scene = scene_;
    scene.time.integrator = kind;
    const auto method = make_integrator(kind, 1);
    const char* instead = columns_ ? "" : " with it, less with \"exponential\"";
    const double fewest = steps_at(stretches_, coarsest(kind));
    // Out of reach or not, the trial runs show what is not.
    const double least = 4.0 * floor_of(fewest);
    const double tolerance = std::max(reference_share * std::max(accuracy_, least), finest_tolerance);
    const bool short_of =
        columns_ || exponential_evaluations(tolerance) > yardstick_worth * least_evaluations(kind);
    const double doubt = short_of ? caution : 1.0;
    const double aim = std::max(accuracy_ / doubt, least);
    const StepChoice choice =
        choose_step_for(scene, options_, coarsest(kind), aim,
                        short_of ? Yardstick::halved_steps : Yardstick::exponential, most_trial_evaluations);
    const double steps = steps_at(stretches_, choice.step, choice.refinement);
    const auto error_at = [&](double more) {
      return doubt * choice.estimate * std::pow(more, -method->order()) + floor_of(steps * more);
    };
    // Rounding on top may want some more steps, or leave none that are enough.
    double more = 1.0, best = error_at(1.0);
    for (; error_at(more) > accuracy_ && more < 1e3; more *= 1.05) best = std::min(best, error_at(more));
    if (error_at(more) > accuracy_) refuse_below(best, method->name(), instead);
    AccuracyPlan plan;
    plan.accuracy = accuracy_;
    plan.integrator = kind;
    plan.step = choice.step;
    plan.refinement = choice.refinement * more;
    plan.estimate = error_at(more);
    plan.evaluations = method->evaluations_per_step() * steps_at(stretches_, plan.step, plan.refinement);
    plan.trial_evaluations = choice.trial_evaluations;
    plan.why = std::move(why);
    return plan;
  }

  Scene scene_;  // without an accuracy
  double accuracy_ = 0.0;
  const SimulationOptions& options_;
  std::vector<Stretch> stretches_;
  bool columns_;
  bool edge_kernel_ = false;
  Spectrum spectrum_;
};

}  // namespace

AccuracyPlan plan_accuracy(const Scene& scene, const SimulationOptions& options) {
  validate(scene);
  return Planner(scene, options).plan();
}

Scene with_plan(Scene scene, const AccuracyPlan& plan) {
  scene.time.integrator = plan.integrator;
  scene.time.accuracy = 0.0;
  scene.time.step = plan.step;
  scene.time.refinement = plan.refinement;
  if (plan.integrator == IntegratorKind::exponential) scene.time.tolerance = plan.tolerance;
  return scene;
}

}  // namespace rheo
