#include "shifted_body.hpp"

#include <array>
#include <utility>

namespace rheo {

ShiftedBody::ShiftedBody(const Model& model, double omega) : AssembledBody(model, omega), system_(model) {
  const auto part = static_cast<Eigen::Index>(model.layout.part);
  increment_.setZero(part);
  pull_.assign(2 * model.layout.part, 0.0);
  right_.setZero(part);
  product_.setZero(part);
}

bool ShiftedBody::prepare_shifted(double s) {
  const ShiftedSystem::Found found = system_.prepare(s, interval_->solver);
  if (found == ShiftedSystem::Found::failed) return false;
  if (found == ShiftedSystem::Found::made) ++counters_.factors;
  target_.resize(static_cast<Eigen::Index>(system_.general().size()));
  return true;
}

double ShiftedBody::column_increment(double s, std::size_t column, std::span<const double> x,
                                     const Forcing& forcing) const {
  const ConstraintSolver& solver = *interval_->solver;
  const Layout& layout = model_.layout;
  const double b = column_forcing(solver.columns()[column], forcing);
  const double drift =
      (2.0 * omega_ + omega_ * omega_ * s) * solver.row_times(column, x.data() + layout.v()) +
      omega_ * omega_ * solver.row_times(column, x.data() + layout.u());
  return s * (b - drift) / ((1.0 + omega_ * s) * (1.0 + omega_ * s));
}

void ShiftedBody::solve_shifted(double s, std::span<const double> x, const Forcing& forcing,
                                std::span<double> out) {
  const Layout& layout = model_.layout;
  const auto part = static_cast<Eigen::Index>(layout.part);
  const ConstVectorMap v(x.data() + layout.v(), part);
  ++counters_.force_evaluations;

  // Increments that are told, zero elsewhere.
  bool driven = false;
  increment_.setZero();
  if (interval_->moving) {
    for (const HeldDof& h : interval_->eliminated) {
      double a = 0.0;
      for (int k = 0; k < 4; ++k) {  // b'' is a cubic
        if (forcing.weight[k] != 0.0) a += forcing.weight[k] * prescribed(h, forcing.t, 2 + k);
      }
      increment_[h.dof] = s * a;
    }
    driven = !interval_->eliminated.empty();
  }
  for (const int j : system_.single()) {
    const auto& [dof, coefficient] = interval_->solver->columns()[j].entries.front();
    increment_[dof] = column_increment(s, static_cast<std::size_t>(j), x, forcing) / coefficient;
    driven = true;
  }
  for (std::size_t j = 0; j < system_.general().size(); ++j) {
    target_[static_cast<Eigen::Index>(j)] =
        column_increment(s, static_cast<std::size_t>(system_.general()[j]), x, forcing);
  }

  right_ = forcing.weight[0] * interval_->force;
  if (interval_->force_rate.size() > 0) {
    right_ +=
        (forcing.weight[0] * (forcing.t - interval_->begin) + forcing.weight[1]) * interval_->force_rate;
  }
  std::array<bool, 2> begun{};  // by modulus: something is in its places already
  for (const BranchPart& branch : layout.branches) {
    const double scale = 1.0 / (1.0 + s * branch.rate), ela = branch.ela;
    const std::size_t modulus = branch.modulus == Modulus::lambda ? 0 : 1;
    const bool adds = std::exchange(begun[modulus], true);
    for (std::size_t i = 0; i < layout.part; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      double& p = pull_[4 * (i / 2) + 2 * modulus + i % 2];
      const double w = scale * (x[branch.offset + i] + s * ela * (v[k] + increment_[k]));
      p = adds ? p + w : w;
    }
  }
  const auto pull_parallel = [&](std::size_t modulus, double elastic, double viscous) {
    if (elastic == 0.0 && viscous == 0.0) return;
    const bool adds = begun[modulus];
    const double* u = x.data() + layout.u();
    for (std::size_t i = 0; i < layout.part; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      double& p = pull_[4 * (i / 2) + 2 * modulus + i % 2];
      const double now = v[k] + increment_[k];
      const double w = elastic * (u[i] + s * now) + viscous * now;
      p = adds ? p + w : w;
    }
  };
  pull_parallel(0, model_.material.elastic.lambda, model_.material.viscous.lambda);
  pull_parallel(1, model_.material.elastic.mu, model_.material.viscous.mu);
  system_.subtract_force(pull_, right_);
  right_ *= s;
  if (driven && model_.material.mass == Mass::consistent) {
    model_.multiply_mass(increment_.data(), product_.data());
    right_ -= product_;
  }
  counters_.shifted_solves += system_.solve(right_, increment_, target_);
  if (!system_.general().empty()) ++counters_.constraint_solves;

  VectorMap(out.data() + layout.u(), part) = s * (v + increment_);
  VectorMap(out.data() + layout.v(), part) = increment_;
  for (const BranchPart& branch : layout.branches) {
    const double scale = s / (1.0 + s * branch.rate);
    VectorMap(out.data() + branch.offset, part) =
        scale *
        (branch.ela * (v + increment_) - branch.rate * ConstVectorMap(x.data() + branch.offset, part));
  }
}

}  // namespace rheo
