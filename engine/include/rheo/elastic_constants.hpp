// Young's modulus and Poisson's ratio of a solid as the lambda and mu of its flat model, and back.
//
//   mu = E / (2 (1 + nu))
//   plane strain (nothing moves across the plane)   lambda = E nu / ((1 + nu) (1 - 2 nu))
//   plane stress (nothing presses on the plane)     lambda = E nu / (1 - nu^2)
//
// The flat law sigma = lambda trace(epsilon) I + 2 mu epsilon is that of plane strain; under plane stress
// the strain across the plane is eliminated, which turns lambda into 2 lambda mu / (lambda + 2 mu). The same
// holds for viscosities, with an extensional viscosity [Pa s] in the place of E.
//
// A relaxing material: with one Poisson's ratio for all of it both lines hold for every part by itself,
// because E(t) is a common factor. Under plane stress parts of different ratios share one strain across the
// plane and cannot be converted one by one.
//
// Source   Timoshenko and Goodier, Theory of Elasticity, 3rd ed., 1970, sections 11 and 16
// Units    E, lambda, mu [Pa] or all [Pa s]; nu [1]
#pragma once

#include "rheo/material.hpp"

namespace rheo {

enum class Plane { strain, stress };

struct ElasticConstants {
  double young = 0.0;
  double poisson = 0.0;
};

// Needs 0 <= poisson < 0.5, under plane stress <= 0.5. An infinite young gives infinite moduli, and lambda 0
// where poisson is 0.
Moduli moduli_of(const ElasticConstants& constants, Plane plane);

// Needs mu > 0 and lambda >= 0, under plane stress lambda <= 2 mu, for a ratio within the bounds above.
ElasticConstants elastic_constants_of(const Moduli& moduli, Plane plane);

}  // namespace rheo
