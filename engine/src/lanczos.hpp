// Three-term Lanczos on what the constraints leave free, and the two ends of a spectrum found by it.
//
//   H = P M^-1 sum over the regions of (lambda J_lambda + mu J_mu),  P the projection by the constraints
//
// H is self-adjoint in the inner product of M; moduli may be negative. The start is pseudo-random, always the
// same one. Ritz values approach the ends from inside, and neither their residuals nor that they stay where
// they are tell by how much: the true end may be one mode on one small triangle that the start hardly has.
// But after k steps from a random start, on n degrees of freedom, for the largest as for the lowest,
//
//   largest eigenvalue - largest Ritz value <= e (largest - lowest),  e = (ln(1.648 sqrt(n) / p) / (2 k -
//   1))^2
//
// but with probability p, whatever the operator, for a start of normal numbers in the inner product of M.
// (Here sums of three uniform ones; with consistent mass some directions have up to twice as much as others.
// Neither counts beside p.)
//
// Source   Parlett, The Symmetric Eigenvalue Problem, 1980, ch. 13; Kuczynski and Wozniakowski, SIAM J.
//          Matrix Anal. Appl. 13 (1992), theorem 4.2
// Units    omega [rad/s], H [1/s^2] for moduli [Pa]
#pragma once

#include <vector>

#include "constraints.hpp"
#include "model.hpp"

namespace rheo {

// Goes on step by step; the vectors of the steps are orthonormal in the inner product of M, but for rounding.
class LanczosRun {
 public:
  // All must outlive this. Moduli by region.
  LanczosRun(const Model& model, const ConstraintSolver& solver, const std::vector<Moduli>& moduli);

  // Whether the start had anything in what is free.
  bool has_started() const { return started_; }
  int dimension() const { return dimension_; }  // of what is free
  // One row more of the tridiagonal matrix.
  void step();
  int steps() const { return static_cast<int>(diagonal_.size()); }
  Eigen::Map<const Vector> diagonal() const;
  Eigen::Map<const Vector> off_diagonal() const;  // one less
  double beta() const { return beta_; }           // the next off-diagonal entry: the residual's size
  // Whether the start's whole subspace is found, but for a residual of this part of the largest entry.
  bool is_exhausted(double part) const { return !(beta_ > part * largest_); }
  const Vector& vector() const { return previous_; }  // of the last step

 private:
  double norm(const Vector& x);
  void project(const Vector& r, Vector& out);

  const Model& model_;
  const ConstraintSolver& solver_;
  const std::vector<Moduli>& moduli_;
  bool started_ = false;
  int dimension_ = 0;
  double beta_ = 0.0, largest_ = 0.0;
  std::vector<double> diagonal_, off_;
  Vector target_, multipliers_, mass_times_, force_, next_, previous_, before_;
};

struct RitzBound {
  double omega = 0.0;
  int steps = 0;
};

// No smaller than the largest natural frequency, and larger by at most 0.75 %, beyond 2,000 degrees of
// freedom by up to 1.2 % (a million) or 1.7 % (a billion), of springs of these moduli, by region; p is 1e-4.
RitzBound largest_frequency(const Model& model, const ConstraintSolver& solver,
                            const std::vector<Moduli>& moduli);

struct LowestValue {
  double ritz = 0.0;              // x^T H x of some x with x^T M x = 1
  double bound = 0.0;             // no eigenvalue is below it
  Vector diagonal, off_diagonal;  // of all steps
};

// p is 1e-8. As near as it takes to say that H + shift has only positive eigenvalues, or that one is
// negative, or until `most_steps`.
LowestValue lowest_value(const Model& model, const ConstraintSolver& solver,
                         const std::vector<Moduli>& moduli, double shift, int most_steps);
// That x, by the same steps once more.
Vector lowest_vector(const Model& model, const ConstraintSolver& solver, const std::vector<Moduli>& moduli,
                     const LowestValue& found);

}  // namespace rheo
