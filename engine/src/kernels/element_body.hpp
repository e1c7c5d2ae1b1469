// A lumped body with eliminated constraints by the element form (element_form.hpp), of one or several
// materials: one fused sweep an evaluation.
//
//   v' = (f - F) / m at each node, F the sum over its slots
//   w_lambda' = lambda_ela v - (lambda_ela / lambda_vis) w_lambda, w_mu' likewise, at each slot by its
//   region's material
//
// Threads  blocks of nodes by several threads (block_team.hpp, element_sums.hpp): the same bits for any
// number Not here consistent mass, general constraints: AssembledBody
#pragma once

#include <array>
#include <vector>

#include "body.hpp"
#include "kernels/block_team.hpp"
#include "kernels/element_force.hpp"
#include "kernels/element_sums.hpp"
#include "kernels/nodal_terms.hpp"

namespace rheo {

// By slot: its node's number in its region's patch.
std::vector<std::int32_t> numbers_in_patches(const Model& model, const ElementForm& form);

class ElementBody final : public Body {
 public:
  // `force` must outlive this. threads: 0 for as many as pay on this machine.
  ElementBody(const Model& model, const ElementForce& force, int threads);

  std::string_view kernel() const override { return "element"; }
  int threads() const override { return team_.threads(); }
  void load(std::span<const double> y) override;
  void store(std::span<double> y) const override;
  void enter(const Interval& interval, const Vector& base) override;
  void impose_prescribed(double t) override;
  void fma(double h, std::span<const double> x, std::span<const double> base, const Forcing& forcing,
           std::span<double> out, Result result) override;
  void chain(std::span<const Sweep> sweeps) override;
  std::span<const StatePart> parts() const override { return parts_; }
  EnergySample sample(double t) override;
  void resample(double t, EnergySample& sample) override;
  void reaction(double t, Vector& out) override;
  void reaction_at(double t, std::span<const HeldDof> held, Vector& out) override;

  // The state's parts: p (s x 4), v (n x 2), u (n x 2).
  std::size_t p() const { return 0; }
  std::size_t v() const { return 4 * static_cast<std::size_t>(form_.slots); }
  std::size_t u() const { return v() + 2 * static_cast<std::size_t>(form_.nodes); }

 private:
  template <class Visit>
  void for_each_number(const Visit& visit) const;

  // One sweep over one block.
  void sweep_block(const Sweep& sweep, const BlockVisit& visit);
  // The nodes' part of it, for one node with several slots.
  void advance_interface(const ElementForm::Run& run, double h, const SweepArrays& arrays, double* force);

  NodeForce force_at(std::size_t node) const;

  // Sums over a block's triangles of one region.
  struct Sums {
    double ll = 0.0, mm = 0.0, vl = 0.0, vm = 0.0;  // x^T J w: w_l with itself, w_m likewise, v with both
  };
  void add_sums(const ElementForm::Block& block, std::span<Sums> by_region) const;

  const ElementForce& element_force_;
  const ElementForm& form_;
  std::vector<ElementForm::Block> blocks_;
  BlockTeam team_;
  std::array<StatePart, 3> parts_;
  std::vector<SweepMaterial> materials_;  // by region
  struct Branch {
    const BranchPart* lambda = nullptr;
    const BranchPart* mu = nullptr;
  };
  std::vector<Branch> branches_;               // by region: where its numbers lie in the mesh's state
  std::vector<std::int32_t> number_in_patch_;  // by slot
  std::vector<double> mass_;                   // n x 2
  NodalTerms terms_;
  ElementSums force_sums_;
  // Of energies, by block and region: added up in their order, which the number of threads does not change.
  std::vector<Sums> sums_;
};

}  // namespace rheo
