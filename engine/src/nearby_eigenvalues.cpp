#include "nearby_eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "complex_symmetric.hpp"
#include "pseudo_random.hpp"
#include "regions.hpp"
#include "rheo/memory_limit.hpp"

namespace rheo {
namespace {

// Of a basis: about a third of its vectors make eigenvalues, and it takes their square of time.
constexpr Eigen::Index first_vectors = 45, more_vectors = 40, most_vectors = 300;
constexpr double most_numbers = 3.2e7;  // of a basis: 500 MB
// Residual of (operator - c)^-1, of its eigenvalue.
constexpr double converged = 1e-6;
// How far a disc reaches, of the distance of the outermost eigenvalue that has converged, as all nearer ones
// have further, and of the nearest that has not: one at half its distance would outgrow it with every vector.
constexpr double reach = 0.9, empty_reach = 0.5;
constexpr double rounding_without_pivots = 1e-13;  // of the matrix: more asks for pivots

// How many of shifts and small turns hold what is held.
int rigid_motions(const Mesh& mesh, const ConstraintSolver& solver) {
  Vec2 middle{}, low = mesh.points[0], high = low;
  for (const Vec2& p : mesh.points) {
    middle.x += p.x / static_cast<double>(mesh.points.size());
    middle.y += p.y / static_cast<double>(mesh.points.size());
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double size = std::max(high.x - low.x, high.y - low.y);
  const auto motion = [&](std::size_t dof) {
    const Vec2& p = mesh.points[dof / 2];
    return dof % 2 == 0 ? Eigen::Vector3d(1.0, 0.0, (middle.y - p.y) / size)
                        : Eigen::Vector3d(0.0, 1.0, (p.x - middle.x) / size);
  };
  Eigen::Matrix3d held = Eigen::Matrix3d::Zero();
  for (std::size_t dof = 0; dof < 2 * mesh.points.size(); ++dof)
    if (!solver.is_free(dof)) held += motion(dof) * motion(dof).transpose();
  for (const Column& column : solver.columns()) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double square = 0.0;
    for (const auto& [dof, coefficient] : column.entries) {
      sum += coefficient * motion(static_cast<std::size_t>(dof));
      square += coefficient * coefficient;
    }
    held += sum * sum.transpose() / square;
  }
  const Eigen::Vector3d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(held).eigenvalues();
  // (One that is only nearly held counts as held: then less is known.)
  return static_cast<int>((values.array() <= 1e-14 * std::max(1.0, values[2])).count());
}

// [T, t A; t A^T, -f t], t the largest entry of T.
template <class Scalar>
Eigen::SparseMatrix<Scalar> bordered(const Eigen::SparseMatrix<Scalar>& matrix,
                                     const Eigen::SparseMatrix<double>& columns, double f) {
  std::vector<Eigen::Triplet<Scalar>> entries;
  double largest = 0.0;
  for (Eigen::Index j = 0; j < matrix.outerSize(); ++j)
    for (typename Eigen::SparseMatrix<Scalar>::InnerIterator it(matrix, j); it; ++it) {
      entries.emplace_back(it.row(), it.col(), it.value());
      largest = std::max(largest, std::abs(it.value()));
    }
  const Eigen::Index n = matrix.rows();
  for (Eigen::Index j = 0; j < columns.outerSize(); ++j) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(columns, j); it; ++it) {
      entries.emplace_back(it.row(), n + j, largest * it.value());
      entries.emplace_back(n + j, it.row(), largest * it.value());
    }
    if (f > 0.0) entries.emplace_back(n + j, n + j, -f * largest);
  }
  Eigen::SparseMatrix<Scalar> result(n + columns.cols(), n + columns.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

// Of a column's entries: a norm of a symmetric matrix.
double largest_sum(const Eigen::SparseMatrix<std::complex<double>>& matrix) {
  double largest = 0.0;
  for (Eigen::Index j = 0; j < matrix.outerSize(); ++j) {
    double sum = 0.0;
    for (Eigen::SparseMatrix<std::complex<double>>::InnerIterator it(matrix, j); it; ++it)
      sum += std::abs(it.value());
    largest = std::max(largest, sum);
  }
  return largest;
}

}  // namespace

bool NearbyEigenvalues::can_take(const Model& model, double memory) {
  std::vector<Material> materials;
  for (const Patch& patch : model.patches) materials.push_back(patch.material);
  const auto part = static_cast<double>(model.layout.part);
  const double size = part * static_cast<double>(1 + relaxations_of(materials).size());
  // Of a factor: as memory_need.hpp has it for a real one.
  const double factor = 1.7 * 135.0 * std::log2(part) * part / 2.0;
  const double bytes = 16.0 * std::min(most_numbers, size * static_cast<double>(most_vectors)) + factor;
  return size * static_cast<double>(first_vectors) <= most_numbers &&
         bytes <= 0.5 * memory_limit(memory).bytes;
}

NearbyEigenvalues::NearbyEigenvalues(const Mesh& mesh, const Model& model, const ConstraintSolver& solver) {
  const std::size_t size = model.layout.part;
  std::vector<Eigen::Index> place(size, -1);
  std::vector<double> unroot(size, 0.0);  // M^-1/2, of the nodes' masses: vectors have energies as lengths
  for (std::size_t dof = 0; dof < size; ++dof) {
    if (!solver.is_free(dof)) continue;
    place[dof] = n_++;
    unroot[dof] = 1.0 / std::sqrt(model.node_mass[static_cast<Eigen::Index>(dof / 2)]);
  }
  using Entries = std::vector<Eigen::Triplet<double>>;
  const auto add = [&](Entries& entries, std::size_t i, std::size_t j, double value) {
    if (place[i] >= 0 && place[j] >= 0)
      entries.emplace_back(place[i], place[j], unroot[i] * unroot[j] * value);
  };
  const auto matrix = [&](const Entries& entries) {
    Matrix result(n_, n_);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  };
  rigid_ = rigid_motions(mesh, solver);
  Entries mass;
  for (std::size_t dof = 0; dof < size; ++dof) {
    if (model.is_lumped()) {
      add(mass, dof, dof, model.node_mass[static_cast<Eigen::Index>(dof / 2)]);
      continue;
    }
    for (SparseMatrix::InnerIterator it(model.mass, static_cast<Eigen::Index>(dof / 2)); it; ++it)
      add(mass, dof, 2 * static_cast<std::size_t>(it.col()) + dof % 2, it.value());
  }
  mass_ = matrix(mass);

  const auto stiffness = [&](const std::vector<Moduli>& moduli) {
    Entries entries;
    for (std::size_t r = 0; r < model.patches.size(); ++r) {
      const Patch& patch = model.patches[r];
      std::vector<std::size_t> dof(patch.part);
      patch.for_each_dof([&](std::size_t i, std::size_t j) { dof[i] = j; });
      for (const Modulus modulus : {Modulus::lambda, Modulus::mu}) {
        const double factor = modulus == Modulus::lambda ? moduli[r].lambda : moduli[r].mu;
        if (!(factor > 0.0)) continue;
        const SparseMatrix& j = patch.j(modulus);
        for (Eigen::Index row = 0; row < j.rows(); ++row)
          for (SparseMatrix::InnerIterator it(j, row); it; ++it)
            add(entries, dof[static_cast<std::size_t>(row)], dof[static_cast<std::size_t>(it.col())],
                factor * it.value());
      }
    }
    return matrix(entries);
  };
  std::vector<Material> materials;
  std::vector<Moduli> viscous;
  for (const Patch& patch : model.patches) {
    materials.push_back(patch.material);
    viscous.push_back(patch.material.viscous);
  }
  dashpots_ = stiffness(viscous);
  for (const SharedRelaxation& each : relaxations_of(materials)) {
    springs_.push_back(stiffness(each.moduli));
    rates_.push_back(each.rate);
  }
  Entries columns;
  for (std::size_t k = 0; k < solver.columns().size(); ++k) {
    double square = 0.0;
    for (const auto& [dof, coefficient] : solver.columns()[k].entries) {
      const auto i = static_cast<std::size_t>(dof);
      if (place[i] >= 0) square += std::pow(unroot[i] * coefficient, 2);
    }
    for (const auto& [dof, coefficient] : solver.columns()[k].entries) {
      const auto i = static_cast<std::size_t>(dof);
      if (place[i] >= 0)
        columns.emplace_back(place[i], static_cast<Eigen::Index>(k),
                             unroot[i] * coefficient / std::sqrt(square));
    }
  }
  columns_.resize(n_, static_cast<Eigen::Index>(solver.columns().size()));
  columns_.setFromTriplets(columns.begin(), columns.end());
}

// (operator - c)^-1 on vectors (v, |c| u_1, |c| u_2, ...).
class NearbyEigenvalues::Shifted {
 public:
  Shifted(const NearbyEigenvalues& parts, Complex c) : parts_(parts), size_(std::abs(c)), c_(c) {
    ComplexMatrix t = c * parts.mass_.cast<Complex>() + parts.dashpots_.cast<Complex>();
    for (std::size_t k = 0; k < parts.springs_.size(); ++k)
      t += ComplexMatrix(parts.springs_[k].cast<Complex>() * factor(k));
    if (parts.columns_.cols() > 0) t = bordered(t, parts.columns_, 0.0);
    t.makeCompressed();
    // Without pivots: far less fill, and hardly ever more rounding.
    ldlt_.compute(t.unaryExpr([](const Complex& z) { return SymmetricScalar(z); }));
    if (ldlt_.info() != Eigen::Success || !(rounding_of(t) <= rounding_without_pivots * largest_sum(t))) {
      is_symmetric_ = false;
      lu_.isSymmetric(true);
      lu_.compute(t);
      ok_ = lu_.info() == Eigen::Success;
    }
    if (ok_) rounding_ = rounding_of(t) + 4.0 * std::numeric_limits<double>::epsilon() * largest_sum(t);
  }

