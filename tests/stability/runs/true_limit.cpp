#include "stability/runs/true_limit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <complex>
#include <limits>
#include <vector>

#include "rheo/stability.hpp"
#include "support/exact.hpp"

namespace rheo::test {
namespace {

using Real = long double;
using MatrixR = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Symmetric = Eigen::SelfAdjointEigenSolver<MatrixR>;

// Springs of one relaxation rate: z' = coupling x - rate z.
struct Branch {
  MatrixR coupling;
  Real rate;
};

struct Operator {
  Eigen::Index free = 0;
  MatrixR damping;  // of x
  std::vector<Branch> branches;
  std::vector<Real> rates;  // of residual forces that pull at nothing
};

// One a constraint: those of nodes and the general ones.
MatrixR constraint_columns(const Scene& scene, Eigen::Index size) {
  std::vector<Eigen::VectorXd> columns;
  std::vector<char> held(static_cast<std::size_t>(size), 0);
  for (const Fix& fix : scene.fixes) {
    for (const int node : fix.nodes) {
      for (int k = 0; k < 2; ++k) {
        const auto dof = static_cast<std::size_t>(2 * node + k);
        if (fix.axis == (k == 0 ? Axis::y : Axis::x) || held[dof]) continue;
        held[dof] = 1;
        columns.push_back(Eigen::VectorXd::Unit(size, static_cast<Eigen::Index>(dof)));
      }
    }
  }
  for (const Constraint& c : scene.constraints) {
    Eigen::VectorXd a = Eigen::VectorXd::Zero(size);
    for (const ConstraintTerm& term : c.terms) a[2 * term.node + (term.axis == Axis::y)] += term.coefficient;
    columns.push_back(a);
  }
  MatrixR all(size, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k)
    all.col(static_cast<Eigen::Index>(k)) = columns[k].cast<Real>();
  return all;
}

// J^1/2 by the strains of each triangle, J = sum of A t e^T e: exact but for long double's rounding, where a
// sum made in double and its root are not. As few rows as have its rank.
MatrixR root_of(const Mesh& mesh, bool is_lambda) {
  MatrixR strains = MatrixR::Zero(3 * mesh.triangle_count(), 2 * mesh.node_count());
  Eigen::Index row = 0;
  for (const auto& triangle : mesh.triangles) {
    std::array<Real, 3> x{}, y{};
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = mesh.points[static_cast<std::size_t>(triangle[k])].x;
      y[k] = mesh.points[static_cast<std::size_t>(triangle[k])].y;
    }
    const Real doubled = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    const Real size = std::sqrt(doubled / 2 * static_cast<Real>(mesh.thickness)),
               twice = std::sqrt(Real{2}) * size;
    for (std::size_t k = 0; k < 3; ++k) {
      const Real b = (y[(k + 1) % 3] - y[(k + 2) % 3]) / doubled,
                 c = (x[(k + 2) % 3] - x[(k + 1) % 3]) / doubled;
      const Eigen::Index u = 2 * triangle[k], v = u + 1;
      if (is_lambda) {
        strains(row, u) = size * b, strains(row, v) = size * c;
      } else {
        strains(row, u) = twice * b, strains(row + 1, v) = twice * c;
        strains(row + 2, u) = size * c, strains(row + 2, v) = size * b;
      }
    }
    row += is_lambda ? 1 : 3;
  }
  Eigen::ColPivHouseholderQR<MatrixR> qr(strains.topRows(row));
  qr.setThreshold(1e-15L);
  const MatrixR top = qr.matrixR().topRows(qr.rank()).template triangularView<Eigen::Upper>();
  return top * qr.colsPermutation().transpose();
}

Operator operator_of(const Scene& scene) {
  std::vector<DenseMatrices> by_region;
  std::vector<Mesh> parts;
  for (std::size_t r = 0; r <= scene.regions.size(); ++r) {
    Mesh part = scene.mesh;
    part.triangles.clear();
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      const std::size_t of =
          scene.region_of_triangle.empty() ? 0 : static_cast<std::size_t>(scene.region_of_triangle[t]);
      if (of == r) part.triangles.push_back(scene.mesh.triangles[t]);
    }
    by_region.push_back(dense_matrices(part, material_of(scene, r)));
    parts.push_back(std::move(part));
  }
  Eigen::MatrixXd mass = by_region[0].mass;
  for (std::size_t r = 1; r < by_region.size(); ++r) mass += by_region[r].mass;
  const Symmetric weight(mass.cast<Real>());
  const MatrixR unroot = weight.operatorInverseSqrt();

