#include "energy_book.hpp"

#include <cmath>

namespace rheo {

void EnergyBook::book_step(const EnergySample& before, const EnergySample& after, double h) {
  const auto integral = [h](double p0, double p1, double rate0, double rate1) {
    return h / 2 * (p0 + p1) + h * h / 12 * (rate0 - rate1);
  };
  dissipated_ += integral(before.dissipated, after.dissipated, before.dissipated_rate, after.dissipated_rate);
  const double loads =
      after.load - before.load -
      integral(before.load_slope, after.load_slope, before.load_slope_rate, after.load_slope_rate);
  const double constraints =
      integral(before.constraints, after.constraints, before.constraints_rate, after.constraints_rate);
  work_ += loads + constraints;
  // Euler moves a step late: the load's power at both ends belongs to the scale although not to the work.
  net_turnover_ += std::abs(loads + constraints) + h * (std::abs(before.load_power + before.constraints) +
                                                        std::abs(after.load_power + after.constraints));
  turnover_ += std::abs(loads) + h * (std::abs(before.load_power) + std::abs(after.load_power)) +
               integral(std::abs(before.constraints), std::abs(after.constraints),
                        std::abs(before.constraints_rate), -std::abs(after.constraints_rate));
}

void EnergyBook::book_impulse(double work) {
  work_ += work;
  turnover_ += std::abs(work);
  net_turnover_ += std::abs(work);
}

}  // namespace rheo
