// Strain, stress and the limits of a linear model, triangle by triangle.
//
//   epsilon = B u (engineering shear),  sigma = I_lambda B w_lambda + I_mu B w_mu
//
// Source   Hirai and Tomokuni, eq. (1), (2)
// Units    strain [1], stress [Pa], rotation [rad]
// Shapes   u, w: n x 2; strain, stress: m x 3 (xx, yy, xy)
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "rheo/mesh.hpp"

namespace rheo {

void strain(const Mesh& mesh, std::span<const double> u, std::span<double> out);
void stress(const Mesh& mesh, std::span<const double> w_lambda, std::span<const double> w_mu,
            std::span<double> out);
// Of some triangles; the others' stay as they are.
void stress(const Mesh& mesh, std::span<const std::int32_t> triangles, std::span<const double> w_lambda,
            std::span<const double> w_mu, std::span<double> out);

// The worst triangle of a state in each of the three ways in which a linear model stops meaning anything.
struct LinearityReport {
  int inverted = 0;         // triangles turned inside out: det(I + grad u) <= 0
  int first_inverted = -1;  // the lowest number among them, -1: none
  int most_strained = 0;    // triangle with the largest principal strain (absolute)
  double strain = 0.0;      // that strain
  int most_rotated = 0;     // triangle with the largest rotation
  double rotation = 0.0;    // that angle, from the polar decomposition of I + grad u [rad]
};
LinearityReport check_linearity(const Mesh& mesh, std::span<const double> u);

// Beyond these a linear model is off by about its own size of error: 10 % strain, 10 degrees.
inline constexpr double strain_limit = 0.1;
inline constexpr double rotation_limit = 0.17453292519943295;

}  // namespace rheo
