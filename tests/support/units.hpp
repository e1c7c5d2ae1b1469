// A scene in other units of length, mass and time: the same body, other numbers.
//
// Every quantity of dimension length^l mass^m time^t is multiplied by what one SI unit of it is in the new
// ones.
#pragma once

#include <cmath>

#include "rheo/scene.hpp"

namespace rheo::test {

struct Units {
  const char* name = "m-kg-s";
  // How many of the new units an SI unit is.
  double length = 1.0, mass = 1.0, time = 1.0;

  double factor(int l, int m, int t) const {
    return std::pow(length, l) * std::pow(mass, m) * std::pow(time, t);
  }
  double velocity() const { return factor(1, 0, -1); }
  double stress() const { return factor(-1, 1, -2); }
  double viscosity() const { return factor(-1, 1, -1); }
  double density() const { return factor(-3, 1, 0); }
  double residual_force() const { return factor(0, 1, -2); }  // Pa m
  double force() const { return factor(1, 1, -2); }
  double energy() const { return factor(2, 1, -2); }
};

inline constexpr Units millimetre_gram_millisecond{"mm-g-ms", 1e3, 1e3, 1e3};
inline constexpr Units kilometre_tonne_hour{"km-t-h", 1e-3, 1e-3, 1.0 / 3600};

inline Vec2 times(double factor, Vec2 v) {
  return {factor * v.x, factor * v.y};
}

inline Material in_units(const Units& units, Material m) {
  const double stress = units.stress(), viscosity = units.viscosity();
  m.lambda_ela *= stress, m.mu_ela *= stress;
  m.lambda_vis *= viscosity, m.mu_vis *= viscosity;
  m.density *= units.density();
  for (MaxwellBranch& b : m.more_branches) {
    b.lambda_ela *= stress, b.mu_ela *= stress;
    b.lambda_vis *= viscosity, b.mu_vis *= viscosity;
  }
  m.elastic = {stress * m.elastic.lambda, stress * m.elastic.mu};
  m.viscous = {viscosity * m.viscous.lambda, viscosity * m.viscous.mu};
  return m;
}

inline Window in_units(const Units& units, Window window) {
  return {units.time * window.from, units.time * window.until};
}

inline Scene in_units(const Units& units, Scene scene) {
  for (Vec2& p : scene.mesh.points) p = times(units.length, p);
  scene.mesh.thickness *= units.length;
  scene.material = in_units(units, scene.material);
  for (Region& region : scene.regions) region.material = in_units(units, region.material);
  scene.body_acceleration = times(units.factor(1, 0, -2), scene.body_acceleration);
  for (Fix& fix : scene.fixes) fix.window = in_units(units, fix.window);
  for (Move& move : scene.moves) {
    move.window = in_units(units, move.window);
    for (MoveKey& key : move.keys)
      key = {units.time * key.t, times(units.length, key.u), times(units.velocity(), key.v)};
  }
  for (Constraint& constraint : scene.constraints) constraint.value *= units.length;
  for (Traction& traction : scene.tractions) {
    traction.window = in_units(units, traction.window);
    for (TractionKey& key : traction.keys) key = {units.time * key.t, times(units.stress(), key.p)};
  }
  scene.time.duration *= units.time;
  scene.time.step *= units.time;
  scene.time.frame_rate /= units.time;
  scene.time.baumgarte /= units.time;
  return scene;
}

}  // namespace rheo::test
