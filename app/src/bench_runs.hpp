// What `rheo bench` runs: integrators over their steps or tolerances, timed, their errors measured.
//
// Seconds are those inside of Simulation::advance: without building, without files, without energies. Runs
// that would not fit the budget are left out, with what they would take, from the seconds of real steps.
//
// Errors   none for a candidate that cannot run, diverges or takes too long: a LeftOut says so
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench_reference.hpp"
#include "bench_setting.hpp"
#include "progress.hpp"
#include "rheo/simulation.hpp"

namespace app {

struct Row {
  Setting setting;
  std::string kernel;
  int threads = 1;
  double largest_step = 0.0;  // [s]
  std::int64_t force_evaluations = 0;
  std::vector<double> seconds;  // one a run
  double error = 0.0;

  double median() const;
  double spread() const;  // (slowest - fastest) / median; 0 of one run
};

struct LeftOut {
  std::string what;
  std::string why;
};

// The finest error that anyone is advised for.
constexpr double finest_wanted = 1e-9;

struct Rows {
  std::vector<Row> rows;
  std::vector<std::string> forecasts;  // what was extrapolated instead of measured, and from what
  std::vector<LeftOut> left_out;
};

// `only`: this integrator alone. `budget`: seconds left for all of it.
Rows bench_runs(const rheo::Scene& scene, const rheo::SimulationOptions& options, const Reference& reference,
                std::optional<rheo::IntegratorKind> only, double budget, Progress& progress);

}  // namespace app
