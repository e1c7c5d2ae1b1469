#include "constraints.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/OrderingMethods>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "motion.hpp"
#include "rheo/error.hpp"
#include "rheo/memory_limit.hpp"
#include "timeline.hpp"

namespace rheo {
namespace {

// A pivot of the Schur complement is the squared sine of the angle between a constraint and those before it
// (relative to its diagonal); below this it is rounding.
constexpr double dependent_pivot = 1e-11;
// Below this rounding in the multipliers shows (eps over the pivot) and is solved for once more.
constexpr double weak_pivot = 1e-5;

std::string describe(const Holder& holder) {
  return holder.where.empty() ? (holder.move ? "[[move]]" : "[[fix]]") : holder.where;
}

char axis_name(int dof) {
  return dof % 2 == 0 ? 'x' : 'y';
}

bool agree(const Holder& a, const Holder& b) {
  if (a.move == nullptr || b.move == nullptr) return a.move == b.move;
  return same_course(*a.move, *b.move);
}

// Of L in L D L^T, by its elimination tree (Davis, Direct Methods for Sparse Linear Systems, ch. 4) in the
// order that Eigen takes; no further than what exceeds `most`.
double factor_bytes(const Eigen::SparseMatrix<double>& matrix, double most) {
  constexpr double entry_bytes = 12.0;
  Eigen::AMDOrdering<int>::PermutationType order;  // which row comes at each place
  Eigen::AMDOrdering<int>()(matrix, order);
  const Eigen::Index size = matrix.cols();
  std::vector<int> place(static_cast<std::size_t>(size)), parent(place.size(), -1), visited(place.size(), -1);
  for (int k = 0; k < size; ++k) place[static_cast<std::size_t>(order.indices()[k])] = k;
  double entries = 0.0;
  for (int k = 0; k < size && entry_bytes * entries <= most; ++k) {
    visited[static_cast<std::size_t>(k)] = k;
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, order.indices()[k]); it; ++it) {
      int i = place[static_cast<std::size_t>(it.row())];
      if (i > k) continue;
      for (; visited[static_cast<std::size_t>(i)] != k; i = parent[static_cast<std::size_t>(i)]) {
        if (parent[static_cast<std::size_t>(i)] < 0) parent[static_cast<std::size_t>(i)] = k;
        visited[static_cast<std::size_t>(i)] = k;
        ++entries;
      }
    }
  }
  return entry_bytes * entries;
}

}  // namespace

std::vector<Holder> holders_of(const Scene& scene) {
  std::vector<Holder> holders;
  for (const Fix& fix : scene.fixes)
    holders.push_back({&fix.nodes, fix.axis, fix.window, nullptr, fix.where});
  for (const Move& move : scene.moves)
    holders.push_back({&move.nodes, move.axis, move.window, &move, move.where});
  return holders;
}

std::vector<HeldDof> held_dofs(const std::vector<Holder>& holders, const std::vector<char>& active) {
  std::vector<HeldDof> held;
  for (std::size_t i = 0; i < holders.size(); ++i) {
    if (!active[i]) continue;
    for (int node : *holders[i].nodes) {
      if (holders[i].axis != Axis::y) held.push_back({2 * node, static_cast<int>(i)});
      if (holders[i].axis != Axis::x) held.push_back({2 * node + 1, static_cast<int>(i)});
    }
  }
  std::stable_sort(held.begin(), held.end(),
                   [](const HeldDof& a, const HeldDof& b) { return a.dof < b.dof; });
  std::vector<HeldDof> unique;
  for (const HeldDof& h : held) {
    if (unique.empty() || unique.back().dof != h.dof) {
      unique.push_back(h);
      continue;
    }
    const Holder& first = holders[unique.back().owner];
    const Holder& second = holders[h.owner];
    if (!agree(first, second)) {
      throw Error(
          Error::Kind::input,
          fmt::format(
              "{}: node {} is held in {} by {} at the same time, in another way: let the windows (from, "
              "until) not overlap, or leave the node out of one",
              describe(second), h.dof / 2, axis_name(h.dof), describe(first)));
    }
  }
  return unique;
}

