#include "full_spectrum.hpp"

#include <Eigen/Eigenvalues>

namespace rheo {

std::vector<std::complex<double>> full_spectrum(const Model& model, const ConstraintSolver& solver,
                                                int most) {
  const auto size = static_cast<Eigen::Index>(model.layout.part);
  std::vector<Eigen::Index> free;
  for (Eigen::Index dof = 0; dof < size; ++dof) {
    if (solver.is_free(static_cast<std::size_t>(dof))) free.push_back(dof);
  }
  std::vector<Material> materials;
  std::vector<Moduli> viscous;
  for (const Patch& patch : model.patches) {
    materials.push_back(patch.material);
    viscous.push_back(patch.material.viscous);
  }
  const std::vector<SharedRelaxation> relaxations = relaxations_of(materials);
  const auto n = static_cast<Eigen::Index>(free.size());
  const Eigen::Index parts = 1 + static_cast<Eigen::Index>(relaxations.size());
  if (free.empty() || parts * n > most) return {};

  // P M^-1 (lambda J_lambda + mu J_mu) on the free degrees of freedom, a column at a time.
  const Vector target = Vector::Zero(static_cast<Eigen::Index>(solver.columns().size()));
  Vector multipliers = target, unit(size), acceleration(size);
  const auto product = [&](const std::vector<Moduli>& moduli) {
    Eigen::MatrixXd result(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      unit.setZero();
      unit[free[k]] = 1.0;
      acceleration.setZero();
      solver.solve(model.stiffness(moduli, unit), acceleration, target, multipliers);
      for (Eigen::Index i = 0; i < n; ++i) result(i, k) = acceleration[free[i]];
    }
    return result;
  };
  std::vector<Eigen::MatrixXd> stiffness;  // over mass [1/s^2]
  double squared = 0.0;
  for (const SharedRelaxation& each : relaxations) {
    stiffness.push_back(product(each.moduli));
    squared = std::max(squared, stiffness.back().norm());
  }
  const bool damped = model.has_viscous_part();
  if (squared == 0.0 && !damped) return {};

  // q in units of 1 / omega: off-diagonal blocks of one size lose the least to rounding.
  const double omega = squared > 0.0 ? std::sqrt(squared) : 1.0;
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(parts * n, parts * n);
  if (damped) full.topLeftCorner(n, n) = -product(viscous);
  for (Eigen::Index k = 1; k < parts; ++k) {
    const auto i = static_cast<std::size_t>(k - 1);
    full.block(0, k * n, n, n) = -stiffness[i] / omega;
    full.block(k * n, 0, n, n).diagonal().setConstant(omega);
    full.block(k * n, k * n, n, n).diagonal().setConstant(-relaxations[i].rate);
  }
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(full, false).eigenvalues();
  return {values.begin(), values.end()};
}

}  // namespace rheo
