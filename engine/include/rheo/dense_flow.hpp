// The exact solution of a small scene: the exponential of its full dense operator, from event to event.
//
//   y = (u, v, w_lambda and w_mu of each branch and region),  y' = A y + g(t),  g a polynomial between events
//   y(t + d) = exp(d [A G; 0 N]) (y, 1, s, s^2/2, ...)
//   v'     = P (f - J_lambda p_lambda - J_mu p_mu) + G target          p: simulation.hpp
//   G      = M^-1 C (C^T M^-1 C)^-1,  P = M^-1 - G C^T M^-1
//   target = b'' where a degree of freedom is held exactly
//   target = b'' - 2 omega (C^T v - b') - omega^2 (C^T u - b) elsewhere
//
// Written from the equations, with no kernel and no integrator of the engine: a yardstick for them. Events,
// courses of motions and who holds what are the engine's own.
//
// Source   Hirai and Tomokuni, eq. (2)-(4); exponential: N. Higham, "The scaling and squaring method for the
//          matrix exponential revisited" (2005)
// Units    SI, as in simulation.hpp
// Shapes   a state: 8n numbers, u, v, w_lambda, w_mu one after the other, each n x 2; w: all but the elastic
//          part's, as Simulation's
// Errors   as Simulation's constructor for the scene
// Cost     memory as n^2, time as n^3: 64 nodes take 2 MB and about a second for each distance of times
// Not here large meshes: integrator exponential at its finest tolerance is as exact
#pragma once

#include <span>
#include <vector>

#include "rheo/scene.hpp"

namespace rheo {

// The states at rising times >= 0; at an event's own time, just after it.
std::vector<std::vector<double>> dense_flow(const Scene& scene, std::span<const double> times);

}  // namespace rheo