ConstraintSolver::ConstraintSolver(const Model& model, const std::vector<HeldDof>& eliminated,
                                   std::vector<Column> columns, double memory)
    : model_(model), columns_(std::move(columns)), free_(model.layout.part, 1) {
  for (const HeldDof& h : eliminated) free_[h.dof] = 0;
  const auto size = static_cast<Eigen::Index>(model.layout.part);
  work_.setZero(size);
  correction_.setZero(size);
  factor_mass();
  if (!columns_.empty()) factor_schur(memory);
}

void ConstraintSolver::hold(const std::vector<HeldDof>& eliminated) {
  assert(model_.is_lumped() && columns_.empty());
  std::fill(free_.begin(), free_.end(), 1);
  for (const HeldDof& h : eliminated) free_[h.dof] = 0;
  factor_mass();
}

void ConstraintSolver::factor_mass() {
  const auto n = static_cast<int>(model_.node_mass.size());
  if (model_.is_lumped()) {
    inverse_mass_.setZero(2 * n);
    for (int i = 0; i < 2 * n; ++i) inverse_mass_[i] = free_[i] ? 1.0 / model_.node_mass[i / 2] : 0.0;
    return;
  }
  packed_.setZero(n);
  for (int axis = 0; axis < 2; ++axis) {
    for (int i = 0; i < n; ++i) {
      if (free_[2 * i + axis]) axis_[axis].nodes.push_back(i);
    }
  }
  same_axes_ = axis_[0].nodes == axis_[1].nodes;
  for (int axis = 0; axis < (same_axes_ ? 1 : 2); ++axis) {
    const std::vector<int>& nodes = axis_[axis].nodes;
    std::vector<int> position(n, -1);
    for (std::size_t k = 0; k < nodes.size(); ++k) position[nodes[k]] = static_cast<int>(k);
    std::vector<Eigen::Triplet<double, int>> entries;
    for (int node : nodes) {
      for (SparseMatrix::InnerIterator it(model_.mass, node); it; ++it) {
        if (position[it.col()] >= 0) entries.emplace_back(position[node], position[it.col()], it.value());
      }
    }
    const auto size = static_cast<Eigen::Index>(nodes.size());
    Eigen::SparseMatrix<double> free_mass(size, size);
    free_mass.setFromTriplets(entries.begin(), entries.end());
    if (size == 0) continue;
    axis_[axis].factor = std::make_unique<Factor>(free_mass);
    // The factor's fill-reducing order becomes that of the list: solves need no permutation.
    const auto& order = axis_[axis].factor->permutationPinv().indices();
    if (order.size() > 0) {
      std::vector<int> ordered(nodes.size());
      for (std::size_t k = 0; k < nodes.size(); ++k) ordered[k] = nodes[order[static_cast<Eigen::Index>(k)]];
      axis_[axis].nodes = std::move(ordered);
    }
  }
}

void ConstraintSolver::apply_inverse_mass(const Vector& r, Vector& a) const {
  if (model_.is_lumped()) {
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      if (free_[i]) a[i] = inverse_mass_[i] * r[i];
    }
    return;
  }
  for (int axis = 0; axis < 2; ++axis) {
    const AxisFactor& packing = axis_[same_axes_ ? 0 : axis];
    const std::vector<int>& nodes = packing.nodes;
    if (nodes.empty()) continue;
    auto packed = packed_.head(static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t k = 0; k < nodes.size(); ++k)
      packed[static_cast<Eigen::Index>(k)] = r[2 * nodes[k] + axis];
    packing.factor->matrixL().solveInPlace(packed);
    packing.factor->matrixU().solveInPlace(packed);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      a[2 * nodes[k] + axis] = packed[static_cast<Eigen::Index>(k)];
  }
}

double ConstraintSolver::row_times(std::size_t column, const double* x) const {
  double sum = 0.0;
  for (const auto& [dof, coefficient] : columns_[column].entries) sum += coefficient * x[dof];
  return sum;
}

