#include "kernels/parallel_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
                           int threads)
    : Body(model, 0.0),
      mesh_node_(mesh_node),
      kernel_node_(kernel_node),
      ends_(std::move(ends)),
      team_(ends_, threads),
      rows_(branch_rows(best_simd_level())),
      mass_(entry_masses(model, mesh_node)),
      terms_(mass_, kernel_node, ends_) {
  make_branches();
  make_parts();
  state_.assign(w(branches_.size()), 0.0);
  rate_.assign(state_.size(), 0.0);
  zero_.assign(state_.size(), 0.0);
}

void ParallelBody::make_branches() {
  const Material& m = model_.material;
  for (std::size_t k = 0; k < m.branch_count(); ++k) {
    Branch branch;
    for (const BranchPart& part : model_.layout.branches) {
      if (part.number != k) continue;
      const std::size_t first = part.modulus == Modulus::lambda ? 0 : 2;
      (first == 0 ? branch.lambda : branch.mu) = &part;
      for (std::size_t c = first; c < first + 2; ++c) {
        branch.material.growth[c] = part.ela;
        branch.material.decay[c] = part.rate;
      }
    }
    if (branch.lambda != nullptr || branch.mu != nullptr) branches_.push_back(branch);
  }
  for (std::size_t c = 0; c < 4; ++c) {
    part_.elastic[c] = c < 2 ? m.elastic.lambda : m.elastic.mu;
    part_.viscous[c] = c < 2 ? m.viscous.lambda : m.viscous.mu;
    elastic_ = elastic_ || part_.elastic[c] > 0.0;
    viscous_ = viscous_ || part_.viscous[c] > 0.0;
  }
}

// A branch's two residual forces share a part, and its bound must hold for the one that is smaller at the
// largest frequency. p follows from the others.
void ParallelBody::make_parts() {
  constexpr std::size_t most = 16;  // LinearOperator::parts
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const std::size_t n = nodes();
  parts_ = {StatePart{4 * n, 0.0}, StatePart{2 * n, 1.0}, StatePart{2 * n, 1.0}};
  const bool apart = parts_.size() + branches_.size() <= most;
  double smallest = infinite, largest = 0.0;
  for (const Branch& branch : branches_) {
    for (const BranchPart* part : {branch.lambda, branch.mu}) {
      if (part == nullptr) continue;
      const double reach = part->ela / (part->rate + model_.element_omega);
      smallest = std::min(smallest, reach);
      largest = std::max(largest, reach);
    }
    if (!apart) continue;
    parts_.push_back({4 * n, smallest / largest});
    smallest = infinite, largest = 0.0;
  }
  if (!apart) parts_.push_back({4 * n * branches_.size(), smallest / largest});
}

void ParallelBody::load(std::span<const double> y) {
  const Layout& layout = model_.layout;
  for (std::size_t k = 0; k < nodes(); ++k) {
    const auto node = static_cast<std::size_t>(mesh_node_[k]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const std::size_t i = 2 * node + axis;
      for (std::size_t b = 0; b < branches_.size(); ++b) {
        double* row = state_.data() + w(b) + 4 * k;
        if (branches_[b].lambda != nullptr) row[axis] = y[branches_[b].lambda->offset + i];
        if (branches_[b].mu != nullptr) row[2 + axis] = y[branches_[b].mu->offset + i];
      }
      state_[v() + 2 * k + axis] = y[layout.v() + i];
      state_[u() + 2 * k + axis] = y[layout.u() + i];
    }
  }
  renew(state_);
}

void ParallelBody::store(std::span<double> y) const {
  const Layout& layout = model_.layout;
  for (std::size_t k = 0; k < nodes(); ++k) {
    const auto node = static_cast<std::size_t>(mesh_node_[k]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const std::size_t i = 2 * node + axis;
      for (std::size_t b = 0; b < branches_.size(); ++b) {
        const double* row = state_.data() + w(b) + 4 * k;
        if (branches_[b].lambda != nullptr) y[branches_[b].lambda->offset + i] = row[axis];
        if (branches_[b].mu != nullptr) y[branches_[b].mu->offset + i] = row[2 + axis];
      }
      y[layout.v() + i] = state_[v() + 2 * k + axis];
      y[layout.u() + i] = state_[u() + 2 * k + axis];
    }
  }
}

