#include "trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace app {
namespace {

// Larger than any, and sticky: a difference that is no number must show.
double worse(double a, double b) {
  return std::isnan(b) ? std::numeric_limits<double>::infinity() : std::max(a, b);
}

}  // namespace

void copy_state(const rheo::Simulation& simulation, std::vector<double>& state) {
  state.clear();
  for (const std::span<const double> block :
       {simulation.u(), simulation.v(), simulation.w_lambda(), simulation.w_mu()})
    state.insert(state.end(), block.begin(), block.end());
}

std::vector<double> compared_times(const rheo::TimeSettings& time) {
  std::vector<double> times;
  const std::int64_t count = rheo::output_count(time);
  for (std::int64_t k = 0; k < count; ++k) times.push_back(rheo::output_time(time, k));
  if (count == 1) times.push_back(time.duration);
  return times;
}

std::optional<rheo::Divergence> follow(rheo::Simulation& simulation, Trajectory& trajectory) {
  trajectory.states.clear();
  for (const double t : trajectory.times) {
    if (const auto divergence = simulation.advance(t)) return divergence;
    copy_state(simulation, trajectory.states.emplace_back());
  }
  return std::nullopt;
}

ErrorMeter::ErrorMeter(const Trajectory& reference) : reference_(reference) {
  for (const std::vector<double>& state : reference.states) {
    const std::size_t part = state.size() / 4;
    for (std::size_t block = 0; block < 4; ++block) {
      double sum = 0.0;
      for (std::size_t i = block * part; i < (block + 1) * part; ++i) sum += state[i] * state[i];
      largest_[block] = worse(largest_[block], std::sqrt(sum));
    }
  }
}

void ErrorMeter::include(std::size_t k, const std::vector<double>& state) {
  const std::vector<double>& exact = reference_.states[k];
  const std::size_t part = state.size() / 4;
  for (std::size_t block = 0; block < 4; ++block) {
    double sum = 0.0;
    for (std::size_t i = block * part; i < (block + 1) * part; ++i)
      sum += (state[i] - exact[i]) * (state[i] - exact[i]);
    difference_[block] = worse(difference_[block], std::sqrt(sum));
  }
}

double ErrorMeter::error() const {
  double error = 0.0;
  for (std::size_t block = 0; block < 4; ++block)
    if (difference_[block] > 0.0) error = std::max(error, difference_[block] / largest_[block]);
  return error;
}

bool ErrorMeter::nothing_moves() const {
  return std::ranges::all_of(largest_, [](double size) { return size == 0.0; });
}

double run_error(const Trajectory& reference, const Trajectory& run) {
  ErrorMeter meter(reference);
  for (std::size_t k = 0; k < reference.states.size(); ++k) meter.include(k, run.states[k]);
  return meter.error();
}

}  // namespace app
