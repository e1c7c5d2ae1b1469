// Where the full operator has no eigenvalues, by numerical ranges: for bodies too large for all of them.
//
//   T(s) = s M + sum over m of F_m(s) J_m,   F_m(s) = sum over k of e_mk / (s + r_mk) + d_m
//
// with one m for lambda and one for mu of each region, e_mk its springs, r_mk their rates, d_m its dashpot.
// An eigenvalue s other than the -r_mk has T(s) x = 0 for some x. It is none, hence, where for some u, v
//
//   H = u Re(T(s) / s) + v Im(T(s) / s) = alpha M + sum over m of beta_m J_m
//
// is positive definite, and H is real and symmetric: one Lanczos run tells. What it finds counts for other s
// too: H there may be what was found positive here, times a factor, plus something that is positive by its
// signs (J_lambda <= J_mu in every region). Quotients x^T J_m x of vectors tell where no such u, v are: where
// 0 is in the hull of the numbers x^T T(s) x / s.
//
// It is exact where the largest and smallest quotients are eigenvectors', and on the safe side elsewhere.
//
// Source   Horn and Johnson, Topics in Matrix Analysis, 1991, ch. 1 (the numerical range is convex)
// Units    s [1/s], z = 1 / s [s]
// Errors   none
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "constraints.hpp"
#include "model.hpp"

namespace rheo {

class NumericalRange {
 public:
  // Both must outlive this.
  NumericalRange(const Model& model, const ConstraintSolver& solver);

  // Whether one u, v shows for all of these that 1 / z is no eigenvalue, by what is known; hence for what
  // lies between them, whose H is nearly between theirs. That asks for being near to one another, next to the
  // distance from 0 and from the poles z = -1 / r: false where they are not.
  bool excludes(std::span<const std::complex<double>> z) const;
  // Whether neither z is one, of Re z <= 0 <= Im z, nor any with a larger Im z and a Re z as large: by signs.
  //   Im c(z) / Im z = d - 2 |Re z| sum of e (r = 0) + sum of e / r (1 - 1 / |1 + r z|^2) (r > 0, r |Re z| <
  //   1)
  // only grows then.
  bool excludes_slower(std::complex<double> z) const;
  // Whether no u, v can do that.
  bool includes(std::span<const std::complex<double>> z) const;
  // Gets to know more of it by a Lanczos run, for the u, v that the witnesses leave the most: of the numbers'
  // distance from 0, or of what there is between the smallest and the largest, which is what a run can tell.
  enum class Clearest { distance, part };
  void look_at(std::complex<double> z, Clearest clearest);

  int products() const { return products_; }       // of matrices with vectors so far
  std::int64_t trials() const { return trials_; }  // of what is known on some z

 private:
  struct Term {
    std::size_t region = 0;
    Modulus modulus = Modulus::lambda;
    std::vector<std::pair<double, double>> springs;  // modulus, rate
    double dashpot = 0.0;
    double largest = 0.0;  // quotient x^T J x
  };
  // u re + v im, componentwise, for H = alpha M + sum beta J: alpha, then each region's terms as what must
  // not be negative for H to be positive by its signs.
  struct Rows {
    Vector re, im;
  };
  using Coefficients = std::vector<std::complex<double>>;

  Coefficients coefficients(std::complex<double> z) const;
  Rows rows_of(const Coefficients& c) const;
  Vector signs_of(double alpha, const Vector& beta) const;
  // Adds x^T T(s) x / s of each x that was kept, and of slow deformations, nearly.
  void add_witnesses(const Coefficients& c, std::vector<std::complex<double>>& points) const;
  // A bound from below of sum beta J; a vector x of which x^T H x <= expected is kept as a witness.
  double lowest_of(double alpha, const Vector& beta, double expected);

  const Model& model_;
  const ConstraintSolver& solver_;
  std::vector<Term> terms_;
  std::vector<Vector> positive_;             // rows of what is known to be positive definite
  std::vector<Vector> quotients_;            // x^T J_m x of vectors
  std::vector<std::complex<double>> poles_;  // and 0
  int products_ = 0;
  mutable std::int64_t trials_ = 0;
};

}  // namespace rheo
