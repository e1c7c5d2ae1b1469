// A body by assembled matrices (Eigen, row-major): every mass, every constraint; the reference for the other
// kernels.
//
// The state is in the mesh's order.
#pragma once

#include <vector>

#include "body.hpp"

namespace rheo {

class AssembledBody : public Body {
 public:
  AssembledBody(const Model& model, double omega);

  std::string_view kernel() const override { return "csr"; }
  void load(std::span<const double> y) override;
  void store(std::span<double> y) const override;
  void enter(const Interval& interval, const Vector& base) override;
  void impose_prescribed(double t) override;
  void fma(double h, std::span<const double> x, std::span<const double> base, const Forcing& forcing,
           std::span<double> out, Result result) override;
  std::span<const StatePart> parts() const override { return parts_; }
  EnergySample sample(double t) override;
  std::span<const double> known_rate() const override;
  void know_rate(double t) override { evaluate_state(t); }
  void reaction(double t, Vector& out) override;
  std::span<const double> multipliers(double t) override;

 private:
  // All there is to know of a state's forces at one time.
  struct Evaluation {
    Vector acceleration;
    Vector force_lambda, force_mu;  // J_lambda p_lambda, J_mu p_mu; empty for a modulus that is off
    Vector multipliers;             // one per general constraint
  };

  void evaluate(std::span<const double> x, const Forcing& forcing, Evaluation& result);
  // J p of one modulus, summed over the regions.
  void find_force(Modulus modulus, std::span<const double> x, Vector& force);
  // J_r times a vector on the mesh's nodes, for those of one region; until the next call.
  const Vector& product_of(std::size_t region, Modulus modulus, const double* x);
  void add_parallel_parts(std::size_t region, Modulus modulus, EnergySample& sample);
  // evaluation_ and rate_ of the state at t.
  void evaluate_state(double t);
  void reaction(const Evaluation& evaluation, const Forcing& forcing, Vector& out);

  Evaluation work_, evaluation_, derivative_;
  bool one_branch_;               // of one material: evaluate() has every force that the energies want
  bool feeds_on_u_;               // an elastic part
  std::vector<StatePart> parts_;  // u, v, w of each branch and region, or of each modulus where they are many
  std::vector<double> rate_;
  bool evaluated_ = false;
  std::vector<Vector> pull_, product_;  // by region: p; J times a part
  Vector rhs_, target_, momentum_, reaction_, reaction_rate_, external_;
  std::vector<char> constrained_;  // by degree of freedom
};

}  // namespace rheo
