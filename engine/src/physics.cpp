#include "physics.hpp"

namespace rheo {

Physics::Physics(const Model& model, double omega) : model_(model), omega_(omega) {
  rhs_.setZero(static_cast<Eigen::Index>(model.layout.part));
}

void Physics::enter(const Interval& interval, const Vector& base) {
  interval_ = &interval;
  base_ = &base;
  target_.setZero(static_cast<Eigen::Index>(interval.solver->columns().size()));
}

double Physics::prescribed(const HeldDof& held, double t, int derivative) const {
  const double course = interval_->course[held.owner][held.dof % 2].derivative(t, derivative);
  return derivative == 0 ? (*base_)[held.dof] + course : course;
}

double Physics::column_value(const Column& column, double t, int derivative) const {
  if (column.owner >= 0) return prescribed({column.entries.front().first, column.owner}, t, derivative);
  return derivative == 0 ? column.value : 0.0;
}

Vector Physics::external_force(const Forcing& forcing) const {
  Vector force = forcing.weight[0] * interval_->force;
  if (interval_->force_rate.size() > 0) {
    force += (forcing.weight[0] * (forcing.t - interval_->begin) + forcing.weight[1]) * interval_->force_rate;
  }
  return force;
}

void Physics::evaluate(std::span<const double> x, const Forcing& forcing, Evaluation& result) {
  const Layout& layout = model_.layout;
  const auto part = static_cast<Eigen::Index>(layout.part);
  ++counters_.force_evaluations;

  rhs_ = forcing.weight[0] * interval_->force;
  if (interval_->force_rate.size() > 0) {
    rhs_ += (forcing.weight[0] * (forcing.t - interval_->begin) + forcing.weight[1]) * interval_->force_rate;
  }
  if (layout.lambda) {
    result.force_lambda.noalias() = model_.j_lambda * ConstVectorMap(x.data() + layout.w_lambda(), part);
    rhs_ -= result.force_lambda;
  }
  if (layout.mu) {
    result.force_mu.noalias() = model_.j_mu * ConstVectorMap(x.data() + layout.w_mu(), part);
    rhs_ -= result.force_mu;
  }

  if (result.acceleration.size() != part) result.acceleration.setZero(part);
  for (const HeldDof& h : interval_->eliminated) {
    double a = 0.0;
    if (interval_->moving) {
      for (int k = 0; k < 4; ++k) {
        if (forcing.weight[k] != 0.0) a += forcing.weight[k] * prescribed(h, forcing.t, 2 + k);
      }
    }
    result.acceleration[h.dof] = a;
  }

  const ConstraintSolver& solver = *interval_->solver;
  const double* u = x.data() + layout.u();
  const double* v = x.data() + layout.v();
  for (std::size_t j = 0; j < solver.columns().size(); ++j) {
    double b = 0.0;
    for (int k = 0; k < 4; ++k) {
      if (forcing.weight[k] == 0.0) continue;
      const Column& column = solver.columns()[j];
      b += forcing.weight[k] *
           (column_value(column, forcing.t, 2 + k) + 2 * omega_ * column_value(column, forcing.t, 1 + k) +
            omega_ * omega_ * column_value(column, forcing.t, k));
    }
    target_[j] = b - 2 * omega_ * solver.row_times(j, v) - omega_ * omega_ * solver.row_times(j, u);
  }
  solver.solve(rhs_, result.acceleration, target_, result.multipliers);
  if (model_.material.mass == Mass::consistent) ++counters_.mass_solves;
  if (!solver.columns().empty()) ++counters_.constraint_solves;
}

void Physics::fma(double h, std::span<const double> x, std::span<const double> base, const Forcing& forcing,
                  std::span<double> out) {
  evaluate(x, forcing, work_);
  const Layout& layout = model_.layout;
  const Material& material = model_.material;
  const std::size_t part = layout.part;
  const double* v = x.data() + layout.v();
  for (std::size_t i = 0; i < part; ++i) {
    out[layout.u() + i] = base[layout.u() + i] + h * v[i];
    out[layout.v() + i] = base[layout.v() + i] + h * work_.acceleration[i];
  }
  const auto branch = [&](std::size_t offset, double ela, double decay) {
    const double* w = x.data() + offset;
    for (std::size_t i = 0; i < part; ++i) out[offset + i] = base[offset + i] + h * (ela * v[i] - decay * w[i]);
  };
  if (layout.lambda) branch(layout.w_lambda(), material.lambda_ela, material.lambda_rate());
  if (layout.mu) branch(layout.w_mu(), material.mu_ela, material.mu_rate());
}

void Physics::rate(std::span<const double> x, const Evaluation& evaluation, std::span<double> out) const {
  const Layout& layout = model_.layout;
  const Material& material = model_.material;
  const double* v = x.data() + layout.v();
  for (std::size_t i = 0; i < layout.part; ++i) {
    out[layout.u() + i] = v[i];
    out[layout.v() + i] = evaluation.acceleration[i];
  }
  const auto branch = [&](std::size_t offset, double ela, double decay) {
    const double* w = x.data() + offset;
    for (std::size_t i = 0; i < layout.part; ++i) out[offset + i] = ela * v[i] - decay * w[i];
  };
  if (layout.lambda) branch(layout.w_lambda(), material.lambda_ela, material.lambda_rate());
  if (layout.mu) branch(layout.w_mu(), material.mu_ela, material.mu_rate());
}

void Physics::reaction(const Evaluation& evaluation, const Forcing& forcing, Vector& out) const {
  out.resize(evaluation.acceleration.size());
  model_.multiply_mass(evaluation.acceleration.data(), out.data());
  if (model_.layout.lambda) out += evaluation.force_lambda;
  if (model_.layout.mu) out += evaluation.force_mu;
  out -= external_force(forcing);
  std::vector<char> constrained(out.size(), 0);
  for (const HeldDof& h : interval_->eliminated) constrained[h.dof] = 1;
  for (const Column& column : interval_->solver->columns()) {
    for (const auto& [dof, coefficient] : column.entries) constrained[dof] = 1;
  }
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    if (!constrained[i]) out[i] = 0.0;
  }
}

}  // namespace rheo
