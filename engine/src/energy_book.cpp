#include "energy_book.hpp"

#include <cmath>

namespace rheo {
namespace {

ConstVectorMap part(const Layout& layout, std::span<const double> y, std::size_t offset) {
  return {y.data() + offset, static_cast<Eigen::Index>(layout.part)};
}

}  // namespace

EnergyBook::EnergyBook(const Model& model, Physics& physics) : model_(model), physics_(physics) {
  momentum_.setZero(static_cast<Eigen::Index>(model.layout.part));
}

Powers EnergyBook::powers(std::span<const double> y, std::span<const double> rate, const Evaluation& evaluation,
                          double t) {
  const Layout& layout = model_.layout;
  const Material& material = model_.material;
  Powers p;
  const auto branch = [&](std::size_t offset, const Vector& force, double vis) {
    if (std::isinf(vis)) return;
    p.dissipated += part(layout, y, offset).dot(force) / vis;
    p.dissipated_rate += 2.0 * part(layout, rate, offset).dot(force) / vis;
  };
  if (layout.lambda) branch(layout.w_lambda(), evaluation.force_lambda, material.lambda_vis);
  if (layout.mu) branch(layout.w_mu(), evaluation.force_mu, material.mu_vis);

  const auto u = part(layout, y, layout.u());
  const auto v = part(layout, y, layout.v());
  const auto a = part(layout, rate, layout.v());
  const Interval& interval = physics_.interval();
  const Forcing now{t, {1.0, 0.0, 0.0, 0.0}};
  const Forcing slope{t, {0.0, 1.0, 0.0, 0.0}};
  p.load = interval.force.dot(u);
  if (interval.force_rate.size() > 0) {
    p.load_slope = interval.force_rate.dot(u);
    p.load_slope_rate = interval.force_rate.dot(v);
    p.load += (t - interval.begin) * p.load_slope;
    p.load_power = (t - interval.begin) * p.load_slope_rate;
  }
  p.load_power += interval.force.dot(v);
  // Constraints work only where what they hold moves (general ones: by their drift). The reaction's slope is the
  // reaction of the operator's derivative, A y' + g'.
  if (interval.moving || !interval.solver->columns().empty()) {
    physics_.reaction(evaluation, now, reaction_);
    physics_.evaluate(rate, slope, derivative_);
    physics_.reaction(derivative_, slope, reaction_rate_);
    p.constraints = reaction_.dot(v);
    p.constraints_rate = reaction_rate_.dot(v) + reaction_.dot(a);
  }
  return p;
}

void EnergyBook::book_step(const Powers& before, const Powers& after, double h) {
  const auto integral = [h](double p0, double p1, double rate0, double rate1) {
    return h / 2 * (p0 + p1) + h * h / 12 * (rate0 - rate1);
  };
  dissipated_ += integral(before.dissipated, after.dissipated, before.dissipated_rate, after.dissipated_rate);
  const double loads = after.load - before.load - integral(before.load_slope, after.load_slope,
                                                           before.load_slope_rate, after.load_slope_rate);
  work_ += loads + integral(before.constraints, after.constraints, before.constraints_rate, after.constraints_rate);
  // Euler moves a step late: the load's power at both ends belongs to the scale although not to the work.
  turnover_ += std::abs(loads) + h * (std::abs(before.load_power) + std::abs(after.load_power)) +
               integral(std::abs(before.constraints), std::abs(after.constraints),
                                          std::abs(before.constraints_rate), -std::abs(after.constraints_rate));
}

void EnergyBook::book_impulse(double work) {
  work_ += work;
  turnover_ += std::abs(work);
}

double EnergyBook::kinetic(std::span<const double> y) const {
  const double* v = y.data() + model_.layout.v();
  model_.multiply_mass(v, momentum_.data());
  return 0.5 * part(model_.layout, y, model_.layout.v()).dot(momentum_);
}

double EnergyBook::stored(std::span<const double> y, const Evaluation& evaluation) const {
  const Layout& layout = model_.layout;
  double energy = 0.0;
  if (layout.lambda) {
    energy += 0.5 * part(layout, y, layout.w_lambda()).dot(evaluation.force_lambda) / model_.material.lambda_ela;
  }
  if (layout.mu) energy += 0.5 * part(layout, y, layout.w_mu()).dot(evaluation.force_mu) / model_.material.mu_ela;
  return energy;
}

}  // namespace rheo
