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

#include "physics.hpp"

namespace rheo {

// Powers and their time derivatives at one moment.
struct Powers {
  double dissipated = 0.0, dissipated_rate = 0.0;  // [W], [W/s]
  double constraints = 0.0, constraints_rate = 0.0;
  double load = 0.0;                                // f^T u [J]
  double load_power = 0.0;                          // f^T v [W]
  double load_slope = 0.0, load_slope_rate = 0.0;   // f'^T u [W], f'^T v [W/s]
};

class EnergyBook {
 public:
  EnergyBook(const Model& model, Physics& physics);

  // Powers of state y with its evaluation and rate y' at (y, t).
  Powers powers(std::span<const double> y, std::span<const double> rate, const Evaluation& evaluation, double t);

  void book_step(const Powers& before, const Powers& after, double h);
  void book_impulse(double work);

  double dissipated() const { return dissipated_; }
  double work() const { return work_; }
  // Sum of the sizes of all that work consists of: the scale for judging a balance.
  double turnover() const { return turnover_; }

  double kinetic(std::span<const double> y) const;
  double stored(std::span<const double> y, const Evaluation& evaluation) const;

 private:
  const Model& model_;
  Physics& physics_;
  double dissipated_ = 0.0, work_ = 0.0, turnover_ = 0.0;
  Evaluation derivative_;
  Vector reaction_, reaction_rate_;
  mutable Vector momentum_;
};

}  // namespace rheo