void ParallelBody::renew_p(std::span<double> y, std::size_t first, std::size_t count) const {
  double* p_rows = y.data() + p() + 4 * first;
  rows_.begin(part_, y.data() + u() + 2 * first, y.data() + v() + 2 * first, p_rows,
              static_cast<std::int64_t>(count));
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    const double* w_rows = y.data() + w(b) + 4 * first;
    for (std::size_t i = 0; i < 4 * count; ++i) p_rows[i] += w_rows[i];
  }
}

void ParallelBody::renew(std::span<double> y) {
  renew_p(y, 0, nodes());
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
    renew_p(state_, static_cast<std::size_t>(kernel_node_[static_cast<std::size_t>(h.dof / 2)]), 1);
  imposed_ = true;
}

void ParallelBody::sweep_block(const Sweep& sweep, std::size_t block) {
  const double h = sweep.h;
  const double *x = sweep.x.data(), *base = sweep.base.data();
  double* out = sweep.out.data();
  const bool moves_u = sweep.result == Result::step || elastic_;
  const SweepArrays arrays{x + p(),   x + v(),   base + p(), base + v(),
                           out + p(), out + v(), base + u(), moves_u ? out + u() : nullptr};
  sweep_force(arrays, h, block);
  terms_.add(*this, h, sweep.forcing, out + v(), block);

  const auto first = static_cast<std::size_t>(block == 0 ? 0 : ends_[block - 1]);
  const std::int64_t count = ends_[block] - static_cast<std::int64_t>(first);
  double* out_p = out + p() + 4 * first;
  // (Where nothing is elastic u counts for nothing, but must be numbers.)
  const double* u_now = (moves_u ? out : base) + u() + 2 * first;
  rows_.begin(part_, u_now, out + v() + 2 * first, out_p, count);
  for (std::size_t k = 0; k < branches_.size(); ++k) {
    const std::size_t at = w(k) + 4 * first;
    rows_.advance(branches_[k].material, h, x + v() + 2 * first, x + at, base + at, out + at, out_p, count);
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
  team_.chain(sweeps.size(),
              [&](std::size_t sweep, std::size_t block) { sweep_block(sweeps[sweep], block); });
}

void ParallelBody::find_rate(double t) {
  fma(1.0, state_, zero_, {t, {1.0, 0.0, 0.0, 0.0}}, rate_, Result::step);
}

EnergySample ParallelBody::sample(double t) {
  const double* xv = state_.data() + v();
  EnergySample e;
  for (std::size_t i = 0; i < mass_.size(); ++i) e.kinetic += 0.5 * mass_[i] * xv[i] * xv[i];
  for (std::size_t k = 0; k < branches_.size(); ++k) {
    const Forms forms = forms_of(state_.data() + w(k), 4, xv);
    const auto branch = [&](const BranchPart* part, double quadratic, double with_v) {
      if (part == nullptr) return;
      e.stored += 0.5 * quadratic / part->ela;
      if (std::isinf(part->vis)) return;
      e.dissipated += quadratic / part->vis;
      e.dissipated_rate += 2.0 * (part->ela * with_v - part->rate * quadratic) / part->vis;
    };
    branch(branches_[k].lambda, forms.ll, forms.xl);
    branch(branches_[k].mu, forms.mm, forms.xm);
  }
  if (elastic_) {
    const Forms forms = forms_of(state_.data() + u(), 2, xv);
    e.stored += 0.5 * (part_.elastic[0] * forms.ll + part_.elastic[2] * forms.mm);
  }
  if (viscous_ || interval_->moving) find_rate(t);
  if (viscous_) {
    const Forms forms = forms_of(xv, 2, rate_.data() + v());
    e.dissipated += part_.viscous[0] * forms.ll + part_.viscous[2] * forms.mm;
    e.dissipated_rate += 2.0 * (part_.viscous[0] * forms.xl + part_.viscous[2] * forms.xm);
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
