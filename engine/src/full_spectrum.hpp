// Every eigenvalue of the operator of a small body, but for constraints' own, for limits that hang on the
// damping of single modes.
//
//   v' = - P M^-1 (sum over k of K_k q_k + (viscous_lambda J_lambda + viscous_mu J_mu) v)
//   q_k' = v - rate_k q_k,  K_k = lambda_k J_lambda + mu_k J_mu
//
// P is the projection by the constraints; the springs of one rate make one k (relaxations_of), the elastic
// part is that of rate 0, where q is u. Several materials: K_k is the sum over the regions, likewise the
// viscous part. Dense: ((1 + rates) n)^3 operations for n free degrees of freedom,
// hence for small ones only.
//
// Source   design: full operator where rates matter; Eigen's QR algorithm for the eigenvalues
// Units    eigenvalues [1/s]
// Errors   none: empty beyond `most` of them, or where nothing is free or stiff
#pragma once

#include <complex>
#include <vector>

#include "constraints.hpp"
#include "model.hpp"

namespace rheo {

inline constexpr int most_eigenvalues = 480;
// Where a good bound is known too: 120 take some ten milliseconds.
inline constexpr int few_eigenvalues = 120;

std::vector<std::complex<double>> full_spectrum(const Model& model, const ConstraintSolver& solver, int most);

}  // namespace rheo
