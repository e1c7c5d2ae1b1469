// How long the steps of a run may be, and how exact those that have no stable limit.
//
//   rk4, euler              the scene's step, else a share of the stable limit
//   exponential, implicit   from event to event and output to output, or the scene's step where that is less
//   tolerance of a step = tolerance of the run / steps: their errors add up at worst
//
// Units    steps [s]
// Errors   Error::Kind::input, with the place in the scene file where there is one: no stable step, a step
//          beyond the limit that is not allowed, more steps than can be counted
#pragma once

#include <cstddef>
#include <string_view>

#include "rheo/integrator.hpp"
#include "rheo/simulation.hpp"

namespace rheo {

struct StepLimits {
  double stable = 0.0;  // the largest stable step
  double bound = 0.0;   // the largest that is taken, before refinement
};

// name: the integrator's.
StepLimits choose_step(const Scene& scene, const Spectrum& spectrum, std::string_view name,
                       const SimulationOptions& options);

// No stable limit: steps go from event to event and output to output, too long for a quadrature.
bool takes_long_steps(IntegratorKind integrator);

// What each of the integrators has to know. intervals: between events.
IntegratorSettings integrator_settings(const Scene& scene, const Spectrum& spectrum, std::size_t intervals);

}  // namespace rheo
