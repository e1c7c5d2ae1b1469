// A lumped body with eliminated constraints by the edge form (edge_form.hpp): one fused sweep an evaluation.
//
// Branches that relax at one rate, or one branch alone, are advanced as one; branches that never relax are
// not advanced at all: their residual forces are the moduli times u (a scene starts from u = 0, w = 0).
//
// Not here consistent mass, general constraints: AssembledBody
#pragma once

#include <vector>

#include "body.hpp"
#include "kernels/block_team.hpp"
#include "kernels/edge_force.hpp"
#include "kernels/nodal_terms.hpp"

namespace rheo {

class EdgeBody final : public Body {
 public:
  // `force` must outlive this. threads: 0 for as many as pay on this machine.
  EdgeBody(const Model& model, const EdgeForce& force, int threads);

  // The state's part p holds w_lambda and w_mu: the smaller's size over the larger's, both driven by the same
  // v at the largest frequency. An error bound for p has to be smaller by as much to hold for both.
  static double smallest_share(const Model& model);

  std::string_view kernel() const override { return "edge"; }
  int threads() const override { return team_.threads(); }
  void load(std::span<const double> y) override;
  void store(std::span<double> y) const override;
  void enter(const Interval& interval, const Vector& base) override;
  // Combined branches are kept without their moduli.
  std::size_t inexact_size() const override { return form_.moduli && !elastic_ ? v() : 0; }
  void impose_prescribed(double t) override;
  void fma(double h, std::span<const double> x, std::span<const double> base, const Forcing& forcing,
           std::span<double> out, Result result) override;
  void chain(std::span<const Sweep> sweeps) override;
  std::span<const StatePart> parts() const override { return parts_; }
  EnergySample sample(double t) override;
  void resample(double t, EnergySample& sample) override;
  void reaction(double t, Vector& out) override;
  void reaction_at(double t, std::span<const HeldDof> held, Vector& out) override;

 private:
  // The state's parts: p (n x row), v (n x 2), u (n x 2; p itself where nothing relaxes).
  std::size_t row() const { return static_cast<std::size_t>(form_.row); }
  std::size_t p() const { return 0; }
  std::size_t v() const { return row() * static_cast<std::size_t>(form_.nodes); }
  std::size_t u() const { return elastic_ ? 0 : v() + 2 * static_cast<std::size_t>(form_.nodes); }

  // One sweep over one block.
  void sweep_block(const Sweep& sweep, std::size_t block) const;

  NodeForce force_at(std::size_t node) const;

  // Sums over a block's edges and nodes, for the energies; combined branches: ll and vl with K for both.
  struct Sums {
    EdgeForms forms;       // x: v
    double kinetic = 0.0;  // v^T M v
  };
  Sums sums_of(const EdgeForm::Block& block) const;
  EdgeForms combined_forms(const double* xq, const double* xv, const EdgeForm::Block& block) const;

  const EdgeForce& edge_force_;
  const EdgeForm& form_;
  BlockTeam team_;
  std::vector<Sums> sums_;  // by block: added up in their order, whatever the number of threads
  SweepMaterial material_;
  bool elastic_ = false;  // combined, and nothing relaxes
  std::vector<StatePart> parts_;
  std::vector<double> mass_;  // n x 2, kernel order
  NodalTerms terms_;
  std::vector<std::size_t> corner_begin_;  // by block, one more at the end
};

}  // namespace rheo
