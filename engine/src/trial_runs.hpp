// Trial runs of a scene with an integrator of known order: which step keeps the error at the outputs below a
// wish.
//
// Formulas: rheo/accuracy.hpp.
// Errors   Error::Kind::input: the trial runs diverge, or differ in no order that could be carried on
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "rheo/simulation.hpp"

namespace rheo {

struct StepChoice {
  double step = 0.0;               // coarsest upper bound [s]
  double refinement = 1.0;         // of its steps
  double estimate = 0.0;           // of the error with both
  double trial_evaluations = 0.0;  // spent
};

// The scene's time between neighbouring outputs and events, each length once.
struct Stretch {
  double length = 0.0;  // [s]
  std::int64_t count = 0;
};
std::vector<Stretch> stretches_of(const Scene& scene);

// Equal steps that they take.
double steps_at(const std::vector<Stretch>& stretches, double step, double refinement = 1.0);

constexpr double reference_share = 0.05;

// What trial runs are compared with.
enum class Yardstick {
  exponential,  // a run of the exponential integrator, to reference_share of the accuracy
  halved_steps  // a run with steps half as long
};

// `scene` names its integrator, one that has an order, and asks for no accuracy itself; coarsest: the longest
// step to consider [s]; most_evaluations: given up where the trial runs have taken more.
StepChoice choose_step_for(const Scene& scene, const SimulationOptions& options, double coarsest,
                           double accuracy, Yardstick yardstick, double most_evaluations);

}  // namespace rheo