  bool ok() const { return ok_; }
  // How much of T(c), hence nearly how much of an eigenvalue nearby, is what its sums and the factor have
  // rounded off.
  double rounding() const { return rounding_; }
  // Multiplications of the factor, and of one use of it, nearly.
  double factor_work() const { return entries() * entries() / static_cast<double>(parts_.n_); }
  double solve_work() const { return 2.0 * entries(); }
  Eigen::Index size() const { return parts_.n_ * static_cast<Eigen::Index>(1 + parts_.springs_.size()); }

  ComplexVector operator()(const ComplexVector& y) const {
    const Eigen::Index n = parts_.n_;
    ComplexVector right = ComplexVector::Zero(n + parts_.columns_.cols());
    right.head(n) = -(parts_.mass_ * y.head(n));
    for (std::size_t k = 0; k < parts_.springs_.size(); ++k)
      right.head(n) += factor(k) / size_ * (parts_.springs_[k] * part(y, k));
    ComplexVector result(size());
    result.head(n) = solve(right).head(n);
    for (std::size_t k = 0; k < parts_.springs_.size(); ++k)
      result.segment(n * static_cast<Eigen::Index>(1 + k), n) =
          factor(k) * (size_ * result.head(n) - part(y, k));
    return result;
  }

 private:
  using ComplexMatrix = Eigen::SparseMatrix<Complex>;

