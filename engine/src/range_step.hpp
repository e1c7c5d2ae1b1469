// The largest explicit step of a body too large for all its eigenvalues: by its numerical range, and by the
// eigenvalues where that cannot tell.
//
//   h = the largest with: no s outside the integrator's region of stability / h' is an eigenvalue, for any h'
//   between a step that is stable for sure and h
//
// looked for along rays from 0 (RK4) or lines of equal Im(1 / s) (Euler, whose region is Re(1 / s) <= -h /
// 2): what is known of the range excludes points of them up to h, or one more Lanczos run is made for the
// first that it does not. Then (Euler) discs in which all eigenvalues are known take its place: a few where
// the range was nearly right, or as many as it takes to go along all vibrations that h hangs on.
//
// Units    [s]
// Errors   none
#pragma once

#include <functional>

#include "nearby_eigenvalues.hpp"
#include "numerical_range.hpp"
#include "rheo/stability.hpp"

namespace rheo {

// 0 where nothing beyond `surely`, a step that is stable for sure, or 0, could be told.
struct RangeStep {
  double step = 0.0;       // by the range: stable whatever is held besides
  double near_step = 0.0;  // by discs: stable, and at least 95 % of the limit
};

// Looks for near steps too.
struct DiscSearch {
  std::function<NearbyEigenvalues()> eigenvalues = {};
  double most_work = 4e10;                // multiplications: about half a minute
  std::function<void(double)> told = {};  // which part of that is done
};

RangeStep range_step(const Model& model, const ConstraintSolver& solver, const Spectrum& spectrum,
                     IntegratorKind integrator, double surely, const DiscSearch* discs = nullptr);

}  // namespace rheo
