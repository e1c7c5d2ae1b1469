// RK4's true limit on bodies of some hundred to thousand triangles, where all eigenvalues of the full
// operator take too long: by the outermost of them, which are all that RK4 can hang on.
//
//   x' = - sum over the triangles' strains of C^T z - D x,  z' = C x - rate z
//
// in energy variables as in true_limit.hpp, one C for each rate, lumped mass, constraints by node. RK4's
// region reaches from 2.61 / h to 2.97 / h, whatever the direction: eigenvalues below 0.87 of the largest
// never limit it. Found by restarted Arnoldi (Spectra), until that is below the smallest that converged.
//
// Units    steps [s]
// Not here consistent mass, general constraints
#pragma once

#include "rheo/scene.hpp"

namespace rheo::test {

struct OuterLimit {
  double step = 0.0;
  int eigenvalues = 0;    // that converged
  bool complete = false;  // whether they reach far enough inwards
};

OuterLimit outer_rk4_limit(const Scene& scene);

}  // namespace rheo::test
