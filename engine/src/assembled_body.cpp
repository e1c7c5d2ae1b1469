#include "assembled_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rheo {
namespace {

ConstVectorMap part(const Layout& layout, std::span<const double> y, std::size_t offset) {
  return {y.data() + offset, static_cast<Eigen::Index>(layout.part)};
}
ConstVectorMap part(const BranchPart& branch, std::span<const double> y) {
  return {y.data() + branch.offset, static_cast<Eigen::Index>(branch.size)};
}

// u, v, and every branch by itself while they are few; else all branches of a modulus together, with the
// smallest one's size over the largest's at the largest frequency.
std::vector<StatePart> parts_of(const Model& model) {
  constexpr std::size_t most = 16;  // LinearOperator::parts
  const Layout& layout = model.layout;
  std::vector<StatePart> parts(2, {layout.part, 1.0});
  if (2 + layout.branches.size() <= most) {
    for (const BranchPart& branch : layout.branches) parts.push_back({branch.size, 1.0});
    return parts;
  }
  for (const Modulus modulus : {Modulus::lambda, Modulus::mu}) {
    StatePart all;
    double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
    for (const BranchPart& branch : layout.branches) {
      if (branch.modulus != modulus) continue;
      const double reach = branch.ela / (branch.rate + model.element_omega);
      smallest = std::min(smallest, reach);
      largest = std::max(largest, reach);
      all.size += branch.size;
    }
    if (all.size == 0) continue;
    all.share = smallest / largest;
    parts.push_back(all);
  }
  return parts;
}

}  // namespace

AssembledBody::AssembledBody(const Model& model, double omega)
    : Body(model, omega),
      one_branch_(!model.has_several_materials() && !model.is_parallel()),
      feeds_on_u_(model.has_elastic_part()),
      parts_(parts_of(model)) {
  state_.assign(model.layout.size(), 0.0);
  rate_.assign(model.layout.size(), 0.0);
  // All memory of a step is taken here.
  const auto part = static_cast<Eigen::Index>(model.layout.part);
  for (Vector* v : {&rhs_, &momentum_, &reaction_, &reaction_rate_, &external_}) v->setZero(part);
  for (const Patch& patch : model.patches) {
    pull_.push_back(Vector::Zero(static_cast<Eigen::Index>(patch.part)));
    product_.push_back(pull_.back());
  }
  for (Evaluation* e : {&work_, &evaluation_, &derivative_}) {
    e->acceleration.setZero(part);
    if (model.layout.lambda) e->force_lambda.setZero(part);
    if (model.layout.mu) e->force_mu.setZero(part);
  }
}

void AssembledBody::load(std::span<const double> y) {
  std::copy(y.begin(), y.end(), state_.begin());
  evaluated_ = false;
}

void AssembledBody::store(std::span<double> y) const {
  std::copy(state_.begin(), state_.end(), y.begin());
}

void AssembledBody::enter(const Interval& interval, const Vector& base) {
  Body::enter(interval, base);
  target_.setZero(static_cast<Eigen::Index>(interval.solver->columns().size()));
  for (Evaluation* e : {&work_, &evaluation_, &derivative_}) e->multipliers.setZero(target_.size());
  constrained_.assign(model_.layout.part, 0);
  for (const HeldDof& h : interval.eliminated) constrained_[h.dof] = 1;
  for (const Column& column : interval.solver->columns()) {
    for (const auto& [dof, coefficient] : column.entries) constrained_[dof] = 1;
  }
  evaluated_ = false;
}

void AssembledBody::impose_prescribed(double t) {
  for (const HeldDof& h : interval_->eliminated) {
    state_[model_.layout.u() + h.dof] = prescribed(h, t, 0);
    state_[model_.layout.v() + h.dof] = prescribed(h, t, 1);
  }
  evaluated_ = false;
}

void AssembledBody::find_force(Modulus modulus, std::span<const double> x, Vector& force) {
  if (!model_.has_several_materials()) {
    force.noalias() = model_.j(modulus) * sum_of_parts(model_, 0, modulus, PartSum::pull, x, pull_.front());
    return;
  }
  force.setZero();
  for (std::size_t r = 0; r < model_.patches.size(); ++r) {
    const Patch& patch = model_.patches[r];
    if (!patch.has(modulus)) continue;
    Vector& own = product_[r];
    own.noalias() = patch.j(modulus) * sum_of_parts(model_, r, modulus, PartSum::pull, x, pull_[r]);
    patch.for_each_dof([&](std::size_t i, std::size_t j) { force[j] += own[i]; });
  }
}