void ConstraintSolver::factor_schur(double memory) {
  const std::size_t m = columns_.size();
  const bool dense = !model_.is_lumped();
  const MemoryLimit limit = memory_limit(memory);
  const auto require = [&](double bytes) {
    if (bytes <= limit.bytes) return;
    throw Error(Error::Kind::input,
                fmt::format("{} general constraints{} need {} of memory or more, {}", m,
                            dense ? " with consistent mass" : "", memory_text(bytes),
                            beyond(limit, dense ? "use mass = \"lumped\" or constraints = \"auto\""
                                                : "take fewer [[constraint]] that meet")));
  };
  if (dense) require(40.0 * static_cast<double>(m) * static_cast<double>(m));
  // Columns by degree of freedom, to find the few that a vector M^-1 A_j touches.
  std::vector<std::vector<std::pair<int, double>>> by_dof(free_.size());
  for (std::size_t j = 0; j < m; ++j) {
    for (const auto& [dof, coefficient] : columns_[j].entries) {
      if (free_[dof]) by_dof[dof].emplace_back(static_cast<int>(j), coefficient);
    }
  }
  // Counted before a matrix is made of them.
  const auto met = static_cast<std::size_t>(
      std::count_if(by_dof.begin(), by_dof.end(), [](const auto& columns) { return !columns.empty(); }));
  if (met > 0 && m > met) {
    throw Error(
        Error::Kind::input,
        fmt::format(
            "{} constraints hold at once what can move in {} ways only: at least {} of them follow from or "
            "contradict the others: take those out",
            m, met, m - met));
  }
  std::vector<Eigen::Triplet<double, int>> entries;
  Vector column = Vector::Zero(work_.size());
  Vector y = Vector::Zero(work_.size());
  for (std::size_t j = 0; j < m; ++j) {
    const int row = static_cast<int>(j);
    if (dense) {
      column.setZero();
      for (const auto& [dof, coefficient] : columns_[j].entries)
        column[dof] += free_[dof] ? coefficient : 0.0;
      y.setZero();
      apply_inverse_mass(column, y);
      for (std::size_t i = 0; i < m; ++i) {
        double sum = 0.0;
        for (const auto& [dof, coefficient] : columns_[i].entries)
          sum += free_[dof] ? coefficient * y[dof] : 0.0;
        entries.emplace_back(static_cast<int>(i), row, sum);
      }
    } else {
      for (const auto& [dof, coefficient] : columns_[j].entries) {
        for (const auto& [i, other] : by_dof[dof])
          entries.emplace_back(i, row, coefficient * other * inverse_mass_[dof]);
      }
    }
  }
  const auto size = static_cast<Eigen::Index>(m);
  Eigen::SparseMatrix<double> schur(size, size);
  schur.setFromTriplets(entries.begin(), entries.end());
  // Constraints on held nodes only, or that cancel: an empty row.
  Vector scale(size);
  for (std::size_t j = 0; j < m; ++j) {
    double largest = 0.0;
    for (const auto& [dof, coefficient] : columns_[j].entries)
      largest = std::max(largest, std::abs(coefficient));
    const double diagonal = schur.coeff(static_cast<int>(j), static_cast<int>(j));
    const double mass = model_.node_mass[columns_[j].entries.front().first / 2];
    if (!(diagonal > dependent_pivot * largest * largest / mass)) refuse_dependent(j);
    scale[j] = diagonal;
  }
  require(factor_bytes(schur, limit.bytes));
  schur_ = std::make_unique<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>();
  schur_->compute(schur);
  pivots_ = schur_->vectorD();
  packed_multipliers_.setZero(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const int j =
        schur_->permutationPinv().size() > 0 ? schur_->permutationPinv().indices()[k] : static_cast<int>(k);
    if (!(pivots_[k] > dependent_pivot * scale[j])) refuse_dependent(j);
    if (pivots_[k] < weak_pivot * scale[j]) has_weak_pivots_ = true;
  }
  residual_.setZero(size);
}