  Complex factor(std::size_t k) const { return 1.0 / (parts_.rates_[k] + c_); }
  Eigen::VectorBlock<const ComplexVector> part(const ComplexVector& y, std::size_t k) const {
    return y.segment(parts_.n_ * static_cast<Eigen::Index>(1 + k), parts_.n_);
  }

  // Of a matrix by the factor for one right side.
  double rounding_of(const ComplexMatrix& t) const {
    const ComplexVector right = ComplexVector::Ones(t.rows());
    const ComplexVector x = solve(right);
    return (t * x - right).norm() / x.norm();
  }

  double entries() const {
    return is_symmetric_ ? static_cast<double>(ldlt_.matrixL().nestedExpression().nonZeros())
                         : static_cast<double>(lu_.nnzL() + lu_.nnzU());
  }

  ComplexVector solve(const ComplexVector& right) const {
    if (!is_symmetric_) return lu_.solve(right);
    using Symmetric = Eigen::Matrix<SymmetricScalar, Eigen::Dynamic, 1>;
    const Symmetric x = ldlt_.solve(right.unaryExpr([](const Complex& z) { return SymmetricScalar(z); }));
    return x.unaryExpr([](const SymmetricScalar& z) { return Complex(z); });
  }

  const NearbyEigenvalues& parts_;
  double size_;
  Complex c_;
  double rounding_ = 0.0;
  bool ok_ = true, is_symmetric_ = true;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<SymmetricScalar>> ldlt_;
  Eigen::SparseLU<ComplexMatrix, Eigen::AMDOrdering<int>> lu_;
};

// Grows step by step; columns of `basis` are orthonormal.
class NearbyEigenvalues::Arnoldi {
 public:
  explicit Arnoldi(const Shifted& shifted)
      : shifted_(shifted),
        most_(std::min({most_vectors, shifted.size(),
                        static_cast<Eigen::Index>(most_numbers / static_cast<double>(shifted.size()))})) {
    ComplexVector x(shifted.size());
    std::uint64_t seed = 1;
    for (Complex& each : x) each = nearly_normal(seed);
    basis_ = shifted_(x).normalized();  // what the constraints leave
  }

  bool can_grow() const { return steps_ < most_ && !is_whole_; }