const Vector& AssembledBody::product_of(std::size_t region, Modulus modulus, const double* x) {
  const Patch& patch = model_.patches[region];
  Vector &own = pull_[region], &result = product_[region];
  patch.for_each_dof([&](std::size_t i, std::size_t j) { own[i] = x[j]; });
  result.noalias() = patch.j(modulus) * own;
  return result;
}

void AssembledBody::evaluate(std::span<const double> x, const Forcing& forcing, Evaluation& result) {
  const Layout& layout = model_.layout;
  ++counters_.force_evaluations;

  rhs_ = forcing.weight[0] * interval_->force;
  if (interval_->force_rate.size() > 0) {
    rhs_ += (forcing.weight[0] * (forcing.t - interval_->begin) + forcing.weight[1]) * interval_->force_rate;
  }
  if (layout.lambda) {
    find_force(Modulus::lambda, x, result.force_lambda);
    rhs_ -= result.force_lambda;
  }
  if (layout.mu) {
    find_force(Modulus::mu, x, result.force_mu);
    rhs_ -= result.force_mu;
  }

  for (const HeldDof& h : interval_->eliminated) {
    double a = 0.0;
    if (interval_->moving) {
      for (int k = 0; k < 4; ++k) {  // b'' is a cubic
        if (forcing.weight[k] != 0.0) a += forcing.weight[k] * prescribed(h, forcing.t, 2 + k);
      }
    }
    result.acceleration[h.dof] = a;
  }

  const ConstraintSolver& solver = *interval_->solver;
  const double* u = x.data() + layout.u();
  const double* v = x.data() + layout.v();
  for (std::size_t j = 0; j < solver.columns().size(); ++j) {
    target_[j] = column_forcing(solver.columns()[j], forcing) - 2 * omega_ * solver.row_times(j, v) -
                 omega_ * omega_ * solver.row_times(j, u);
  }
  solver.solve(rhs_, result.acceleration, target_, result.multipliers);
  if (!model_.is_lumped()) ++counters_.mass_solves;
  if (!solver.columns().empty()) ++counters_.constraint_solves;
}

void AssembledBody::fma(double h, std::span<const double> x, std::span<const double> base,
                        const Forcing& forcing, std::span<double> out, Result result) {
  evaluated_ = false;  // the caller is about to change the state
  evaluate(x, forcing, work_);
  const Layout& layout = model_.layout;
  const std::size_t part = layout.part;
  const double* v = x.data() + layout.v();
  // Only Baumgarte's terms and the elastic part feed on u.
  if (result == Result::step || feeds_on_u_ || !interval_->solver->columns().empty()) {
    ++counters_.displacement_updates;
    for (std::size_t i = 0; i < part; ++i) out[layout.u() + i] = base[layout.u() + i] + h * v[i];
  }
  for (std::size_t i = 0; i < part; ++i)
    out[layout.v() + i] = base[layout.v() + i] + h * work_.acceleration[i];
  for (const BranchPart& branch : layout.branches) {
    ++counters_.branch_updates;
    const std::size_t offset = branch.offset;
    const double ela = branch.ela, decay = branch.rate;
    const double* w = x.data() + offset;
    model_.patches[branch.region].for_each_dof([&](std::size_t i, std::size_t j) {
      out[offset + i] = base[offset + i] + h * (ela * v[j] - decay * w[i]);
    });
  }
}

void AssembledBody::evaluate_state(double t) {
  if (evaluated_) return;
  evaluate(state_, {t, {1.0, 0.0, 0.0, 0.0}}, evaluation_);
  const Layout& layout = model_.layout;
  const double* v = state_.data() + layout.v();
  for (std::size_t i = 0; i < layout.part; ++i) {
    rate_[layout.u() + i] = v[i];
    rate_[layout.v() + i] = evaluation_.acceleration[i];
  }
  for (const BranchPart& branch : layout.branches) {
    const std::size_t offset = branch.offset;
    const double ela = branch.ela, decay = branch.rate;
    const double* w = state_.data() + offset;
    model_.patches[branch.region].for_each_dof(
        [&](std::size_t i, std::size_t j) { rate_[offset + i] = ela * v[j] - decay * w[i]; });
  }
  evaluated_ = true;
}

std::span<const double> AssembledBody::known_rate() const {
  return evaluated_ ? std::span<const double>(rate_) : std::span<const double>();
}

