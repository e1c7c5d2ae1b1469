#include "overrides.hpp"

#include <fmt/format.h>

#include "failure.hpp"
#include "option_values.hpp"
#include "rheo/io/scene_file.hpp"

namespace app {

rheo::Scene load_scene(const Options& options) {
  rheo::Scene scene = rheo::read_scene(options.scene);
  if (options.integrator) scene.time.integrator = *options.integrator;
  // What the command line says of the step, the tolerance or the accuracy stands for all that the scene says.
  if (options.step || options.tolerance) scene.time.accuracy = 0.0;
  if (options.step) scene.time.step = *options.step;
  if (options.accuracy) {
    scene.time.accuracy = *options.accuracy;
    scene.time.step = 0.0;
  }
  if (scene.time.accuracy == 0.0 && scene.time.integrator == rheo::IntegratorKind::automatic)
    scene.time.integrator = rheo::IntegratorKind::rk4;
  if (options.step || options.integrator || options.accuracy)
    scene.time.where.clear();  // what is wrong now is not the file's
  if (options.tolerance) {
    if (scene.time.integrator != rheo::IntegratorKind::exponential) {
      throw Failure(ExitCode::usage,
                    fmt::format("--tolerance '{:g}': for the integrator exponential only, not {}",
                                *options.tolerance, name_of(scene.time.integrator)));
    }
    scene.time.tolerance = *options.tolerance;
  }
  if (options.duration) scene.time.duration = *options.duration;
  if (options.frame_rate) scene.time.frame_rate = *options.frame_rate;
  if (options.color) scene.picture.color = *options.color;
  if (options.size) scene.picture.size = *options.size;
  if (options.range) {
    scene.picture.range_auto = options.range->automatic;
    if (!options.range->automatic) scene.picture.range = options.range->limits;
  }
  rheo::validate(scene);
  return scene;
}

}  // namespace app
