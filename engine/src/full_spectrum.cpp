#include "full_spectrum.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace rheo {
namespace {

using Real = long double;
using MatrixR = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Symmetric = Eigen::SelfAdjointEigenSolver<MatrixR>;

// Of the largest eigenvalue: by how much QR's rounding may move one, and what no deformation has.
constexpr Real rounding = 1e-17L;
constexpr Real rigid = 1e-16L;
// Of a root's largest row.
constexpr Real no_row = 1e-15L;

// As few rows as there need be for the same root^T root.
MatrixR compressed(const MatrixR& root) {
  if (root.rows() == 0) return root;
  Eigen::ColPivHouseholderQR<MatrixR> qr(root);
  qr.setThreshold(no_row);
  const MatrixR top = qr.matrixR().topRows(qr.rank()).template triangularView<Eigen::Upper>();
  return top * qr.colsPermutation().transpose();
}

// Rows of strains with root^T root = J of a patch, on the degrees of freedom that have a place: e_x + e_y for
// lambda; sqrt(2) e_x, sqrt(2) e_y and g for mu; times sqrt(h T). Not from J, which is added up in double:
// what a sliver's shear has of it may be less than its rounding.
MatrixR strains(const Mesh& mesh, const Patch& patch, Modulus modulus, const std::vector<Eigen::Index>& place,
                Eigen::Index places) {
  const bool is_lambda = modulus == Modulus::lambda;
  const auto count = patch.triangles.empty() ? mesh.triangles.size() : patch.triangles.size();
  MatrixR rows = MatrixR::Zero(static_cast<Eigen::Index>(is_lambda ? count : 3 * count), places);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& triangle =
        mesh.triangles[patch.triangles.empty() ? i : static_cast<std::size_t>(patch.triangles[i])];
    std::array<Real, 3> x{}, y{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2& p = mesh.points[static_cast<std::size_t>(triangle[k])];
      x[k] = p.x, y[k] = p.y;
    }
    const Real doubled = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    const Real size = std::sqrt(static_cast<Real>(mesh.thickness_of(triangle)) * doubled / 2) / doubled;
    for (std::size_t k = 0; k < 3; ++k) {
      const Real b = size * (y[(k + 1) % 3] - y[(k + 2) % 3]), c = size * (x[(k + 2) % 3] - x[(k + 1) % 3]);
      const auto add = [&](Eigen::Index which, std::size_t axis, Real value) {
        const Eigen::Index at = place[2 * static_cast<std::size_t>(triangle[k]) + axis];
        if (at >= 0) rows(row + which, at) += value;
      };
      if (is_lambda) {
        add(0, 0, b), add(0, 1, c);
      } else {
        add(0, 0, std::sqrt(Real{2}) * b), add(1, 1, std::sqrt(Real{2}) * c);
        add(2, 0, c), add(2, 1, b);
      }
    }
    row += is_lambda ? 1 : 3;
  }
  return rows;
}

// J^1/2 of each region and modulus apart. Their sums are never made: lambda may be 1e8 times mu, and the
// small stiffness of a shear beside it would be rounding.
struct Roots {
  std::vector<MatrixR> lambda, mu;  // by region

  // Rows with root^T root = sum of moduli times J, as few as that takes.
  MatrixR of(const std::vector<Moduli>& moduli) const {
    Eigen::Index rows = 0;
    const auto each = [&](const auto& visit) {
      for (std::size_t r = 0; r < moduli.size(); ++r) {
        if (moduli[r].lambda > 0.0) visit(moduli[r].lambda, lambda[r]);
        if (moduli[r].mu > 0.0) visit(moduli[r].mu, mu[r]);
      }
    };
    each([&](double, const MatrixR& root) { rows += root.rows(); });
    MatrixR all(rows, lambda[0].cols());
    Eigen::Index at = 0;
    each([&](double modulus, const MatrixR& root) {
      all.middleRows(at, root.rows()) = std::sqrt(static_cast<Real>(modulus)) * root;
      at += root.rows();
    });
    return compressed(all);
  }
};

// About the rank of a rate's stiffness on n degrees of freedom: in a region that is not all of the body,
// three strains a triangle, or one where lambda's springs are alone; small meshes have half as many triangles
// as degrees of freedom.
Eigen::Index expected_rows(const Model& model, const std::vector<Moduli>& moduli, Eigen::Index n) {
  if (!model.has_several_materials()) return moduli[0].mu > 0.0 ? n : n / 2;
  Eigen::Index rows = 0;
  for (std::size_t r = 0; r < model.patches.size(); ++r) {
    const auto triangles = static_cast<Eigen::Index>(model.patches[r].triangles.size());
    if (moduli[r].mu > 0.0)
      rows += 3 * triangles;
    else if (moduli[r].lambda > 0.0)
      rows += triangles;
  }
  return std::min(n, rows);
}

