#include "lanczos.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace rheo {
namespace {

// Residual of the squared frequency at which to stop: half of it remains in the frequency.
constexpr double wanted_residual = 0.01;
constexpr double exhausted = 1e-6;  // of the largest diagonal entry
constexpr int most_steps = 400;
constexpr int fewest_steps = 16;  // before this a Ritz value may sit on a lower eigenvalue by chance

// Numbers in [-1, 1) that are the same everywhere (splitmix64).
double pseudo_random(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>(static_cast<std::int64_t>(z ^ (z >> 31))) * 0x1p-63;
}

struct RitzPair {
  double value = 0.0;
  double last = 0.0;  // size of the vector's last component
};

// Largest eigenvalue of a tridiagonal matrix without negative ones.
RitzPair largest_pair(const Eigen::Ref<const Vector>& diagonal, const Eigen::Ref<const Vector>& off) {
  const Eigen::Index k = diagonal.size();
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, off);
  if (solver.info() == Eigen::Success)
    return {solver.eigenvalues()[k - 1], std::abs(solver.eigenvectors()(k - 1, k - 1))};
  // QR iteration does not always end where the entries span many decades, and leaves the values unsorted.
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(k, k);
  dense.diagonal() = diagonal;
  if (k > 1) dense.diagonal<1>() = dense.diagonal<-1>() = off;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(dense, Eigen::ComputeFullU);
  return {svd.singularValues()[0], std::abs(svd.matrixU()(k - 1, 0))};
}

}  // namespace

RitzBound largest_frequency(const Model& model, const ConstraintSolver& solver,
                            const std::vector<Moduli>& moduli) {
  const auto size = static_cast<Eigen::Index>(model.layout.part);
  std::size_t free = 0;
  for (std::size_t dof = 0; dof < model.layout.part; ++dof) free += solver.is_free(dof) ? 1 : 0;
  if (free <= solver.columns().size()) return {};  // what a projection leaves is rounding
  const Vector target = Vector::Zero(static_cast<Eigen::Index>(solver.columns().size()));
  Vector multipliers = target;
  Vector mass_times(size);
  const auto project = [&](const Vector& r, Vector& out) {
    out.setZero(size);
    solver.solve(r, out, target, multipliers);
  };
  const auto norm = [&](const Vector& x) {
    model.multiply_mass(x.data(), mass_times.data());
    return std::sqrt(x.dot(mass_times));
  };

  // M q with as much of q at each node, in the norm of M, be it ever so light: the fastest modes live on the
  // smallest triangles, and what the start hardly has may be taken for exhausted.
  Vector start(size);
  std::uint64_t seed = 1;
  for (Eigen::Index i = 0; i < size; ++i) {
    start[i] = solver.is_free(static_cast<std::size_t>(i))
                   ? pseudo_random(seed) * std::sqrt(model.node_mass[i / 2])
                   : 0.0;
  }
  Vector q(size), previous = Vector::Zero(size), next(size);
  project(start, q);
  double beta = norm(q);
  RitzBound result;
  if (!(beta > 0.0)) return result;
  q /= beta;
  beta = 0.0;

  std::vector<double> alphas, betas;
  for (int k = 1; k <= most_steps; ++k) {
    project(model.stiffness(moduli, q), next);
    model.multiply_mass(q.data(), mass_times.data());
    const double alpha = next.dot(mass_times);
    next -= alpha * q + beta * previous;
    alphas.push_back(alpha);
    beta = norm(next);
    result.steps = k;

    double largest = 0.0;
    for (double a : alphas) largest = std::max(largest, std::abs(a));
    // The start's whole subspace is found, but for a residual that no longer counts. (Going on would be along
    // rounding, which the constraints do not hold.)
    const bool invariant = !(beta > exhausted * largest);
    if (invariant || k == most_steps || (k >= fewest_steps && k % 4 == 0)) {
      const Eigen::Map<const Vector> diagonal(alphas.data(), k);
      const Eigen::Map<const Vector> off(betas.data(), k - 1);
      const RitzPair ritz = largest_pair(diagonal, off);
      const double theta = std::max(0.0, ritz.value);
      const double residual = 1e-12 * theta + beta * ritz.last;
      result.omega = std::sqrt(theta + residual);
      if (invariant || residual <= wanted_residual * theta) break;
    }
    betas.push_back(beta);
    previous = q;
    q = next / beta;
  }
  return result;
}

}  // namespace rheo