void AssembledBody::add_parallel_parts(std::size_t region, Modulus modulus, EnergySample& sample) {
  const Patch& patch = model_.patches[region];
  const Material& m = patch.material;
  const bool is_lambda = modulus == Modulus::lambda;
  const double elastic = is_lambda ? m.elastic.lambda : m.elastic.mu;
  const double viscous = is_lambda ? m.viscous.lambda : m.viscous.mu;
  const Layout& layout = model_.layout;
  if (elastic > 0.0) {
    const Vector& force = product_of(region, modulus, state_.data() + layout.u());
    sample.stored += 0.5 * elastic * pull_[region].dot(force);
  }
  if (viscous > 0.0) {
    const Vector& force = product_of(region, modulus, state_.data() + layout.v());
    sample.dissipated += viscous * pull_[region].dot(force);
    const double* a = rate_.data() + layout.v();
    double with_a = 0.0;
    patch.for_each_dof([&](std::size_t i, std::size_t j) { with_a += a[j] * force[i]; });
    sample.dissipated_rate += 2.0 * viscous * with_a;
  }
}

EnergySample AssembledBody::sample(double t) {
  evaluate_state(t);
  const Layout& layout = model_.layout;
  EnergySample p;
  const auto u = part(layout, state_, layout.u());
  const auto v = part(layout, state_, layout.v());
  const auto a = part(layout, rate_, layout.v());
  for (const BranchPart& branch : layout.branches) {
    const Vector* force = &product_[branch.region];
    if (one_branch_) {
      force = branch.modulus == Modulus::lambda ? &evaluation_.force_lambda : &evaluation_.force_mu;
    } else {
      product_[branch.region].noalias() =
          model_.patches[branch.region].j(branch.modulus) * part(branch, state_);
    }
    const double stored = part(branch, state_).dot(*force);
    p.stored += 0.5 * stored / branch.ela;
    if (std::isinf(branch.vis)) continue;
    p.dissipated += stored / branch.vis;
    p.dissipated_rate += 2.0 * part(branch, rate_).dot(*force) / branch.vis;
  }
  for (std::size_t r = 0; r < model_.patches.size(); ++r) {
    add_parallel_parts(r, Modulus::lambda, p);
    add_parallel_parts(r, Modulus::mu, p);
  }

  model_.multiply_mass(v.data(), momentum_.data());
  p.kinetic = 0.5 * v.dot(momentum_);
  p.load = interval_->force.dot(u);
  p.load_power = interval_->force.dot(v);
  if (interval_->force_rate.size() > 0) {
    p.load_slope = interval_->force_rate.dot(u);
    p.load_slope_rate = interval_->force_rate.dot(v);
    p.load += (t - interval_->begin) * p.load_slope;
    p.load_power += (t - interval_->begin) * p.load_slope_rate;
  }
  // Constraints work only where what they hold moves (general ones: by their drift). The reaction's slope is
  // the reaction of the operator's derivative, A y' + g'.
  if (interval_->moving || !interval_->solver->columns().empty()) {
    const Forcing slope{t, {0.0, 1.0, 0.0, 0.0}};
    reaction(evaluation_, {t, {1.0, 0.0, 0.0, 0.0}}, reaction_);
    evaluate(rate_, slope, derivative_);
    reaction(derivative_, slope, reaction_rate_);
    p.constraints = reaction_.dot(v);
    p.constraints_rate = reaction_rate_.dot(v) + reaction_.dot(a);
  }
  return p;
}

void AssembledBody::reaction(double t, Vector& out) {
  evaluate_state(t);
  reaction(evaluation_, {t, {1.0, 0.0, 0.0, 0.0}}, out);
}

std::span<const double> AssembledBody::multipliers(double t) {
  evaluate_state(t);
  return {evaluation_.multipliers.data(), static_cast<std::size_t>(evaluation_.multipliers.size())};
}

void AssembledBody::reaction(const Evaluation& evaluation, const Forcing& forcing, Vector& out) {
  out.resize(evaluation.acceleration.size());
  model_.multiply_mass(evaluation.acceleration.data(), out.data());
  if (model_.layout.lambda) out += evaluation.force_lambda;
  if (model_.layout.mu) out += evaluation.force_mu;
  external_force(forcing, external_);
  out -= external_;
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    if (!constrained_[i]) out[i] = 0.0;
  }
}

}  // namespace rheo
