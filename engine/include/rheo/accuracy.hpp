// Integrator, and its step or tolerance, for an error that is asked for.
//
//   error = largest, over the outputs, the duration's end and the blocks u, v, w_lambda, w_mu, of
//           |difference to the exact solution| / largest |block| over the run        (Euclidean over the
//           nodes)
//
// exponential: its tolerance bounds the error by itself; asked for is what keeps the run as near below the
// accuracy as is safe. No trial runs. An integrator of order p: the scene is run at bounds h and h/2, then
// h/2 and h/4, ... of the step, side by side, and compared at the outputs. With the differences D_k of levels
// k and k + 1
//
//   e_{k+1} = D_k / (2^p - 1),  e_k = D_k + e_{k+1},  p confirmed by D_{k-1} / D_k, else one more level
//
// are the levels' errors, and the step follows from e ~ h^p, with a safety factor. The trial runs start at
// the coarsest stable step: no cheaper run could judge it. They cost 3 such runs where the first pair is
// enough, else 9, 21 ...: less than the run itself where the accuracy wants steps that are many times
// shorter.
//
// Where the integrator is free: exponential, unless general constraints stand against it or another one's
// trial runs and run together are forecast to be cheaper.
//
// Source   Richardson, 1911; Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.4
// Units    step [s]; accuracy, tolerance, estimate: relative; evaluations: of the force
// Errors   Error::Kind::input: an accuracy that rounding puts out of reach (what can be had is named),
// values, no
//          stable step, trial runs that diverge or never reach the order
#pragma once

#include <string>

#include "rheo/scene.hpp"

namespace rheo {

struct SimulationOptions;

struct AccuracyPlan {
  double accuracy = 0.0;  // as asked
  IntegratorKind integrator = IntegratorKind::rk4;
  double refinement = 1.0;   // so many times the steps that `step` gives; the steps are below their quotient
  double step = 0.0;         // upper bound; 0: exponential, from event to event and output to output
  double tolerance = 0.0;    // of the exponential integrator, else 0
  double estimate = 0.0;     // of the error
  double evaluations = 0.0;  // forecast for the run, bodies at rest apart
  double trial_evaluations = 0.0;  // spent on the choice
  std::string why;                 // one line, for people
};

// What the scene's `accuracy` comes to; the scene's integrator where it names one.
AccuracyPlan plan_accuracy(const Scene& scene, const SimulationOptions& options);

// The scene with the plan's integrator, step and tolerance in the place of its accuracy.
Scene with_plan(Scene scene, const AccuracyPlan& plan);

}  // namespace rheo
