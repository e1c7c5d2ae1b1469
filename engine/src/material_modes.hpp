// Euler's largest step on a body of several materials that is too large for all of its eigenvalues.
//
// Material m has the Rayleigh quotients a_m <= b_m of its own J_lambda and J_mu in an eigenvector of the
// whole,
//
//   s + sum over m of [a_m F_m(s) + b_m G_m(s)] = 0
//   F_m = sum over k of lambda_mk / (s + r_k) + viscous_lambda_m, G_m alike with mu
//   sum of all springs <= omega_max^2,   of all dashpots <= viscous_max
//
// so -s is a point in the cone of the rays F_m + G_m and G_m, and all such s that a cap allows are on hand
// with two rays at a time. The two caps are one here, springs theta / omega_max^2 + dashpots (1 - theta) /
// viscous_max <= 1: more s than both allow, whatever theta, so the best theta counts.
//
// Every ray keeps its material's own ratio of what forgets to what does not: what Euler's limit hangs on, and
// what is lost where any share of the springs may be that of any rate (stability.cpp, for RK4).
//
// Units    [1/s], steps [s]
// Errors   none
#pragma once

#include "rheo/stability.hpp"

namespace rheo {

// A safe bound; 0 where some material may vibrate undamped.
double euler_step_of_materials(const Spectrum& spectrum);

}  // namespace rheo
