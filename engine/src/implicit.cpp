#include "implicit.hpp"

#include <cassert>
#include <cmath>
#include <utility>

namespace rheo {

double Implicit::shift_of(double h, double time) {
  int exponent = 0;
  const double mantissa = std::frexp(gamma * h / time, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, 24)), exponent - 24) * time;
}

std::array<double, Implicit::stages> Implicit::weights(double x) {
  // k L_k = (2 k - 2 - x) L_{k-1} - (k - 2) L_{k-2}, for the parameter -1.
  std::array<double, stages> d{};
  double before = 1.0, now = -x;
  d[0] = x;
  for (int k = 2; k <= stages; ++k) {
    const double next = ((2 * k - 2 - x) * now - (k - 2) * before) / k;
    before = std::exchange(now, next);
    d[k - 1] = k % 2 == 0 ? now : -now;
  }
  return d;
}

void Implicit::step(LinearOperator& op, double t, double h, std::span<double> y, std::span<const double>) {
  assert(op.solves_shifted() && y.size() == increment_.size());
  const double s = shift_of(h, time_);
  converged_ = op.prepare_shifted(s);
  if (!converged_) return;
  if (h / s != weights_for_) {
    weights_for_ = h / s;
    weights_ = weights(weights_for_);
  }
  // c of the joined state: its increment in this stage becomes the next stage's state.
  std::array<double, 6> c{1.0};
  std::span<const double> x = y;
  for (int k = 0; k < stages; ++k) {
    // c_0 does not change: its increment is 0.
    std::array<double, 6> change{};
    for (std::size_t j = 1; j < c.size(); ++j) change[j] = s * (c[j - 1] + change[j - 1]);
    Forcing forcing{t, {}};
    for (std::size_t j = 0; j < c.size(); ++j) forcing.weight[j] = c[j] + change[j];
    op.solve_shifted(s, x, forcing, next_);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += weights_[k] * next_[i];
    std::swap(increment_, next_);
    x = increment_;
    c = change;
  }
}

}  // namespace rheo
