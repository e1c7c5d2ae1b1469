// The states of a run at chosen times, and how far another run is from them.
//
//   error = max over times and over the blocks u, v, w_lambda, w_mu of
//           |difference| / (largest |block| over the times), Euclidean over the nodes
//
// Shapes   a state: 8n numbers, u, v, w_lambda, w_mu one after the other, each n x 2
// Errors   none: a run that diverges leaves fewer states than times
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "rheo/simulation.hpp"

namespace app {

struct Trajectory {
  std::vector<double> times;
  std::vector<std::vector<double>> states;
};

// A simulation's state now.
void copy_state(const rheo::Simulation& simulation, std::vector<double>& state);

// The output times; where none but 0 lies within the duration, the duration too.
std::vector<double> compared_times(const rheo::TimeSettings& time);

// Runs to all times and keeps the states there.
std::optional<rheo::Divergence> follow(rheo::Simulation& simulation, Trajectory& trajectory);

// Collects the difference of a run from a reference, state by state.
class ErrorMeter {
 public:
  explicit ErrorMeter(const Trajectory& reference);

  // The state of the run at the k-th of the reference's times.
  void include(std::size_t k, const std::vector<double>& state);
  double error() const;
  // Every block of the reference is zero at all times.
  bool nothing_moves() const;

 private:
  const Trajectory& reference_;
  std::array<double, 4> largest_{}, difference_{};
};

double run_error(const Trajectory& reference, const Trajectory& run);

}  // namespace app
