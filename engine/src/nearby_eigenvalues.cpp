#include "nearby_eigenvalues.hpp"

#include <Eigen/Dense>
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
#include "rigid_motions.hpp"

namespace rheo {
namespace {

// Of a basis: about a third of its vectors make eigenvalues, and it takes their square of time.
constexpr Eigen::Index first_vectors = 45, more_vectors = 40, most_vectors = 300;
constexpr double most_numbers = 1.2e7;  // of a basis: 200 MB
// Residual of (operator - c)^-1, of its eigenvalue.
constexpr double converged = 1e-6;
// How far a disc reaches, of the distance of the outermost eigenvalue that has converged, as all nearer ones
// have further, and of the nearest that has not: one at half its distance would outgrow it with every vector.
constexpr double reach = 0.9, empty_reach = 0.5;
constexpr double rounding_without_pivots = 1e-13;  // of the matrix: more asks for pivots

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
template <class Scalar>
double largest_sum(const Eigen::SparseMatrix<Scalar>& matrix) {
  double largest = 0.0;
  for (Eigen::Index j = 0; j < matrix.outerSize(); ++j) {
    double sum = 0.0;
    for (typename Eigen::SparseMatrix<Scalar>::InnerIterator it(matrix, j); it; ++it)
      sum += std::abs(it.value());
    largest = std::max(largest, sum);
  }
  return largest;
}

}  // namespace

bool NearbyEigenvalues::can_take(const Model& model, double memory) {
  const auto size = static_cast<double>(model.layout.part);
  // Of a factor: as memory_need.hpp has it for a real one.
  const double factor = 1.7 * 135.0 * std::log2(size) * size / 2.0;
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

// (operator - c)^-1 on vectors (v, |c| u_1, |c| u_2, ...), a column a part.
class NearbyEigenvalues::Shifted {
 public:
  Shifted(const NearbyEigenvalues& parts, Complex c) : parts_(parts), size_(std::abs(c)), c_(c) {
    ComplexMatrix t = c * parts.mass_.cast<Complex>() + parts.dashpots_.cast<Complex>();
    for (Eigen::Index k = 1; k < part_count(); ++k)
      t += ComplexMatrix(parts.springs_[static_cast<std::size_t>(k - 1)].cast<Complex>() * factor(k));
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
  Eigen::Index free() const { return parts_.n_; }
  Eigen::Index part_count() const { return static_cast<Eigen::Index>(1 + parts_.springs_.size()); }

  // Of the result, v; and part k > 0 of it is factor(k) (v - y.col(k) / |c|) |c|.
  ComplexVector velocity(const Eigen::MatrixXcd& y) const {
    const Eigen::Index n = parts_.n_;
    ComplexVector right = ComplexVector::Zero(n + parts_.columns_.cols());
    right.head(n) = -(parts_.mass_ * y.col(0));
    for (Eigen::Index k = 1; k < part_count(); ++k)
      right.head(n) += factor(k) / size_ * (parts_.springs_[static_cast<std::size_t>(k - 1)] * y.col(k));
    return solve(right).head(n);
  }
  double scale() const { return size_; }
  Complex factor(Eigen::Index k) const { return 1.0 / (parts_.rates_[static_cast<std::size_t>(k - 1)] + c_); }

 private:
  using ComplexMatrix = Eigen::SparseMatrix<Complex>;

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

// Grows step by step. Part k of vector j is U G_k e_j: all parts are combinations of the velocities so far,
// so that these few vectors, kept orthonormal, and small matrices stand for all (two-level orthogonal
// Arnoldi).
class NearbyEigenvalues::Arnoldi {
 public:
  explicit Arnoldi(const Shifted& shifted)
      : shifted_(shifted),
        most_(std::min({most_vectors, shifted.part_count() * shifted.free(),
                        static_cast<Eigen::Index>(most_numbers / static_cast<double>(shifted.free()))})),
        stride_(most_ + first_directions),
        g_(Eigen::MatrixXcd::Zero(shifted.part_count() * stride_, most_ + 1)),
        h_(Eigen::MatrixXcd::Zero(most_ + 1, most_)) {
    // Of one random direction in all parts, differently.
    std::uint64_t seed = 1;
    ComplexVector x(shifted.free());
    for (Complex& each : x) each = nearly_normal(seed);
    Eigen::VectorXcd shares(shifted.part_count());
    for (Complex& each : shares) each = nearly_normal(seed);
    u_.resize(shifted.free(), first_vectors);
    directions_ = 0;
    add_direction(x);
    Eigen::MatrixXcd start = Eigen::MatrixXcd::Zero(stride_, shifted.part_count());
    start.row(0) = shares.transpose();
    const Eigen::VectorXcd applied = apply(start);
    g_.col(0) = applied.normalized();
  }

  bool can_grow() const { return steps_ < most_ && !is_whole_; }

  void grow(Eigen::Index steps) {
    const Eigen::Index last = std::min(steps_ + steps, most_);
    while (steps_ < last && !is_whole_) {
      const Eigen::Map<const Eigen::MatrixXcd> now(g_.col(steps_).data(), stride_, shifted_.part_count());
      Eigen::VectorXcd x = apply(now);
      const double whole = x.norm();
      const auto known = g_.leftCols(steps_ + 1);
      for (int times = 0; times < 2; ++times) {
        const Eigen::VectorXcd along = known.adjoint() * x;
        x -= known * along;
        h_.col(steps_).head(steps_ + 1) += along;
      }
      const double left = x.norm();
      ++steps_;
      is_whole_ = !(left > 1e-13 * whole);
      if (is_whole_) break;
      h_(steps_, steps_ - 1) = left;
      g_.col(steps_) = x / left;
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
    const double most = 0.999 * std::abs(centre);  // 0 is rigid motion's
    // What the largest eigenvalue leaves of the digits of the others.
    const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * std::abs(values[order.front()]);
    for (const Eigen::Index i : order) {
      const double distance = 1.0 / std::abs(values[i]);
      const double residual =
          is_whole_ ? 0.0
                    : std::abs(h_(steps_, steps_ - 1) * solved.eigenvectors()(steps_ - 1, i)) * distance;
      const bool has_converged = residual <= converged;
      disc.radius = std::min(std::max(disc.radius, (has_converged ? reach : empty_reach) * distance), most);
      if (!has_converged || distance >= most) break;
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
    const double parts = static_cast<double>(shifted_.part_count());
    const double orthogonal = (4.0 + parts) * steps * static_cast<double>(shifted_.free());
    return shifted_.factor_work() + steps * (shifted_.solve_work() + orthogonal);
  }

 private:
  // x = U a + what is left, which becomes one more column of U; returns a with that one's share.
  Eigen::VectorXcd add_direction(ComplexVector& x) {
    Eigen::VectorXcd along = Eigen::VectorXcd::Zero(stride_);
    const double whole = x.norm();
    double before = whole, left = directions_ > 0 ? 0.0 : whole;
    const auto known = u_.leftCols(directions_);
    // Twice is enough, and where little was taken off, once.
    for (int times = 0; times < 2 && left < 0.7 * before; ++times) {
      if (times > 0) before = left;
      const Eigen::VectorXcd share = known.adjoint() * x;
      x -= known * share;
      along.head(directions_) += share;
      left = x.norm();
    }
    if (!(left > 1e-14 * whole)) return along;
    if (directions_ == u_.cols()) u_.conservativeResize(Eigen::NoChange, std::min(2 * directions_, stride_));
    u_.col(directions_) = x / left;
    along[directions_++] = left;
    return along;
  }

  // By coefficients, a column a part; the result's one below another.
  template <class Parts>
  Eigen::VectorXcd apply(const Parts& g) {
    ComplexVector v = shifted_.velocity(u_.leftCols(directions_) * g.topRows(directions_));
    Eigen::MatrixXcd result(stride_, shifted_.part_count());
    result.col(0) = add_direction(v);
    for (Eigen::Index k = 1; k < shifted_.part_count(); ++k)
      result.col(k) = shifted_.factor(k) * (shifted_.scale() * result.col(0) - g.col(k));
    return result.reshaped();
  }

  static constexpr Eigen::Index first_directions = 2;

  const Shifted& shifted_;
  Eigen::Index most_, stride_, steps_ = 0, directions_ = 0;
  bool is_whole_ = false;
  Eigen::MatrixXcd u_, g_, h_;
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
  constexpr double held = 1e-4;
  if (columns_.cols() > 0) sum = bordered(sum, columns_, held);
  // Signs that the factor's rounding may have turned tell nothing. (M has no eigenvalue below a fourth.)
  constexpr double seen = 0.1;
  const double rounding = std::numeric_limits<double>::epsilon() / (columns_.cols() > 0 ? held : 1.0);
  if (rigid_ < 0 || !(4.0 * rounding * largest_sum(sum) <= seen)) return false;
  const Eigen::SimplicialLDLT<Matrix> factor(sum);
  return factor.info() == Eigen::Success &&
         (factor.vectorD().array() < 0.0).count() == rigid_ + columns_.cols();
}

}  // namespace rheo
