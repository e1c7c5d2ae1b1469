// One choice of integrator and step or tolerance, as `rheo bench` tries it and as a user would type it.
//
// Units    step [s]
#pragma once

#include <string>

#include "rheo/scene.hpp"

namespace app {

struct Setting {
  rheo::IntegratorKind integrator = rheo::IntegratorKind::rk4;
  double step = 0.0;       // [s]; 0: auto
  double tolerance = 0.0;  // 0: the integrator has none
};

// The scene with this in the place of its own choice.
inline rheo::Scene scene_with(const rheo::Scene& scene, const Setting& setting) {
  rheo::Scene other = scene;
  other.time.integrator = setting.integrator;
  other.time.step = setting.step;
  if (setting.tolerance > 0.0) other.time.tolerance = setting.tolerance;
  other.time.accuracy = 0.0;
  other.time.refinement = 1.0;
  other.time.where.clear();  // what is wrong now is not the file's
  return other;
}

// "1e-6", not "1e-06".
std::string short_number(double x);
// "--step 0.001"
std::string knob_of(const Setting& setting);
// "--integrator rk4 --step 0.001"
std::string options_of(const Setting& setting);

}  // namespace app
