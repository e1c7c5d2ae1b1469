// A lumped body with eliminated constraints, of any material: many branches, an elastic and a viscous part.
// What the kernels' forms of the force have in common.
//
//   v' = (f - F(p)) / m,  w_k' = growth_k v - decay_k w_k,  u' = v
//   p  = elastic u + viscous v + sum over k of w_k
//
// Several materials: p and w are kept by slot (element_form.hpp), of a node and a region, and F adds up a
// node's slots. Without, slots are nodes.
//
// p is kept in the state, a row a slot, and made anew at the end of each sweep over a block: the sweep
// gathers one row whatever the number of parts, and branches cost work at the nodes alone. Where an
// integrator forms sums of states it has p made anew (renew).
//
// Shapes   kernel's order: p, w: s x 4 (lambda x, y, mu x, y); u, v, mass: n x 2
// Not here F: ParallelEdgeBody, ParallelElementBody; one branch alone, which EdgeBody and ElementBody do with
//          less; consistent mass, general constraints: AssembledBody
#pragma once

#include <array>
#include <span>
#include <vector>

#include "body.hpp"
#include "kernels/block_team.hpp"
#include "kernels/branch_rows.hpp"
#include "kernels/nodal_terms.hpp"

namespace rheo {

// Slots in a row of one region, of as many nodes in a row.
struct SlotRun {
  std::size_t slot = 0, node = 0;
  std::int64_t count = 0;
  std::size_t region = 0;
};

class ParallelBody : public Body {
 public:
  int threads() const override { return team_.threads(); }
  void load(std::span<const double> y) override;
  void store(std::span<double> y) const override;
  void enter(const Interval& interval, const Vector& base) override;
  // p is a sum of the others, in another order of its terms after a sweep.
  std::size_t inexact_size() const override { return v(); }
  void impose_prescribed(double t) override;
  void fma(double h, std::span<const double> x, std::span<const double> base, const Forcing& forcing,
           std::span<double> out, Result result) override;
  void chain(std::span<const Sweep> sweeps) override;
  void renew(std::span<double> y) override;
  std::span<const StatePart> parts() const override { return parts_; }
  EnergySample sample(double t) override;
  void resample(double t, EnergySample& sample) override;
  void reaction(double t, Vector& out) override;
  void reaction_at(double t, std::span<const HeldDof> held, Vector& out) override;

 protected:
  // The numbering must outlive this. ends: of the blocks (node_blocks.hpp); threads: as many as pay; runs: by
  // rising slot, a node's slots after each other, none across the end of a block.
  ParallelBody(const Model& model, std::span<const std::int32_t> mesh_node,
               std::span<const std::int32_t> kernel_node, std::vector<std::int32_t> ends, int threads,
               std::vector<SlotRun> runs);

  // w_l^T J_lambda w_l, w_m^T J_mu w_m, and with x for the first w.
  struct Forms {
    double ll = 0.0, mm = 0.0, xl = 0.0, xm = 0.0;
  };

  // Of the visited block's nodes, from whole arrays: out_v = base_v - h F(x_p) / m, and out_u = base_u + h
  // x_v unless it is null; out_p may come to be anything.
  virtual void sweep_force(const SweepArrays& arrays, double h, const BlockVisit& visit) = 0;
  // By region. stride: 4 for rows w = (l, m) by slot, 2 for one vector by node that is both; x: n x 2.
  virtual void forms_of(const double* w, std::size_t stride, const double* x, std::span<Forms> forms) = 0;
  // F of rows p at one node.
  virtual std::array<double, 2> force_of(const double* rows, std::size_t node) const = 0;

  std::size_t nodes() const { return mesh_node_.size(); }
  std::size_t slots() const { return number_in_patch_.size(); }
  const double* inverse_mass() const { return terms_.inverse_mass(); }
  BlockTeam& team() { return team_; }

 private:
  // A branch of one region, with a modulus or two or none, and where its numbers lie in the mesh's state.
  struct RegionBranch {
    SweepMaterial material;
    const BranchPart* lambda = nullptr;
    const BranchPart* mu = nullptr;
  };
  using Branch = std::vector<RegionBranch>;  // by region

  // The state's parts: p, v, u, w of each branch.
  std::size_t p() const { return 0; }
  std::size_t v() const { return 4 * slots(); }
  std::size_t u() const { return v() + 2 * nodes(); }
  std::size_t w(std::size_t branch) const { return u() + 2 * nodes() + 4 * branch * slots(); }

  void make_branches();
  void make_parts();
  void sweep_block(const Sweep& sweep, const BlockVisit& visit);
  // p of slots in a row from the other parts of y.
  void renew_p(std::span<double> y, const SlotRun& run) const;
  void renew_p_of_node(std::span<double> y, std::size_t node) const;
  template <class Visit>
  void for_each_number(const Visit& visit) const;
  // rate_ = y' of the state.
  void find_rate(double t);
  NodeForce force_at(std::size_t node) const;

  std::span<const std::int32_t> mesh_node_, kernel_node_;
  std::vector<std::int32_t> ends_;
  BlockTeam team_;
  BranchRows rows_;
  std::vector<SlotRun> runs_;
  std::vector<std::size_t> run_begin_;         // by block, one more at the end
  std::vector<std::int32_t> number_in_patch_;  // by slot
  std::vector<Branch> branches_;
  std::vector<ParallelPart> part_;  // by region
  std::vector<Forms> forms_;        // likewise
  bool elastic_ = false, viscous_ = false;
  std::vector<StatePart> parts_;
  std::vector<double> mass_;
  NodalTerms terms_;
  bool imposed_ = false;  // since the interval began
  AlignedVector rate_, zero_;
};

}  // namespace rheo
