#include "step_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "rheo/error.hpp"
#include "schedule.hpp"

namespace rheo {
namespace {

// Refuses with the place in the scene file where there is one.
[[noreturn]] void refuse(const Scene& scene, const std::string& text) {
  const std::string& where = scene.time.where;
  throw Error(Error::Kind::input, where.empty() ? text : where + " " + text);
}

}  // namespace

bool takes_long_steps(IntegratorKind integrator) {
  return integrator == IntegratorKind::exponential || integrator == IntegratorKind::implicit;
}

StepLimits choose_step(const Scene& scene, const Spectrum& spectrum, std::string_view name,
                       const SimulationOptions& options) {
  const TimeSettings& settings = scene.time;
  const double limit = stable_step(spectrum, settings.integrator);
  const bool given = settings.step > 0.0;
  if (limit == 0.0 && !(given && options.allow_unstable)) {
    const char* const remedy = given ? "allow it" : "give a step and allow it";
    // Of a bound it is only known that it cannot be told from 0.
    const bool unknown = stable_step_is_bound(spectrum, settings.integrator);
    refuse(scene,
           fmt::format(
               "{}: no step of {} {} here, some vibrations {}: use \"rk4\", or {} (--allow-unstable)",
               given ? fmt::format("step = {:g} s", settings.step) : fmt::format("integrator = \"{}\"", name),
               given ? name : std::string_view("it"), unknown ? "can be promised to be stable" : "is stable",
               unknown ? "may hardly be damped (a material that does not relax, in a body too large to tell)"
                       : "are not damped",
               remedy));
  }
  if (given && settings.step > limit * (1.0 + 1e-12) && !options.allow_unstable) {
    refuse(scene,
           fmt::format("step = {:g} s: beyond the largest {} of {}, {:.6g} s: take a smaller one or "
                       "\"auto\", or allow it (--allow-unstable)",
                       settings.step,
                       stable_step_is_bound(spectrum, settings.integrator) ? "step that is surely stable"
                                                                           : "stable step",
                       name, limit));
  }
  const double share = takes_long_steps(settings.integrator) ? 1.0 : options.stable_share;
  const double bound = given ? settings.step : share * limit;
  if (!(settings.refinement * settings.duration / bound <= max_steps)) {
    refuse(scene,
           fmt::format("step = {}: {:g} s needs {:.2g} steps for the duration of {:g} s, at most {:g} are "
                       "allowed: check the material's moduli and density, the mesh's size and baumgarte",
                       given ? fmt::format("{:g}", settings.step) : "\"auto\"", bound,
                       settings.duration / bound, settings.duration, max_steps));
  }
  return {limit, bound};
}

IntegratorSettings integrator_settings(const Scene& scene, const Spectrum& spectrum, std::size_t intervals) {
  const TimeSettings& settings = scene.time;
  if (settings.integrator == IntegratorKind::exponential && has_columns(scene)) {
    throw Error(Error::Kind::input,
                "integrator = \"exponential\" needs constraints = \"auto\" without [[constraint]]: use "
                "\"rk4\" or \"implicit\"");
  }
  const double rate =
      settings.step > 0.0 ? std::max(settings.frame_rate, 1.0 / settings.step) : settings.frame_rate;
  const double steps = std::ceil(settings.duration * rate) + static_cast<double>(intervals);
  return {spectrum.omega_max, spectrum.largest_rate(), settings.tolerance / steps, 1.0 / settings.frame_rate};
}

}  // namespace rheo
