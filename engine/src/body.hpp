// The rheological body between two events as a linear operator y' = A y + g(t), with the state it acts on.
//
//   u'        = v
//   M v'      = f(t) - J_lambda p_lambda - J_mu p_mu + A L,  v_c' = b''(t) where a degree of freedom is
//   eliminated A^T v'    = b'' - 2 omega (A^T v - b') - omega^2 (A^T u - b) for the general constraints
//   w_lambda' = -lambda_rate w_lambda + lambda_ela v of each branch,  w_mu' likewise
//   p_lambda  = sum of w_lambda + elastic_lambda u + viscous_lambda v,  p_mu likewise
//
// Each kind of body keeps its state in an order of its own; load() and store() translate to the mesh's
// (Layout).
//
// Source   Hirai and Tomokuni, eq. (4)
// Shapes   y: Layout; f, reaction: 2n
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "aligned_vector.hpp"
#include "constraints.hpp"
#include "model.hpp"
#include "motion.hpp"
#include "rheo/integrator.hpp"
#include "rheo/simulation.hpp"

namespace rheo {

// What holds from one event to the next.
struct Interval {
  double begin = 0.0;
  Vector force;               // external force at `begin` [N]
  Vector force_rate;          // its slope; empty or zero where nothing changes
  std::vector<HeldDof> held;  // eliminated or, by Baumgarte for all, turned into columns
  std::vector<HeldDof> eliminated;
  std::vector<std::array<Polynomial, 2>> course;  // by holder: increment since the hold began
  std::shared_ptr<const ConstraintSolver> solver;
  bool moving = false;  // some course is not constant
};

// Energies and powers at one moment, with the time derivatives that the quadrature of the powers wants.
struct EnergySample {
  double kinetic = 0.0, stored = 0.0;                // [J]
  double dissipated = 0.0, dissipated_rate = 0.0;    // [W], [W/s]
  double constraints = 0.0, constraints_rate = 0.0;  // power of the constraint forces
  double load = 0.0;                                 // f^T u [J]
  double load_power = 0.0;                           // f^T v [W]
  double load_slope = 0.0, load_slope_rate = 0.0;    // f'^T u [W], f'^T v [W/s]
};

class Body : public LinearOperator {
 public:
  // `model` must outlive this.
  Body(const Model& model, double omega) : model_(model), omega_(omega) {}

  std::span<double> state() { return state_; }
  std::size_t size() const override { return state_.size(); }

  virtual std::string_view kernel() const = 0;
  virtual int threads() const { return 1; }
  // Of the implicit integrator's factor for one step size [bytes].
  virtual std::size_t factor_bytes() const { return 0; }

  // From and to the mesh's order.
  virtual void load(std::span<const double> y) = 0;
  virtual void store(std::span<double> y) const = 0;

  // Both stay alive until the next call; base: u where each hold began less its course there, 2n.
  virtual void enter(const Interval& interval, const Vector& base);

  // The first so many numbers of the state are not the same to the bit after store() and load().
  virtual std::size_t inexact_size() const { return 0; }
  // Makes known_rate() known, as sample(t) does.
  virtual void know_rate(double /*t*/) {}

  // After a step: eliminated degrees of freedom are where they are told to be at t, exactly.
  virtual void impose_prescribed(double t) = 0;

  virtual EnergySample sample(double t) = 0;
  // Brings a sample of the same state up to date where only the interval is another one.
  virtual void resample(double t, EnergySample& sample) { sample = this->sample(t); }

  // y' at the time of the last sample() while the state is still the same, else empty.
  virtual std::span<const double> known_rate() const { return {}; }

  // M a + F - f on constrained degrees of freedom, zero elsewhere: what the constraints do to the nodes.
  virtual void reaction(double t, Vector& out) = 0;
  // The same where only some eliminated degrees of freedom are looked at; others may hold anything.
  virtual void reaction_at(double t, std::span<const HeldDof> /*held*/, Vector& out) { reaction(t, out); }
  // One a general constraint.
  virtual std::span<const double> multipliers(double /*t*/) { return {}; }

  void external_force(double t, Vector& out) const { external_force({t, {1.0, 0.0, 0.0, 0.0}}, out); }

  // Prescribed displacement (derivative 0), velocity (1), ... of a held degree of freedom.
  double prescribed(const HeldDof& held, double t, int derivative) const;
  // b and its derivatives of a general constraint.
  double column_value(const Column& column, double t, int derivative) const;
  // b'' + 2 omega b' + omega^2 b of a general constraint, as the operator's forcing.
  double column_forcing(const Column& column, const Forcing& forcing) const;

  Counters& counters() { return counters_; }

 protected:
  void external_force(const Forcing& forcing, Vector& out) const;

  const Model& model_;
  double omega_;
  const Interval* interval_ = nullptr;
  const Vector* base_ = nullptr;
  AlignedVector state_;
  Counters counters_;
};

}  // namespace rheo
