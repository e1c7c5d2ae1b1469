#include "overrides.hpp"

#include <fmt/format.h>

#include "failure.hpp"
#include "option_values.hpp"
#include "rheo/io/scene_file.hpp"
#include "rheo/memory_limit.hpp"

namespace app {
namespace {

// "--duration '1e12'": what was typed of two settings that do not go together.
std::string typed(const char* name, const std::optional<TypedNumber>& option, const char* other_name,
                  const std::optional<TypedNumber>& other) {
  std::string text;
  if (option) text = fmt::format("{} '{}'", name, option->text);
  if (other) text += fmt::format("{}{} '{}'", text.empty() ? "" : " and ", other_name, other->text);
  return text;
}

// The scene's own values go together, its reader has seen to it: what does not, the options have done.
void require_countable(const Options& options, const rheo::TimeSettings& time) {
  if (const double outputs = time.duration * time.frame_rate; !(outputs <= time.most_outputs)) {
    throw Failure(
        ExitCode::usage,
        fmt::format("{}: {:.3g} outputs, {:g} per second for {:g} s, {} of memory for their names alone; at "
                    "most {:.0e} are allowed, unless --output-limit says more",
                    typed("--duration", options.duration, "--frame-rate", options.frame_rate), outputs,
                    time.frame_rate, time.duration, rheo::memory_text(rheo::bytes_an_output * outputs),
                    time.most_outputs));
  }
  if (time.step == 0.0) return;
  if (const double steps = time.duration / time.step; !(steps <= rheo::max_steps)) {
    throw Failure(ExitCode::usage,
                  fmt::format("{}: {:.3g} steps of {:g} s in {:g} s; at most {:.0e} are allowed",
                              typed("--step", options.step, "--duration", options.duration), steps, time.step,
                              time.duration, rheo::max_steps));
  }
}

}  // namespace

rheo::Scene load_scene(const Options& options) {
  rheo::Scene scene = rheo::read_scene(options.scene, options.read);
  if (options.integrator) scene.time.integrator = *options.integrator;
  // What the command line says of the step, the tolerance or the accuracy stands for all that the scene says.
  if (options.step || options.tolerance) scene.time.accuracy = 0.0;
  if (options.step) scene.time.step = options.step->value;
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
  if (options.duration) scene.time.duration = options.duration->value;
  if (options.frame_rate) scene.time.frame_rate = options.frame_rate->value;
  require_countable(options, scene.time);
  if (options.color) scene.picture.color = *options.color;
  if (options.branch) {
    const std::size_t most = rheo::most_branches(scene);
    if (static_cast<std::size_t>(*options.branch) > most)
      throw Failure(
          ExitCode::usage,
          fmt::format("--branch '{}': the scene's materials have {} Maxwell branch{}, 0 is all of them",
                      *options.branch, most, most == 1 ? "" : "es"));
    scene.picture.branch = *options.branch;
  }
  if (options.every) scene.picture.every = *options.every;
  if (options.size) scene.picture.size = *options.size;
  if (options.range) {
    scene.picture.range_auto = options.range->automatic;
    if (!options.range->automatic) scene.picture.range = options.range->limits;
  }
  rheo::validate(scene);
  return scene;
}

}  // namespace app
