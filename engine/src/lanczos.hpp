// Largest natural frequency of what the constraints leave free.
//
//   omega_max^2 = largest eigenvalue of P M^-1 (lambda J_lambda + mu J_mu),  P the projection by the
//   constraints
//
// The operator is self-adjoint in the inner product of M: three-term Lanczos, from a fixed pseudo-random
// start. The Ritz value approaches from below; its residual norm is added.
//
// Source   Parlett, The Symmetric Eigenvalue Problem, 1980, ch. 13
// Units    omega [rad/s]
#pragma once

#include "constraints.hpp"
#include "model.hpp"

namespace rheo {

struct RitzBound {
  double omega = 0.0;  // sqrt(Ritz value + residual)
  int steps = 0;
};

// Of springs of these moduli, by region.
RitzBound largest_frequency(const Model& model, const ConstraintSolver& solver,
                            const std::vector<Moduli>& moduli);

}  // namespace rheo