  // The free directions are those that the projection by the constraints keeps.
  MatrixR a = unroot * constraint_columns(scene, mass.rows());
  for (Eigen::Index k = 0; k < a.cols(); ++k) a.col(k).normalize();
  MatrixR z = MatrixR::Identity(mass.rows(), mass.rows());
  if (a.cols() > 0) {
    const Eigen::ColPivHouseholderQR<MatrixR> qr(a);
    const MatrixR q = qr.householderQ();
    z = q.rightCols(mass.rows() - qr.rank());
  }
  const MatrixR to_v = unroot * z;

  Operator op;
  op.free = z.cols();
  op.damping = MatrixR::Zero(op.free, op.free);
  for (std::size_t r = 0; r < by_region.size(); ++r) {
    const Material& material = material_of(scene, r);
    for (const bool is_lambda : {true, false}) {
      if (parts[r].triangles.empty()) continue;
      const MatrixR root = root_of(parts[r], is_lambda) * to_v;
      const auto add = [&](double ela, double rate) {
        if (ela > 0.0) op.branches.push_back({std::sqrt(static_cast<Real>(ela)) * root, rate});
      };
      for (std::size_t k = 0; k < material.branch_count(); ++k) {
        const MaxwellBranch b = material.branch(k);
        const double ela = is_lambda ? b.lambda_ela : b.mu_ela;
        const double rate = is_lambda ? b.lambda_rate() : b.mu_rate();
        add(ela, rate);
        if (ela > 0.0 && rate > 0.0) op.rates.push_back(rate);
      }
      add(is_lambda ? material.elastic.lambda : material.elastic.mu, 0.0);
      const double viscous = is_lambda ? material.viscous.lambda : material.viscous.mu;
      if (viscous > 0.0) op.damping += static_cast<Real>(viscous) * (root.transpose() * root);
    }
  }
  return op;
}

std::vector<std::complex<Real>> eigenvalues_of(const Operator& op) {
  Eigen::Index size = op.free;
  for (const Branch& b : op.branches) size += b.coupling.rows();
  MatrixR full = MatrixR::Zero(size, size);
  full.topLeftCorner(op.free, op.free) = -op.damping;
  Eigen::Index at = op.free;
  for (const Branch& b : op.branches) {
    const Eigen::Index rows = b.coupling.rows();
    full.block(at, 0, rows, op.free) = b.coupling;
    full.block(0, at, op.free, rows) = -b.coupling.transpose();
    full.block(at, at, rows, rows).diagonal().setConstant(-b.rate);
    at += rows;
  }
  if (size == 0) return {};
  const auto values = Eigen::EigenSolver<MatrixR>(full, false).eigenvalues();
  return {values.begin(), values.end()};
}

}  // namespace

TrueSpectrum::TrueSpectrum(const Scene& scene) {
  const Operator op = operator_of(scene);
  values_ = eigenvalues_of(op);
  Real largest = 0.0L;
  for (const auto& s : values_) largest = std::max(largest, std::abs(s));
  for (const Real rate : op.rates) {
    largest = std::max(largest, rate);
    rates_.push_back(static_cast<double>(rate));
  }
  moved_ = 1e-17L * largest;
  // Held degrees of freedom are eliminated unless asked otherwise; a general constraint brings its own pole.
  const bool columns = !scene.constraints.empty() ||
                       (scene.time.constraints == ConstraintMethod::baumgarte && !scene.fixes.empty());
  if (columns && scene.time.baumgarte > 0.0) rates_.push_back(scene.time.baumgarte);
}

TrueLimit TrueSpectrum::limit(IntegratorKind integrator) const {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  TrueLimit limit{infinite, infinite};
  for (const auto& s : values_) {
    if (std::abs(s) <= 10 * moved_) continue;  // rigid motion
    const auto with = [&](Real shift) {
      return stable_step_of(
          {static_cast<double>(std::min(s.real() + shift, 0.0L)), static_cast<double>(s.imag())}, integrator);
    };
    limit.low = std::min({limit.low, with(moved_), with(-moved_)});
    limit.high = std::min(limit.high, std::max(with(moved_), with(-moved_)));
  }
  for (const double rate : rates_) {
    limit.low = std::min(limit.low, stable_step_of(-rate, integrator));
    limit.high = std::min(limit.high, stable_step_of(-rate, integrator));
  }
  return limit;
}

std::vector<std::complex<double>> TrueSpectrum::values() const {
  std::vector<std::complex<double>> result;
  for (const auto& s : values_) {
    if (std::abs(s) > 10 * moved_)
      result.emplace_back(static_cast<double>(s.real()), static_cast<double>(s.imag()));
  }
  return result;
}

TrueLimit true_limit(const Scene& scene, IntegratorKind integrator) {
  return TrueSpectrum(scene).limit(integrator);
}

}  // namespace rheo::test
