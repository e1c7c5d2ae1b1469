// The largest explicit step of a body too large for all its eigenvalues, by its numerical range.
//
//   h = the largest with: no s outside the integrator's region of stability / h' is in the range, for any h'
//   between a step that is stable for sure and h
//
// looked for along rays from 0 (RK4) or lines of equal Im(1 / s) (Euler, whose region is Re(1 / s) <= -h /
// 2): what is known excludes points of them up to h, or one more Lanczos run is made for the first that it
// does not.
//
// Units    [s]
// Errors   none
#pragma once

#include "numerical_range.hpp"
#include "rheo/stability.hpp"

namespace rheo {

// Safe; 0 where nothing beyond `surely` could be told, a step that is stable for sure, > 0.
double range_step(const Model& model, const ConstraintSolver& solver, const Spectrum& spectrum,
                  IntegratorKind integrator, double surely);

}  // namespace rheo
