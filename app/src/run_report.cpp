#include "run_report.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "option_values.hpp"
#include "rheo/io/atomic_file.hpp"

namespace app {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity: a limit that does not exist becomes null.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json settings_of(const Options& options, const rheo::Simulation& simulation, const RunReport& report) {
  const rheo::TimeSettings& time = simulation.scene().time;
  Json json;
  json["integrator"] = name_of(time.integrator);
  json["kernel"] = simulation.kernel();
  json["step_asked"] = time.step;
  json["step_bound"] = number(simulation.step_bound());
  json["largest_step"] = number(report.largest_step);
  json["stable_step"] = number(simulation.stable_step());
  json["tolerance"] =
      time.integrator == rheo::IntegratorKind::exponential ? Json(time.tolerance) : Json(nullptr);
  json["duration"] = time.duration;
  json["frame_rate"] = time.frame_rate;
  json["threads"] = options.threads;
  json["renderer"] = report.renderer.empty() ? Json(nullptr) : Json(report.renderer);
  return json;
}

Json counters_of(const rheo::Counters& counters) {
  return {{"steps", counters.steps},
          {"force_evaluations", counters.force_evaluations},
          {"mass_solves", counters.mass_solves},
          {"constraint_solves", counters.constraint_solves},
          {"projections", counters.projections}};
}

Json seconds_of(const Seconds& seconds) {
  return {{"read", seconds.read}, {"build", seconds.build},   {"simulate", seconds.simulate},
          {"draw", seconds.draw}, {"encode", seconds.encode}, {"write", seconds.write}};
}

Json divergence_of(const std::optional<rheo::Divergence>& divergence) {
  if (!divergence) return nullptr;
  return {{"t", divergence->t},
          {"node", divergence->node},
          {"energy", number(divergence->energy)},
          {"energy_allowed", number(divergence->allowed)},
          {"stable_step", number(divergence->stable_step)}};
}

}  // namespace

void write_run_report(const std::filesystem::path& path, const Options& options,
                      const rheo::Simulation& simulation, const RunReport& report) {
  const rheo::Scene& scene = simulation.scene();
  Json json;
  json["rheo"] = RHEO_VERSION;
  json["compiler"] = RHEO_COMPILER;
  json["build_type"] = RHEO_BUILD_TYPE;
  json["command_line"] = options.words;
  json["scene_file"] = options.scene.string();
  json["scene"] = report.scene_text;
  json["title"] = scene.title;
  json["settings"] = settings_of(options, simulation, report);
  json["mesh"] = {{"nodes", scene.mesh.node_count()}, {"triangles", scene.mesh.triangle_count()}};
  json["outputs"] = report.outputs;
  json["files"] = report.files;
  json["counters"] = counters_of(simulation.counters());
  json["seconds"] = seconds_of(report.seconds);
  json["notes"] = scene.notes;
  json["warnings"] = report.warnings;
  json["exit_status"] = static_cast<int>(report.divergence ? ExitCode::diverged : ExitCode::done);
  json["divergence"] = divergence_of(report.divergence);

  rheo::AtomicFile file(path);
  // A path may hold bytes that are no UTF-8; they are replaced rather than refused after all the work.
  file.write(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  file.commit();
}

}  // namespace app
