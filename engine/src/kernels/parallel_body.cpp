#include "kernels/parallel_body.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/node_blocks.hpp"

namespace rheo {
namespace {

std::vector<double> entry_masses(const Model& model, std::span<const std::int32_t> mesh_node) {
  std::vector<double> masses;
  masses.reserve(2 * mesh_node.size());
  for (const std::int32_t node : mesh_node)
    masses.insert(masses.end(), {model.node_mass[node], model.node_mass[node]});
  return masses;
}

}  // namespace

ParallelBody::ParallelBody(const Model& model, std::span<const std::int32_t> mesh_node,
                           std::span<const std::int32_t> kernel_node, std::vector<std::int32_t> ends,
                           int threads, std::vector<SlotRun> runs)
    : Body(model, 0.0),
      mesh_node_(mesh_node),
      kernel_node_(kernel_node),
      ends_(std::move(ends)),
      team_(ends_, threads),
      rows_(branch_rows(best_simd_level())),
      runs_(std::move(runs)),
      part_(model.patches.size()),
      forms_(model.patches.size()),
      mass_(entry_masses(model, mesh_node)),
      terms_(mass_, kernel_node, ends_) {
  find_block_begins(
      ends_, runs_, [](const SlotRun& run) { return run.node; }, run_begin_);
  for (const SlotRun& run : runs_) {
    assert(run.slot == number_in_patch_.size());
    for (std::size_t i = 0; i < static_cast<std::size_t>(run.count); ++i)
      number_in_patch_.push_back(model.patches[run.region].number_of(mesh_node[run.node + i]));
  }
  make_branches();
  make_parts();
  state_.assign(w(branches_.size()), 0.0);
  rate_.assign(state_.size(), 0.0);
  zero_.assign(state_.size(), 0.0);
}

void ParallelBody::make_branches() {
  for (std::size_t k = 0; k < model_.branch_count(); ++k) {
    Branch branch(model_.patches.size());
    bool on = false;
    for (const BranchPart& part : model_.layout.branches) {
      if (part.number != k) continue;
      on = true;
      RegionBranch& own = branch[part.region];
      const std::size_t first = part.modulus == Modulus::lambda ? 0 : 2;
      (first == 0 ? own.lambda : own.mu) = &part;
      for (std::size_t c = first; c < first + 2; ++c) {
        own.material.growth[c] = part.ela;
        own.material.decay[c] = part.rate;
      }
    }
    if (on) branches_.push_back(std::move(branch));
  }
  for (std::size_t r = 0; r < part_.size(); ++r) {
    const Material& m = model_.patches[r].material;
    for (std::size_t c = 0; c < 4; ++c) {
      part_[r].elastic[c] = c < 2 ? m.elastic.lambda : m.elastic.mu;
      part_[r].viscous[c] = c < 2 ? m.viscous.lambda : m.viscous.mu;
    }
  }
  elastic_ = model_.has_elastic_part();
  viscous_ = model_.has_viscous_part();
}

// All residual forces of a branch share a part, and its bound must hold for the one that is smallest at the
// largest frequency. p follows from the others.
void ParallelBody::make_parts() {
  constexpr std::size_t most = 16;  // LinearOperator::parts
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const std::size_t n = nodes(), s = slots();
  parts_ = {StatePart{4 * s, 0.0}, StatePart{2 * n, 1.0}, StatePart{2 * n, 1.0}};
  const bool apart = parts_.size() + branches_.size() <= most;
  double smallest = infinite, largest = 0.0;
  for (const Branch& branch : branches_) {
    for (const RegionBranch& own : branch) {
      for (const BranchPart* part : {own.lambda, own.mu}) {
        if (part == nullptr) continue;
        const double reach = part->ela / (part->rate + model_.element_omega);
        smallest = std::min(smallest, reach);
        largest = std::max(largest, reach);
      }
    }
    if (!apart) continue;
    parts_.push_back({4 * s, smallest / largest});
    smallest = infinite, largest = 0.0;
  }
  if (!apart) parts_.push_back({4 * s * branches_.size(), smallest / largest});
}

// visit(kernel's number, mesh's number) for all of the state but p.
template <class Visit>
void ParallelBody::for_each_number(const Visit& visit) const {
  const Layout& layout = model_.layout;
  for (const SlotRun& run : runs_) {
    for (std::size_t k = run.slot; k < run.slot + static_cast<std::size_t>(run.count); ++k) {
      const std::size_t i = 2 * static_cast<std::size_t>(number_in_patch_[k]);
      for (std::size_t b = 0; b < branches_.size(); ++b) {
        const RegionBranch& own = branches_[b][run.region];
        for (std::size_t axis = 0; axis < 2; ++axis) {
          if (own.lambda != nullptr) visit(w(b) + 4 * k + axis, own.lambda->offset + i + axis);
          if (own.mu != nullptr) visit(w(b) + 4 * k + 2 + axis, own.mu->offset + i + axis);
        }
      }
    }
  }
  for (std::size_t k = 0; k < nodes(); ++k) {
    const std::size_t i = 2 * static_cast<std::size_t>(mesh_node_[k]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      visit(v() + 2 * k + axis, layout.v() + i + axis);
      visit(u() + 2 * k + axis, layout.u() + i + axis);
    }
  }
}

void ParallelBody::load(std::span<const double> y) {
  for_each_number([&](std::size_t kernel, std::size_t mesh) { state_[kernel] = y[mesh]; });
  renew(state_);
}

void ParallelBody::store(std::span<double> y) const {
  for_each_number([&](std::size_t kernel, std::size_t mesh) { y[mesh] = state_[kernel]; });
}

void ParallelBody::renew_p(std::span<double> y, const SlotRun& run) const {
  double* p_rows = y.data() + p() + 4 * run.slot;
  rows_.begin(part_[run.region], y.data() + u() + 2 * run.node, y.data() + v() + 2 * run.node, p_rows,
              run.count);
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    const double* w_rows = y.data() + w(b) + 4 * run.slot;
    for (std::size_t i = 0; i < 4 * static_cast<std::size_t>(run.count); ++i) p_rows[i] += w_rows[i];
  }
}

