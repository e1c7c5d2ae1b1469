// The equations that one implicit stage of length s leaves for the velocities, factored once for each s and
// set of constraints.
//
//   S = M + sum over the regions of (lambda(s) J_lambda + mu(s) J_mu)
//   lambda(s) = sum over the branches of s^2 lambda_ela / (1 + s lambda_rate) + s^2 elastic + s viscous
//   S_ff d_f = r_f where the increments d of driven degrees of freedom are given
//   S d - A m = r, A^T d = target for general constraints: (A_f^T S_ff^-1 A_f) m = target - A^T d, by a dense
//   factor
//
// Driven are the degrees of freedom that are eliminated, and those that a constraint of one term holds:
// equation (4) then says all about their increment. Everything else in u, w_lambda, w_mu follows from the
// velocities node by node.
//
// The factors of the latest few (s, constraints) are kept, so that steps cut short by events cost no new
// ones.
//
// Shapes   r, d: 2n; target: one a general constraint of several terms
// Errors   prepare: failed where the factor has not enough correct digits
//          require_few_general_constraints: Error::Kind::input
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "constraints.hpp"
#include "model.hpp"
#include "sparse_factor.hpp"

namespace rheo {

// Many general constraints make a large dense factor: refused beyond what it may take.
void require_few_general_constraints(const Scene& scene);

class ShiftedSystem {
 public:
  // `model` must outlive this, and have its matrices.
  explicit ShiftedSystem(const Model& model);

  enum class Found { kept, made, failed };
  // Takes or makes the factor for s, in force until the next call. Allocates where it is made.
  Found prepare(double s, const std::shared_ptr<const ConstraintSolver>& constraints);

  // Which columns of the constraints hold one degree of freedom each, and the others.
  const std::vector<int>& single() const { return current_->single; }
  const std::vector<int>& general() const { return current_->general; }

  // r -= J_lambda p_lambda + J_mu p_mu of a region, the rows summed as sum over j of J_ij (p_j - p_i): what a
  // rigid motion has in common at all nodes leaves no rounding behind, however stiff the body. pull: p, 4 a
  // node of the region (lambda x, y, mu x, y)
  void subtract_force(std::size_t region, std::span<const double> pull, Vector& r) const;

  // d: on entry the increments of driven degrees of freedom and anything elsewhere, on return all of them.
  // r is overwritten. Returns how many sparse solves that took.
  int solve(Vector& r, Vector& d, Vector& target);

  std::size_t factor_bytes() const { return factor_bytes_; }

 private:
  struct Factor {
    Factor(double shift, std::shared_ptr<const ConstraintSolver> set, std::unique_ptr<SparseFactor> memory);
    double s;
    std::shared_ptr<const ConstraintSolver> constraints;
    std::vector<char> free;
    std::vector<int> single, general;  // columns
    std::unique_ptr<SparseFactor> sparse;
    Eigen::LLT<Eigen::MatrixXd> schur;
  };

  void fill_values(const Factor& factor);
  bool holds_digits(const Factor& factor);
  bool factor_schur(Factor& factor);
  // correction_ = A_f multipliers
  void spread(const Factor& factor, const Vector& multipliers);

  const Model& model_;
  std::shared_ptr<const FactorOrder> order_;
  std::unique_ptr<SparseFactor> spare_;  // analysed, for the next factor; or none
  std::size_t factor_bytes_;
  // Of a region: the blocks of J_lambda and J_mu, row-major, by a pattern of its own nodes; and where each
  // lies in the pattern of all (nowhere listed where they are the same).
  struct Links {
    BlockPattern pattern;
    std::vector<std::array<double, 8>> blocks;
    std::vector<int> place;
  };
  std::vector<Links> links_;
  std::vector<Block> values_;
  std::deque<std::unique_ptr<Factor>> factors_;  // the latest first
  Factor* current_ = nullptr;
  Vector work_, correction_;
};

}  // namespace rheo