// Spans, in x = M^1/2 v, what the columns leave free: (M^-1/2 a)^T x = 0 for each.
MatrixR free_directions(const MatrixR& unroot, const MatrixR& columns) {
  if (columns.cols() == 0) return MatrixR::Identity(unroot.rows(), unroot.rows());
  MatrixR scaled = unroot * columns;
  for (Eigen::Index k = 0; k < scaled.cols(); ++k) scaled.col(k).normalize();
  const Eigen::ColPivHouseholderQR<MatrixR> qr(scaled);
  const MatrixR q = qr.householderQ();
  return q.rightCols(unroot.rows() - qr.rank());
}

}  // namespace

std::optional<std::vector<std::complex<double>>> full_spectrum(const Mesh& mesh, const Model& model,
                                                               const ConstraintSolver& solver, int most) {
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
  // (No constraint depends on others, or the solver would have refused it.)
  const Eigen::Index directions = n - static_cast<Eigen::Index>(solver.columns().size());
  if (directions <= 0) return std::vector<std::complex<double>>();
  Eigen::Index expected = directions;
  for (const SharedRelaxation& each : relaxations) expected += expected_rows(model, each.moduli, directions);
  if (expected > most) return std::nullopt;

  std::vector<Eigen::Index> place(static_cast<std::size_t>(size), -1);
  for (Eigen::Index i = 0; i < n; ++i) place[static_cast<std::size_t>(free[i])] = i;
  MatrixR columns = MatrixR::Zero(n, static_cast<Eigen::Index>(solver.columns().size()));
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    for (const auto& [dof, coefficient] : solver.columns()[static_cast<std::size_t>(k)].entries)
      if (place[dof] >= 0) columns(place[dof], k) = coefficient;
  }
  Vector unit(size), image(size);
  MatrixR mass_matrix(n, n);  // a column at a time
  for (Eigen::Index k = 0; k < n; ++k) {
    unit.setZero();
    unit[free[k]] = 1.0;
    model.multiply_mass(unit.data(), image.data());
    for (Eigen::Index i = 0; i < n; ++i) mass_matrix(i, k) = image[free[i]];
  }
  const Symmetric mass(MatrixR((mass_matrix + mass_matrix.transpose()) / 2));
  if (mass.info() != Eigen::Success) return std::nullopt;
  const MatrixR unroot = mass.operatorInverseSqrt();
  const MatrixR to_v = unroot * free_directions(unroot, columns);
  Roots roots;
  for (const Patch& patch : model.patches) {
    roots.lambda.push_back(compressed(strains(mesh, patch, Modulus::lambda, place, n) * to_v));
    roots.mu.push_back(compressed(strains(mesh, patch, Modulus::mu, place, n) * to_v));
  }
  std::vector<MatrixR> couplings;
  Eigen::Index all = to_v.cols();
  for (const SharedRelaxation& each : relaxations) {
    couplings.push_back(roots.of(each.moduli));
    all += couplings.back().rows();
  }
  const bool damped = model.has_viscous_part();
  if (all > most || all == 0 || (all == to_v.cols() && !damped)) return std::nullopt;

  MatrixR full = MatrixR::Zero(all, all);
  if (damped) {
    const MatrixR dashpots = roots.of(viscous);
    full.topLeftCorner(to_v.cols(), to_v.cols()) = -dashpots.transpose() * dashpots;
  }
  Eigen::Index at = to_v.cols();
  for (std::size_t k = 0; k < couplings.size(); ++k) {
    const Eigen::Index rows = couplings[k].rows();
    full.block(at, 0, rows, to_v.cols()) = couplings[k];
    full.block(0, at, to_v.cols(), rows) = -couplings[k].transpose();
    full.block(at, at, rows, rows).diagonal().setConstant(-static_cast<Real>(relaxations[k].rate));
    at += rows;
  }
  const Eigen::EigenSolver<MatrixR> solved(full, false);
  if (solved.info() != Eigen::Success) return std::nullopt;
  const auto& found = solved.eigenvalues();
  const Real largest = found.cwiseAbs().maxCoeff();
  std::vector<std::complex<double>> values;
  for (const std::complex<Real>& s : found) {
    if (std::abs(s) <= rigid * largest) continue;
    values.emplace_back(static_cast<double>(std::min(s.real() + rounding * largest, Real{0})),
                        static_cast<double>(s.imag()));
  }
  return values;
}

}  // namespace rheo
