// Time courses as polynomials: prescribed motions and tractions between their keys.
//
// smooth:  q0 + (q1 - q0) (10 s^3 - 15 s^4 + 6 s^5), s = (t - t0) / (t1 - t0): at rest at both keys, C2
// linear:  q0 + (q1 - q0) s
// hermite: the cubic with values and velocities at both keys, C1
// constant before the first and after the last key
#pragma once

#include <array>
#include <span>
#include <vector>

#include "rheo/scene.hpp"

namespace rheo {

// sum of c[k] (t - t0)^k
struct Polynomial {
  double t0 = 0.0;
  std::array<double, 6> c{};

  double derivative(double t, int order) const;
  double value(double t) const { return derivative(t, 0); }
  // Sum of its terms' sizes: what its rounding is relative to.
  double derivative_size(double t, int order) const;
  bool is_zero() const;
};

// The piece of a motion that holds around t (not at a key), for x and y.
std::array<Polynomial, 2> piece_at(const Move& move, double t);

// Likewise for a traction; degree 1.
std::array<Polynomial, 2> piece_at(const Traction& traction, double t);

// Between two neighbouring keys: a hermite motion's cubic, a traction's line.
std::array<Polynomial, 2> hermite_piece(const MoveKey& a, const MoveKey& b);
std::array<Polynomial, 2> linear_piece(const TractionKey& a, const TractionKey& b);

// Whether two moves prescribe the same displacement increments.
bool same_course(const Move& a, const Move& b);

}  // namespace rheo