void ParallelBody::renew_p_of_node(std::span<double> y, std::size_t node) const {
  // The first run that reaches beyond the node; a node of several slots has runs of its own.
  auto run = std::partition_point(runs_.begin(), runs_.end(), [&](const SlotRun& r) {
    return r.node + static_cast<std::size_t>(r.count) <= node;
  });
  for (; run != runs_.end() && run->node <= node; ++run)
    renew_p(y, {run->slot + (node - run->node), node, 1, run->region});
}

void ParallelBody::renew(std::span<double> y) {
  for (const SlotRun& run : runs_) renew_p(y, run);
}

void ParallelBody::enter(const Interval& interval, const Vector& base) {
  Body::enter(interval, base);
  terms_.enter(interval);
  imposed_ = false;
}

void ParallelBody::impose_prescribed(double t) {
  terms_.impose(*this, t, state_.data() + u(), state_.data() + v());
  if (imposed_ && !interval_->moving) return;
  for (const HeldDof& h : interval_->eliminated)
    renew_p_of_node(state_, static_cast<std::size_t>(kernel_node_[static_cast<std::size_t>(h.dof / 2)]));
  imposed_ = true;
}

void ParallelBody::sweep_block(const Sweep& sweep, const BlockVisit& visit) {
  const double h = sweep.h;
  const double *x = sweep.x.data(), *base = sweep.base.data();
  double* out = sweep.out.data();
  const bool moves_u = sweep.result == Result::step || elastic_;
  const SweepArrays arrays{x + p(),   x + v(),   base + p(), base + v(),
                           out + p(), out + v(), base + u(), moves_u ? out + u() : nullptr};
  sweep_force(arrays, h, visit);
  terms_.add(*this, h, sweep.forcing, out + v(), visit.block);

  // (Where nothing is elastic u counts for nothing, but must be numbers.)
  const double* u_now = (moves_u ? out : base) + u();
  for (std::size_t r = run_begin_[visit.block]; r < run_begin_[visit.block + 1]; ++r) {
    const SlotRun& run = runs_[r];
    double* out_p = out + p() + 4 * run.slot;
    rows_.begin(part_[run.region], u_now + 2 * run.node, out + v() + 2 * run.node, out_p, run.count);
    for (std::size_t k = 0; k < branches_.size(); ++k) {
      const std::size_t at = w(k) + 4 * run.slot;
      rows_.advance(branches_[k][run.region].material, h, x + v() + 2 * run.node, x + at, base + at, out + at,
                    out_p, run.count);
    }
  }
}

