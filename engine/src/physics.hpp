// The rheological body between two events as a linear operator y' = A y + g(t).
//
//   u'        = v
//   M v'      = f(t) - J_lambda w_lambda - J_mu w_mu + A L,  v_c' = b''(t) where a degree of freedom is eliminated
//   A^T v'    = b'' - 2 omega (A^T v - b') - omega^2 (A^T u - b) for the general constraints
//   w_lambda' = -lambda_rate w_lambda + lambda_ela v,  w_mu' likewise
//
// Source   Hirai and Tomokuni, eq. (4)
// Shapes   y: Layout; f, reaction: 2n
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "constraints.hpp"
#include "model.hpp"
#include "motion.hpp"
#include "rheo/integrator.hpp"
#include "rheo/simulation.hpp"

namespace rheo {

// What holds from one event to the next.
struct Interval {
  double begin = 0.0;
  Vector force;                 // external force at `begin` [N]
  Vector force_rate;            // its slope; empty where nothing changes
  std::vector<HeldDof> held;    // eliminated or, by Baumgarte for all, turned into columns
  std::vector<HeldDof> eliminated;
  std::vector<std::array<Polynomial, 2>> course;  // by holder: increment since the hold began
  std::shared_ptr<const ConstraintSolver> solver;
  bool moving = false;  // some course is not zero
};

// All there is to know of a state's forces at one time.
struct Evaluation {
  Vector acceleration;
  Vector force_lambda, force_mu;  // J_lambda w_lambda, J_mu w_mu; empty for a branch that is off
  Vector multipliers;             // one per general constraint
};

class Physics final : public LinearOperator {
 public:
  Physics(const Model& model, double omega);

  void enter(const Interval& interval, const Vector& base);

  std::size_t size() const override { return model_.layout.size(); }
  void fma(double h, std::span<const double> x, std::span<const double> base, const Forcing& forcing,
           std::span<double> out) override;

  // The pieces behind fma: forces, acceleration and multipliers for x under a forcing.
  void evaluate(std::span<const double> x, const Forcing& forcing, Evaluation& result);
  // y' = A y + g from an evaluation at (x, t).
  void rate(std::span<const double> x, const Evaluation& evaluation, std::span<double> out) const;

  Vector external_force(const Forcing& forcing) const;
  // M a + F - f on constrained degrees of freedom, zero elsewhere: what the constraints do to the nodes.
  void reaction(const Evaluation& evaluation, const Forcing& forcing, Vector& out) const;

  // Prescribed displacement (derivative 0), velocity (1), ... of a held degree of freedom.
  double prescribed(const HeldDof& held, double t, int derivative) const;
  // b and its derivatives of a general constraint.
  double column_value(const Column& column, double t, int derivative) const;

  const Interval& interval() const { return *interval_; }
  Counters& counters() { return counters_; }
  const Counters& counters() const { return counters_; }

 private:
  const Model& model_;
  double omega_;
  const Interval* interval_ = nullptr;
  const Vector* base_ = nullptr;  // u where each hold began, 2n
  Evaluation work_;
  Vector rhs_, target_;
  Counters counters_;
};

}  // namespace rheo
