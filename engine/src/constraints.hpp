// Which degrees of freedom are held, and the solution of the dynamics under them.
//
//   M a - A L = r,   a_c given on eliminated degrees of freedom c,   A^T a = target for the general
//   constraints
//
// Eliminated exactly: M_ff a_f = r_f - M_fc a_c. General: L = (A_f^T M_ff^-1 A_f)^-1 (target - A^T a), a_f +=
// M_ff^-1 A_f L, the Schur complement factored once. This is the KKT system of equation (4), solved by
// blocks.
//
// Source   Hirai and Tomokuni, eq. (4)
// Shapes   r, a: 2n; L, target: one per general constraint
// Errors   Error::Kind::input: a node held in two ways at once, dependent or contradictory general
// constraints, more of
//          them than memory for their Schur complement (dense with consistent mass) and its factor
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model.hpp"

namespace rheo {

// A fix or a move of the scene; `move` is null for a fix.
struct Holder {
  const std::vector<int>* nodes = nullptr;
  Axis axis = Axis::both;
  Window window;
  const Move* move = nullptr;
  std::string where;
};
std::vector<Holder> holders_of(const Scene& scene);

struct HeldDof {
  int dof = 0;    // 2 node + axis
  int owner = 0;  // index into the holders
};

// Every degree of freedom that a holder holds at time t, each once, in rising order. Overlaps are allowed
// where they agree (two fixes; two moves of one course), else refused by name.
std::vector<HeldDof> held_dofs(const std::vector<Holder>& holders, const std::vector<char>& active);

// A general constraint: one column of A. Either a [[constraint]] of the scene (constant value) or, by
// Baumgarte for all, one held degree of freedom.
struct Column {
  std::vector<std::pair<int, double>> entries;  // dof, coefficient
  double value = 0.0;                           // for [[constraint]]
  int owner = -1;                               // holder, or -1
  std::string where;
};

class ConstraintSolver {
 public:
  // `memory` [bytes] may be used for the Schur complement; 0: what this machine has available.
  ConstraintSolver(const Model& model, const std::vector<HeldDof>& eliminated, std::vector<Column> columns,
                   double memory = 0.0);

  const std::vector<Column>& columns() const { return columns_; }
  bool is_free(std::size_t dof) const { return free_[dof] != 0; }

  // Other degrees of freedom are eliminated from now on. For lumped mass without columns, where nothing is
  // factored: allocates nothing.
  void hold(const std::vector<HeldDof>& eliminated);

  // a: on entry the given values on eliminated degrees of freedom (others ignored), on return the whole
  // solution. target: one number a column; on return of the same size, multipliers = L.
  void solve(const Vector& r, Vector& a, const Vector& target, Vector& multipliers) const;

  // sum over the entries of a column
  double row_times(std::size_t column, const double* x) const;

 private:
  using Factor = Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>;

  void factor_mass();
  void factor_schur(double memory);
  void solve_schur(Vector& x) const;
  void apply_inverse_mass(const Vector& r, Vector& a) const;  // free rows only
  [[noreturn]] void refuse_dependent(std::size_t column) const;

  const Model& model_;
  std::vector<Column> columns_;
  std::vector<char> free_;
  Vector inverse_mass_;  // lumped: 2n, zero where eliminated
  struct AxisFactor {
    std::vector<int> nodes;  // free nodes of this axis, in the factor's order
    std::unique_ptr<Factor> factor;
  };
  AxisFactor axis_[2];
  bool same_axes_ = false;  // both axes share axis_[0].factor
  std::unique_ptr<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>> schur_;
  mutable Vector work_, correction_;
  Vector pivots_;  // D of schur_
  bool has_weak_pivots_ = false;
  mutable Vector packed_, packed_multipliers_, residual_;
};

}  // namespace rheo