void ParallelBody::fma(double h, std::span<const double> x, std::span<const double> base,
                       const Forcing& forcing, std::span<double> out, Result result) {
  const Sweep sweep{h, x, base, forcing, out, result};
  chain({&sweep, 1});
}

// What sweep k overwrites (the argument of sweep k - 1, or the base) was read in the block and in those
// beside it before: the team's order.
void ParallelBody::chain(std::span<const Sweep> sweeps) {
  const auto count = static_cast<std::int64_t>(sweeps.size());
  counters_.force_evaluations += count;
  counters_.branch_updates += count * static_cast<std::int64_t>(model_.layout.branches.size());
  for (const Sweep& sweep : sweeps) {
    if (elastic_ || sweep.result == Result::step) ++counters_.displacement_updates;
  }
  team_.chain(sweeps.size(), [&](const BlockVisit& at) { sweep_block(sweeps[at.sweep], at); });
}

void ParallelBody::find_rate(double t) {
  fma(1.0, state_, zero_, {t, {1.0, 0.0, 0.0, 0.0}}, rate_, Result::step);
}

EnergySample ParallelBody::sample(double t) {
  const double* xv = state_.data() + v();
  EnergySample e;
  for (std::size_t i = 0; i < mass_.size(); ++i) e.kinetic += 0.5 * mass_[i] * xv[i] * xv[i];
  for (std::size_t k = 0; k < branches_.size(); ++k) {
    forms_of(state_.data() + w(k), 4, xv, forms_);
    const auto branch = [&](const BranchPart* part, double quadratic, double with_v) {
      if (part == nullptr) return;
      e.stored += 0.5 * quadratic / part->ela;
      if (std::isinf(part->vis)) return;
      e.dissipated += quadratic / part->vis;
      e.dissipated_rate += 2.0 * (part->ela * with_v - part->rate * quadratic) / part->vis;
    };
    for (std::size_t r = 0; r < forms_.size(); ++r) {
      branch(branches_[k][r].lambda, forms_[r].ll, forms_[r].xl);
      branch(branches_[k][r].mu, forms_[r].mm, forms_[r].xm);
    }
  }
  if (elastic_) {
    forms_of(state_.data() + u(), 2, xv, forms_);
    for (std::size_t r = 0; r < forms_.size(); ++r)
      e.stored += 0.5 * (part_[r].elastic[0] * forms_[r].ll + part_[r].elastic[2] * forms_[r].mm);
  }
  if (viscous_ || interval_->moving) find_rate(t);
  if (viscous_) {
    forms_of(xv, 2, rate_.data() + v(), forms_);
    for (std::size_t r = 0; r < forms_.size(); ++r) {
      const auto& viscous = part_[r].viscous;
      e.dissipated += viscous[0] * forms_[r].ll + viscous[2] * forms_[r].mm;
      e.dissipated_rate += 2.0 * (viscous[0] * forms_[r].xl + viscous[2] * forms_[r].xm);
    }
  }
  terms_.sample(
      *this, t, state_.data() + u(), xv, [&](std::size_t node) { return force_at(node); }, e);
  return e;
}

// Where loads or constraints are others, so is the acceleration that the viscous part feels.
void ParallelBody::resample(double t, EnergySample& e) {
  if (viscous_) {
    e = sample(t);
    return;
  }
  if (interval_->moving) find_rate(t);
  terms_.sample(
      *this, t, state_.data() + u(), state_.data() + v(), [&](std::size_t node) { return force_at(node); },
      e);
}

// Of p', as find_rate() left it, too.
NodeForce ParallelBody::force_at(std::size_t node) const {
  return {force_of(state_.data() + p(), node), force_of(rate_.data() + p(), node)};
}

void ParallelBody::reaction(double t, Vector& out) {
  terms_.reaction(
      *this, t, [&](std::size_t node) { return force_at(node); }, out);
}

void ParallelBody::reaction_at(double t, std::span<const HeldDof> held, Vector& out) {
  terms_.reaction_at(
      *this, t, held, [&](std::size_t node) { return force_at(node); }, out);
}

}  // namespace rheo
