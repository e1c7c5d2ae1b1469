// Every eigenvalue of the operator of a small body, but for constraints' own and rigid motion's, for limits
// that hang on the damping of single modes.
//
//   x' = - sum over k of C_k^T z_k - D x,  z_k' = C_k x - rate_k z_k
//   x = Z^T M^1/2 v,  C_k^T C_k = B^T K_k B,  D = B^T (viscous_lambda J_lambda + viscous_mu J_mu) B,  B =
//   M^-1/2 Z K_k = lambda_k J_lambda + mu_k J_mu
//
// C_k is made of the triangles' strains: J, which is added up in double, has lost some of what a sliver has.
// Z spans what the constraints leave free; the springs of one rate make one k (relaxations_of), the elastic
// part is that of rate 0. Several materials: K_k is the sum over the regions, likewise the viscous part.
// In these variables, whose squares are energies, the operator is skew but for damping, and its eigenvalues
// are as well conditioned as those of a symmetric one; in long double, so that rates of 1e9 /s may stand
// beside vibrations of 1e-3 /s. Real parts are given so much larger as rounding may have made them smaller.
// Dense: the cube of their number, at most (1 + rates) n for n free degrees of freedom, hence for small
// bodies only.
//
// Source   design: full operator where rates matter; Eigen's QR algorithm for the eigenvalues
// Units    eigenvalues [1/s]
// Errors   none: nullopt beyond `most` eigenvalues, where QR iteration does not end, or where nothing is
// stiff;
//          empty where nothing is free
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "constraints.hpp"
#include "model.hpp"

namespace rheo {

inline constexpr int most_eigenvalues = 300;

std::optional<std::vector<std::complex<double>>> full_spectrum(const Mesh& mesh, const Model& model,
                                                               const ConstraintSolver& solver,
                                                               int most = most_eigenvalues);

}  // namespace rheo
