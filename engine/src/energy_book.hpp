// Energy that has gone in and been dissipated, by quadrature along the steps.
//
//   dissipated' = w_l^T J_l w_l / lambda_vis + w_m^T J_m w_m / mu_vis
//   work'       = f^T v + (constraint forces)^T v
//   integral over a step: h / 2 (P0 + P1) + h^2 / 12 (P0' - P1'), of order 4; the loads' part by parts,
//   [f^T u] - integral of f'^T u, which is exact for constant loads
//
// Independent of the balance kinetic + stored + dissipated - work = const, which it serves to check.
// Units    energies [J], powers [W]
#pragma once

#include <algorithm>

#include "body.hpp"

namespace rheo {

class EnergyBook {
 public:
  void book_step(const EnergySample& before, const EnergySample& after, double h);
  void book_impulse(double work);
  // Raises the scale so that `energy` is within work() + turnover().
  void allow(double energy) { turnover_ = std::max(turnover_, energy - work_); }

  // What went before this book was begun, on other terms: in all_*, and no measure of what goes on now.
  void go_on(double dissipated, double work) {
    dissipated_before_ = dissipated;
    work_before_ = work;
  }

  double work() const { return work_; }
  // Sum of the sizes of all that work consists of: the scale for judging a balance.
  double turnover() const { return turnover_; }
  // The same where loads and constraint forces that cancel each other step by step count for nothing.
  double net_turnover() const { return net_turnover_; }
  double all_dissipated() const { return dissipated_before_ + dissipated_; }
  double all_work() const { return work_before_ + work_; }

 private:
  double dissipated_ = 0.0, work_ = 0.0, turnover_ = 0.0, net_turnover_ = 0.0;
  double dissipated_before_ = 0.0, work_before_ = 0.0;
};

}  // namespace rheo
