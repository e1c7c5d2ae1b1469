#include "motion.hpp"

#include <algorithm>
#include <cmath>

namespace rheo {
namespace {

// Index of the last key with key.t <= t; -1 before the first.
template <class Key>
int key_before(const std::vector<Key>& keys, double t) {
  const auto after =
      std::upper_bound(keys.begin(), keys.end(), t, [](double x, const Key& key) { return x < key.t; });
  return static_cast<int>(after - keys.begin()) - 1;
}

Polynomial between(Profile profile, double t0, double t1, double q0, double q1, double v0, double v1) {
  const double length = t1 - t0;
  const double rise = q1 - q0;
  std::array<double, 6> c{q0, 0, 0, 0, 0, 0};  // in s = (t - t0) / length
  switch (profile) {
    case Profile::smooth:
      c = {q0, 0, 0, 10 * rise, -15 * rise, 6 * rise};
      break;
    case Profile::linear:
      c[1] = rise;
      break;
    case Profile::hermite:
      c[1] = length * v0;
      c[2] = 3 * rise - length * (2 * v0 + v1);
      c[3] = -2 * rise + length * (v0 + v1);
      break;
  }
  double scale = 1.0;
  for (double& coefficient : c) {
    coefficient *= scale;
    scale /= length;
  }
  return {t0, c};
}

Polynomial constant(double t0, double value) {
  return {t0, {value, 0, 0, 0, 0, 0}};
}

}  // namespace

double Polynomial::derivative(double t, int order) const {
  const double s = t - t0;
  double result = 0.0;
  for (int k = 5; k >= order; --k) {
    double factor = c[k];
    for (int i = 0; i < order; ++i) factor *= k - i;
    result = result * s + factor;
  }
  return result;
}

double Polynomial::derivative_size(double t, int order) const {
  Polynomial sizes{0.0, c};
  for (double& coefficient : sizes.c) coefficient = std::abs(coefficient);
  return sizes.derivative(std::abs(t - t0), order);
}

bool Polynomial::is_zero() const {
  return std::all_of(c.begin(), c.end(), [](double x) { return x == 0.0; });
}

std::array<Polynomial, 2> piece_at(const Move& move, double t) {
  const auto& keys = move.keys;
  const int i = key_before(keys, t);
  if (i < 0) return {constant(keys.front().t, keys.front().u.x), constant(keys.front().t, keys.front().u.y)};
  const MoveKey& a = keys[i];
  if (i + 1 == static_cast<int>(keys.size())) return {constant(a.t, a.u.x), constant(a.t, a.u.y)};
  const MoveKey& b = keys[i + 1];
  return {between(move.profile, a.t, b.t, a.u.x, b.u.x, a.v.x, b.v.x),
          between(move.profile, a.t, b.t, a.u.y, b.u.y, a.v.y, b.v.y)};
}

std::array<Polynomial, 2> piece_at(const Traction& traction, double t) {
  const auto& keys = traction.keys;
  const int i = key_before(keys, t);
  if (i < 0) return {constant(keys.front().t, keys.front().p.x), constant(keys.front().t, keys.front().p.y)};
  const TractionKey& a = keys[i];
  if (i + 1 == static_cast<int>(keys.size())) return {constant(a.t, a.p.x), constant(a.t, a.p.y)};
  const TractionKey& b = keys[i + 1];
  return linear_piece(a, b);
}

std::array<Polynomial, 2> hermite_piece(const MoveKey& a, const MoveKey& b) {
  return {between(Profile::hermite, a.t, b.t, a.u.x, b.u.x, a.v.x, b.v.x),
          between(Profile::hermite, a.t, b.t, a.u.y, b.u.y, a.v.y, b.v.y)};
}

std::array<Polynomial, 2> linear_piece(const TractionKey& a, const TractionKey& b) {
  return {between(Profile::linear, a.t, b.t, a.p.x, b.p.x, 0, 0),
          between(Profile::linear, a.t, b.t, a.p.y, b.p.y, 0, 0)};
}

bool same_course(const Move& a, const Move& b) {
  const bool velocities = a.profile == Profile::hermite;
  return a.profile == b.profile && std::equal(a.keys.begin(), a.keys.end(), b.keys.begin(), b.keys.end(),
                                              [&](const MoveKey& p, const MoveKey& q) {
                                                return p.t == q.t && p.u == q.u &&
                                                       (!velocities || p.v == q.v);
                                              });
}

}  // namespace rheo
