// The exact solution that `rheo bench` measures errors against, and how sure it is.
//
//   small scenes     the exponential of the dense operator (rheo/dense_flow.hpp)
//   others           integrator exponential at its finest tolerance, checked against RK4
//   [[constraint]]   (which exponential refuses) RK4, extrapolated
//
// RK4 is extrapolated after Richardson: y = (16 y_{h/2} - y_h) / 15, an error of order 5.
//
// Errors   Failure(usage): no way to it within the budget; rheo::Error as Simulation
#pragma once

#include <optional>
#include <string>

#include "progress.hpp"
#include "rheo/simulation.hpp"
#include "trajectory.hpp"

namespace app {

struct Reference {
  Trajectory exact;
  std::string method;
  std::string check;                 // how far an independent way is from it; empty where none was taken
  double uncertainty = 0.0;          // errors below it say nothing; where it was checked, what was measured
  double claimed = 0.0;              // the tolerance of its own that it kept to; 0 where it has none
  double exponential_seconds = 0.0;  // that its run took; 0 where it came another way

  bool by_exponential() const { return exponential_seconds > 0.0; }
};

// `budget`: seconds that this may take.
Reference make_reference(const rheo::Scene& scene, const rheo::SimulationOptions& options, double budget,
                         Progress& progress);

// Where that came by exponential: how far RK4, extrapolated, is from it at a few outputs. In two runs of at
// most `budget` seconds each.
void check_reference(Reference& reference, const rheo::Scene& scene, const rheo::SimulationOptions& options,
                     double budget, Progress& progress);

// Seconds a step of a simulation takes, from some real ones at its beginning; 0 where it ends before.
// The simulation is of no use afterwards.
double seconds_per_step(rheo::Simulation& simulation);

}  // namespace app
