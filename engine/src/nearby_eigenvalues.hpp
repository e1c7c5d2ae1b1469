// All eigenvalues of the full operator in a disc, of bodies too large for all of them: what an interior limit
// hangs on, as Euler's does on the damping of single modes.
//
//   v' = - M^-1 (sum over k of K_k u_k + D v),  u_k' = v - r_k u_k,  A^T v = 0
//
// with one k for each rate r_k of any spring, K_k those springs' stiffness, D the viscous part. Arnoldi's
// process with (operator - c)^-1 finds the eigenvalues nearest to c first:
//
//   T(c) v = - M f + sum of K_k g_k / (r_k + c),  u_k = (v - g_k) / (r_k + c),  T(c) = c M + D + sum of K_k /
//   (r_k + c)
//
// one sparse factor a disc. The disc reaches as far as they have converged without a gap. (As with any
// iteration from one start, one that the start does not have at all would be missed; of several that are the
// same one counts.)
//
// Source   Saad, Numerical Methods for Large Eigenvalue Problems, 2nd ed., 2011, ch. 6 and 8; Lu, Su and Bai,
//          SIAM J. Matrix Anal. Appl. 37 (2016) (two levels: all u_k are combinations of the velocities)
// Units    eigenvalues [1/s]
// Errors   none: a disc of radius 0 where the factor fails
#pragma once

#include <Eigen/SparseCore>
#include <complex>
#include <vector>

#include "constraints.hpp"
#include "model.hpp"

namespace rheo {

struct NearbyEigenvalue {
  std::complex<double> value;
  double error = 0.0;  // at most, by its residual and rounding
};

struct Disc {
  std::complex<double> centre;
  double radius = 0.0;
  std::vector<NearbyEigenvalue> eigenvalues;

  bool contains(std::complex<double> s) const { return std::abs(s - centre) < radius; }
};

class NearbyEigenvalues {
 public:
  // Of a model with its matrices. All are used here only.
  NearbyEigenvalues(const Mesh& mesh, const Model& model, const ConstraintSolver& solver);
  // Whether that is not too large, nor for this memory (0: what this machine has available): a disc takes
  // some hundred vectors of velocities and a factor.
  static bool can_take(const Model& model, double memory);

  // As large as takes the least time for each eigenvalue, or larger until it contains `wanted`, if ever. The
  // centre is neither 0 nor a rate.
  Disc around(std::complex<double> centre, std::complex<double> wanted);

  // Whether no eigenvalue with |s| <= s0 vibrates. One s = - d + i omega has, with its x and q_k = x^H K_k x,
  //   x^H M x = sum over k of q_k / |s + r_k|^2,  2 d x^H M x = sum of q_k r_k / |s + r_k|^2 + x^H D x
  // hence, of both with d <= s0, there is none where
  //   sum over k of K_k (1 + r_k / (2 s0)) / (s0 + r_k)^2 + D / (2 s0) - 2 M
  // is positive but for rigid motion, whose eigenvalue is 0. false: unknown.
  bool nothing_vibrates_below(double s0) const;

  double work() const { return work_; }  // multiplications so far, nearly

 private:
  using Complex = std::complex<double>;
  using ComplexVector = Eigen::VectorXcd;
  using Matrix = Eigen::SparseMatrix<double>;

  class Shifted;
  class Arnoldi;

  Eigen::Index n_ = 0;  // free degrees of freedom
  int rigid_ = 0;       // motions of the mesh's pieces that the constraints leave; -1: not known
  Matrix mass_, dashpots_, columns_;
  std::vector<Matrix> springs_;
  std::vector<double> rates_;
  double work_ = 0.0;
};

}  // namespace rheo
