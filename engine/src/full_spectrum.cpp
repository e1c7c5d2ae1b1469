#include "full_spectrum.hpp"

#include <Eigen/Eigenvalues>

namespace rheo {

std::vector<std::complex<double>> full_spectrum(const Model& model, const ConstraintSolver& solver) {
  const auto size = static_cast<Eigen::Index>(model.layout.part);
  std::vector<Eigen::Index> free;
  for (Eigen::Index dof = 0; dof < size; ++dof) {
    if (solver.is_free(static_cast<std::size_t>(dof))) free.push_back(dof);
  }
  if (free.empty() || free.size() > most_free_dofs) return {};
  const auto n = static_cast<Eigen::Index>(free.size());

  // P M^-1 ela J on the free degrees of freedom, a column at a time.
  const Vector target = Vector::Zero(static_cast<Eigen::Index>(solver.columns().size()));
  Vector multipliers = target, unit(size), acceleration(size);
  const auto product = [&](double lambda, double mu) {
    Eigen::MatrixXd result(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      unit.setZero();
      unit[free[k]] = 1.0;
      acceleration.setZero();
      solver.solve(model.stiffness(lambda, mu, unit), acceleration, target, multipliers);
      for (Eigen::Index i = 0; i < n; ++i) result(i, k) = acceleration[free[i]];
    }
    return result;
  };
  struct Branch {
    Eigen::MatrixXd stiffness;  // over mass [1/s^2]
    double rate = 0.0;
  };
  std::vector<Branch> branches;
  const Material& material = model.material;
  if (model.layout.lambda) branches.push_back({product(material.lambda_ela, 0.0), material.lambda_rate()});
  if (model.layout.mu) branches.push_back({product(0.0, material.mu_ela), material.mu_rate()});
  double squared = 0.0;
  for (const Branch& branch : branches) squared = std::max(squared, branch.stiffness.norm());
  if (squared == 0.0) return {};

  // w in units of ela / omega: off-diagonal blocks of one size lose the least to rounding.
  const double omega = std::sqrt(squared);
  const Eigen::Index parts = 1 + static_cast<Eigen::Index>(branches.size());
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(parts * n, parts * n);
  for (Eigen::Index b = 1; b < parts; ++b) {
    full.block(0, b * n, n, n) = -branches[b - 1].stiffness / omega;
    full.block(b * n, 0, n, n).diagonal().setConstant(omega);
    full.block(b * n, b * n, n, n).diagonal().setConstant(-branches[b - 1].rate);
  }
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(full, false).eigenvalues();
  return {values.begin(), values.end()};
}

}  // namespace rheo