  void grow(Eigen::Index steps) {
    const Eigen::Index last = std::min(steps_ + steps, most_);
    basis_.conservativeResize(shifted_.size(), last + 1);
    h_.conservativeResizeLike(Eigen::MatrixXcd::Zero(last + 1, last));
    while (steps_ < last && !is_whole_) {
      ComplexVector x = shifted_(basis_.col(steps_));
      const double whole = x.norm();
      const auto known = basis_.leftCols(steps_ + 1);
      double before = whole, left = 0.0;
      // Twice is enough, and where little was taken off, once.
      for (int times = 0; times < 2 && left < 0.7 * before; ++times) {
        if (times > 0) before = left;
        const ComplexVector along = known.adjoint() * x;
        x -= known * along;
        h_.col(steps_).head(steps_ + 1) += along;
        left = x.norm();
      }
      ++steps_;
      is_whole_ = !(left > 1e-13 * whole);
      if (is_whole_) break;
      h_(steps_, steps_ - 1) = left;
      basis_.col(steps_) = x / left;
    }
  }

  // What has converged without a gap, from the centre outwards.
  Disc disc(Complex centre) const {
    Disc disc{centre, 0.0, {}};
    const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solved(h_.topLeftCorner(steps_, steps_));
    if (solved.info() != Eigen::Success) return disc;
    const auto& values = solved.eigenvalues();
    std::vector<Eigen::Index> order(static_cast<std::size_t>(steps_));
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, std::ranges::greater(), [&](Eigen::Index i) { return std::abs(values[i]); });
    const double all = 0.999 * std::abs(centre);  // 0 is rigid motion's
    // What the largest eigenvalue leaves of the digits of the others.
    const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * std::abs(values[order.front()]);
    for (const Eigen::Index i : order) {
      const double distance = 1.0 / std::abs(values[i]);
      const double residual =
          is_whole_ ? 0.0
                    : std::abs(h_(steps_, steps_ - 1) * solved.eigenvectors()(steps_ - 1, i)) * distance;
      const bool has_converged = residual <= converged;
      disc.radius = std::min(std::max(disc.radius, (has_converged ? reach : empty_reach) * distance), all);
      if (!has_converged || distance >= all) break;
      const Complex s = centre + 1.0 / values[i];
      // Two that are nearly one are moved by the root of that, as far as they are damped: but for the damping
      // the operator is normal.
      const double moved = (2.0 * residual + rounding * distance) * distance + shifted_.rounding();
      disc.eigenvalues.push_back({s, moved + std::sqrt(moved * std::abs(s.real()))});
    }
    std::erase_if(disc.eigenvalues, [&](const NearbyEigenvalue& each) { return !disc.contains(each.value); });
    return disc;
  }

  double work() const {
    const auto steps = static_cast<double>(steps_);
    const double orthogonal = 4.0 * steps * static_cast<double>(shifted_.size());
    return shifted_.factor_work() + steps * (shifted_.solve_work() + orthogonal);
  }

 private:
  const Shifted& shifted_;
  Eigen::Index most_, steps_ = 0;
  bool is_whole_ = false;
  Eigen::MatrixXcd basis_, h_;
};

Disc NearbyEigenvalues::around(Complex centre, Complex wanted) {
  const Shifted shifted(*this, centre);
  if (!shifted.ok()) return {centre, 0.0, {}};
  Arnoldi arnoldi(shifted);
  arnoldi.grow(first_vectors);
  Disc disc = arnoldi.disc(centre);
  while (!disc.contains(wanted) && arnoldi.can_grow()) {
    arnoldi.grow(more_vectors);
    disc = arnoldi.disc(centre);
  }
  work_ += arnoldi.work();
  return disc;
}

bool NearbyEigenvalues::nothing_vibrates_below(double s0) const {
  Matrix sum = dashpots_ / (2.0 * s0) - 2.0 * mass_;
  for (std::size_t k = 0; k < springs_.size(); ++k)
    sum += springs_[k] * ((1.0 + rates_[k] / (2.0 * s0)) / std::pow(s0 + rates_[k], 2));
  // As many more are negative as there are columns a, beside those of the sum + f a a^T: whatever f, what is
  // positive on all motions is so on those that the constraints leave.
  if (columns_.cols() > 0) sum = bordered(sum, columns_, 1e-4);
  const Eigen::SimplicialLDLT<Matrix> factor(sum);
  return factor.info() == Eigen::Success &&
         (factor.vectorD().array() < 0.0).count() <= rigid_ + columns_.cols();
}

}  // namespace rheo
