#include "shifted_body.hpp"

#include <array>
#include <utility>

namespace rheo {

ShiftedBody::ShiftedBody(const Model& model, double omega) : AssembledBody(model, omega), system_(model) {
  const auto part = static_cast<Eigen::Index>(model.layout.part);
  increment_.setZero(part);
  for (const Patch& patch : model.patches) pull_.emplace_back(2 * patch.part, 0.0);
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

void ShiftedBody::find_pull(double s, std::span<const double> x) {
  const Layout& layout = model_.layout;
  const double *u = x.data() + layout.u(), *v = x.data() + layout.v();
  for (std::size_t r = 0; r < pull_.size(); ++r) {
    const Patch& patch = model_.patches[r];
    std::vector<double>& pull = pull_[r];
    std::array<bool, 2> begun{};  // by modulus: something is in its places already
    // value(i, j) of entry i of the patch, j of the mesh
    const auto add = [&](std::size_t modulus, const auto& value) {
      const bool adds = std::exchange(begun[modulus], true);
      patch.for_each_dof([&](std::size_t i, std::size_t j) {
        double& p = pull[4 * (i / 2) + 2 * modulus + i % 2];
        const double w = value(i, j);
        p = adds ? p + w : w;
      });
    };
    for (const BranchPart& branch : layout.branches) {
      if (branch.region != r) continue;
      const double scale = 1.0 / (1.0 + s * branch.rate), ela = branch.ela;
      const double* w = x.data() + branch.offset;
      add(branch.modulus == Modulus::lambda ? 0 : 1, [&](std::size_t i, std::size_t j) {
        return scale * (w[i] + s * ela * (v[j] + increment_[static_cast<Eigen::Index>(j)]));
      });
    }
    const auto add_parallel = [&](std::size_t modulus, double elastic, double viscous) {
      if (elastic == 0.0 && viscous == 0.0) return;
      add(modulus, [&](std::size_t, std::size_t j) {
        const double now = v[j] + increment_[static_cast<Eigen::Index>(j)];
        return elastic * (u[j] + s * now) + viscous * now;
      });
    };
    add_parallel(0, patch.material.elastic.lambda, patch.material.viscous.lambda);
    add_parallel(1, patch.material.elastic.mu, patch.material.viscous.mu);
  }
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
  find_pull(s, x);
  for (std::size_t r = 0; r < pull_.size(); ++r) system_.subtract_force(r, pull_[r], right_);
  right_ *= s;
  if (driven && !model_.is_lumped()) {
    model_.multiply_mass(increment_.data(), product_.data());
    right_ -= product_;
  }
  counters_.shifted_solves += system_.solve(right_, increment_, target_);
  if (!system_.general().empty()) ++counters_.constraint_solves;

  VectorMap(out.data() + layout.u(), part) = s * (v + increment_);
  VectorMap(out.data() + layout.v(), part) = increment_;
  for (const BranchPart& branch : layout.branches) {
    const double scale = s / (1.0 + s * branch.rate);
    const double ela = branch.ela, rate = branch.rate;
    const double* w = x.data() + branch.offset;
    double* d = out.data() + branch.offset;
    model_.patches[branch.region].for_each_dof([&](std::size_t i, std::size_t j) {
      const auto k = static_cast<Eigen::Index>(j);
      d[i] = scale * (ela * (v[k] + increment_[k]) - rate * w[i]);
    });
  }
}

}  // namespace rheo