// What schur_->solve() does, in memory that stays.
void ConstraintSolver::solve_schur(Vector& x) const {
  const auto& order = schur_->permutationPinv().indices();
  Vector& packed = packed_multipliers_;
  for (Eigen::Index k = 0; k < x.size(); ++k) packed[k] = x[order.size() > 0 ? order[k] : k];
  schur_->matrixL().solveInPlace(packed);
  packed.array() /= pivots_.array();
  schur_->matrixU().solveInPlace(packed);
  for (Eigen::Index k = 0; k < x.size(); ++k) x[order.size() > 0 ? order[k] : k] = packed[k];
}

void ConstraintSolver::refuse_dependent(std::size_t column) const {
  // Which of the two it is: c with A c = A_column in the least-squares sense over the free degrees of
  // freedom, then compare the values. Only on the way to an error, so dense algebra over the entries' degrees
  // of freedom will do.
  std::vector<int> dofs;
  for (const Column& c : columns_) {
    for (const auto& [dof, coefficient] : c.entries) {
      if (free_[dof]) dofs.push_back(dof);
    }
  }
  std::sort(dofs.begin(), dofs.end());
  dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
  const Column& offender = columns_[column];
  const std::string name = offender.where.empty() ? fmt::format("constraint {}", column) : offender.where;
  const bool small = dofs.size() < 2000 && columns_.size() < 2000;
  std::string verdict = "follows from or contradicts";
  if (dofs.empty()) {
    throw Error(
        Error::Kind::input,
        fmt::format("{}: all its nodes are held already, it follows from or contradicts that: take it out",
                    name));
  }
  if (small && columns_.size() > 1) {
    const auto rows = static_cast<Eigen::Index>(dofs.size());
    Eigen::MatrixXd others = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(columns_.size()) - 1);
    Vector values(others.cols());
    Vector own = Vector::Zero(rows);
    Eigen::Index k = 0;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      for (const auto& [dof, coefficient] : columns_[j].entries) {
        if (!free_[dof]) continue;
        const auto r = std::lower_bound(dofs.begin(), dofs.end(), dof) - dofs.begin();
        (j == column ? own[r] : others(r, k)) += coefficient;
      }
      if (j != column) values[k++] = columns_[j].value;
    }
    const Vector c = others.colPivHouseholderQr().solve(own);
    const double implied = c.dot(values);
    const double size = std::abs(offender.value) + c.cwiseAbs().dot(values.cwiseAbs());
    verdict = std::abs(implied - offender.value) <= 1e-9 * size ? "follows from" : "contradicts";
  }
  throw Error(Error::Kind::input,
              fmt::format("{}: this constraint {} the others (they are linearly dependent): take one out",
                          name, verdict));
}

void ConstraintSolver::solve(const Vector& r, Vector& a, const Vector& target, Vector& multipliers) const {
  if (model_.is_lumped()) {
    apply_inverse_mass(r, a);
  } else {
    // M_fc a_c: only where something eliminated moves.
    bool moving = false;
    for (Eigen::Index i = 0; i < a.size(); ++i) {
      if (free_[i]) {
        a[i] = 0.0;
      } else if (a[i] != 0.0) {
        moving = true;
      }
    }
    if (moving) {
      model_.multiply_mass(a.data(), work_.data());
      work_ = r - work_;
      apply_inverse_mass(work_, a);
    } else {
      apply_inverse_mass(r, a);
    }
  }
  if (columns_.empty()) return;
  multipliers.setZero(target.size());
  for (int pass = 0; pass < (has_weak_pivots_ ? 2 : 1); ++pass) {
    for (std::size_t j = 0; j < columns_.size(); ++j) residual_[j] = target[j] - row_times(j, a.data());
    solve_schur(residual_);
    multipliers += residual_;
    work_.setZero();
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      for (const auto& [dof, coefficient] : columns_[j].entries) work_[dof] += coefficient * residual_[j];
    }
    correction_.setZero();
    apply_inverse_mass(work_, correction_);
    a += correction_;
  }
}

}  // namespace rheo
