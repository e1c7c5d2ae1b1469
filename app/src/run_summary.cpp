#include "run_summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "option_values.hpp"
#include "scene_parts.hpp"

namespace app {

std::string divergence_text(const rheo::Divergence& divergence, const rheo::Simulation& simulation) {
  const rheo::TimeSettings& time = simulation.scene().time;
  const rheo::Vec2 at = simulation.scene().mesh.points[static_cast<std::size_t>(divergence.node)];
  const std::string where =
      fmt::format("diverged at t = {:.6g} s at {} (at rest x = {:.4g} m, y = {:.4g} m)", divergence.t,
                  node_text(simulation.scene(), divergence.node), at.x, at.y);
  const double used = simulation.step_bound(), stable = divergence.stable_step;
  if (stable <= 0.0)
    return fmt::format("{}: no step of {} is stable for this scene, {:.4g} s was used: use --integrator rk4",
                       where, name_of(time.integrator), used);
  if (time.integrator == rheo::IntegratorKind::implicit)
    return fmt::format(
        "{}: the factor for implicit steps of {:.4g} s has too few correct digits: take smaller ones with "
        "--step, and check the scene's loads and motions",
        where, simulation.largest_step());
  if (std::isinf(stable))
    return fmt::format(
        "{}: {} could not reach its tolerance of {:g}: check the scene's loads and motions, or try "
        "--integrator rk4",
        where, name_of(time.integrator), time.tolerance);
  if (used > stable)
    return fmt::format(
        "{}: the step of {:.4g} s is beyond the stable step of {}, {:.4g} s: use --step auto or less "
        "than that",
        where, used, name_of(time.integrator), stable);
  return fmt::format(
      "{}: the step of {:.4g} s is within the stable step of {}, {:.4g} s: halve it with --step and "
      "check the scene's loads and motions",
      where, used, name_of(time.integrator), stable);
}

void list_files(const OutputFolder& folder, Progress& progress) {
  const std::vector<std::string>& files = folder.all_made();
  const auto path = [&](const std::string& name) { return (folder.path() / name).string(); };
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::size_t last = i;
    for (const std::string_view series : {"frames/frame_", "vtu/state_"})
      while (files[i].starts_with(series) && last + 1 < files.size() && files[last + 1].starts_with(series))
        ++last;
    if (last == i)
      progress.line(path(files[i]));
    else
      progress.line(fmt::format("{} ... {} ({} files)", path(files[i]),
                                files[last].substr(files[last].rfind('/') + 1), last - i + 1));
    i = last;
  }
}

void summarise(const rheo::Counters& counters, const Seconds& seconds, std::int64_t frames,
               Progress& progress) {
  progress.line(fmt::format("{} steps{}, {} force evaluations", counters.steps,
                            counters.steps_at_rest > 0
                                ? fmt::format(" ({} more were not needed: at rest)", counters.steps_at_rest)
                                : std::string(),
                            counters.force_evaluations));
  std::string line = fmt::format("seconds: read {:.3f}, build {:.3f}, simulate {:.3f}, write {:.3f}",
                                 seconds.read, seconds.build, seconds.simulate, seconds.write);
  if (frames > 0)
    line += fmt::format(", draw {:.3f}, encode {:.3f} ({:.0f} frames/s)", seconds.draw, seconds.encode,
                        static_cast<double>(frames) / (seconds.draw + seconds.encode));
  progress.line(line);
}

}  // namespace app
