// Integrator, and its step or tolerance, for an error that is asked for.
//
//   error = largest, over the outputs, the duration's end and the blocks u, v, w_lambda, w_mu, of
//           |difference to the exact solution| / largest |block| over the run        (Euclidean over the
//           nodes)
//
// exponential: its tolerance bounds the error by itself; chosen is what keeps the run as near below the
// accuracy as is safe. No trial runs.
//
// An integrator of order p: trial runs of the whole scene at levels k = 0, 1, ... with 2^k times the steps of
// the coarsest stable step. Their errors e_k are measured against the exponential integrator where it is
// available and costs no more than they do; else from the differences D_k of levels k and k + 1, both run
// side by side,
//
//   e_{k+1} = D_k / (2^p - 1),  e_k = D_k + e_{k+1}                                  (Richardson)
//
// until e_k is small enough or the order shows: e_{k-1} / e_k, or D_{k-1} / D_k, of 2^(0.85 p) at least. The
// steps then follow from e ~ h^p, with a factor of 1.5 for safety: so many times (refinement) those of the
// coarsest, in every interval between events and outputs alike, so that no interval's share in the error is
// guessed. Where less than the order shows, half of p at most is counted on, if the finer steps that this
// wants cost less than another trial run might save. Trial runs cost 1 + 2 + 4 + ... of the coarsest run, and
// the exponential one: no cheaper run could judge the coarsest. That is less than the run where the accuracy
// wants many times its steps, and up to some 3.5 times the run where a few times the coarsest will do.
//
// Rounding is added to the estimate as it was measured, and refuses what it puts out of reach.
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
