#include "run_report.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <CLI/Version.hpp>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "option_values.hpp"
#include "rheo/io/atomic_file.hpp"
#include "rheo/versions.hpp"
#include "scene_parts.hpp"
#include "state_hash.hpp"

namespace app {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity: a limit that does not exist becomes null.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json plan_of(const std::optional<rheo::AccuracyPlan>& plan) {
  if (!plan) return nullptr;
  return {{"accuracy", plan->accuracy},
          {"integrator", name_of(plan->integrator)},
          {"step", plan->step > 0.0 ? Json(plan->step / plan->refinement) : Json(nullptr)},
          {"tolerance", plan->tolerance > 0.0 ? Json(plan->tolerance) : Json(nullptr)},
          {"estimated_error", plan->estimate},
          {"force_evaluations", plan->evaluations},
          {"trial_force_evaluations", plan->trial_evaluations},
          {"why", plan->why}};
}

Json settings_of(const Options& options, const rheo::Simulation& simulation, const RunReport& report) {
  const rheo::TimeSettings& time = simulation.scene().time;
  Json json;
  json["integrator"] = name_of(time.integrator);
  json["kernel"] = simulation.kernel();
  json["step_asked"] = time.step > 0.0 ? Json(time.step) : Json("auto");
  if (simulation.plan()) json["step_asked"] = "auto";
  json["step_bound"] = number(simulation.step_bound());
  json["largest_step"] = number(simulation.largest_step());
  json["stable_step"] = number(simulation.stable_step());
  json["tolerance"] =
      time.integrator == rheo::IntegratorKind::exponential ? Json(time.tolerance) : Json(nullptr);
  json["plan"] = plan_of(simulation.plan());
  json["duration"] = time.duration;
  json["frame_rate"] = time.frame_rate;
  json["every"] = report.renderer.empty() ? Json(nullptr) : Json(simulation.scene().picture.every);
  json["threads"] = simulation.threads();
  json["encoder_threads"] = options.threads;
  json["renderer"] = report.renderer.empty() ? Json(nullptr) : Json(report.renderer);
  return json;
}

Json toolchain() {
  Json json{{"compiler", RHEO_COMPILER}, {"standard", __cplusplus}};
#ifdef __GLIBCXX__
  json["standard_library"] = fmt::format("libstdc++ {}", __GLIBCXX__);
#endif
#ifdef _LIBCPP_VERSION
  json["standard_library"] = fmt::format("libc++ {}", _LIBCPP_VERSION);
#endif
  utsname system{};
  if (uname(&system) == 0) json["system"] = fmt::format("{} {}", system.sysname, system.machine);
  return json;
}

Json libraries() {
  Json json = {
      {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
      {"CLI11", CLI11_VERSION},
      {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                    NLOHMANN_JSON_VERSION_PATCH)}};
  for (const auto& [name, version] : rheo::library_versions()) json[name] = version;
  return json;
}

Json read_files_of(const std::vector<Fingerprint>& files) {
  Json json = Json::array();
  for (const Fingerprint& file : files)
    json.push_back({{"path", file.path},
                    {"bytes", file.bytes ? Json(*file.bytes) : Json(nullptr)},
                    {"fnv1a_64", file.fnv1a ? Json(fmt::format("{:016x}", *file.fnv1a)) : Json(nullptr)}});
  return json;
}

Json counters_of(const rheo::Counters& counters, const RunReport& report) {
  return {{"steps", counters.steps},
          {"force_evaluations", counters.force_evaluations},
          {"branch_updates", counters.branch_updates},
          {"displacement_updates", counters.displacement_updates},
          {"mass_solves", counters.mass_solves},
          {"constraint_solves", counters.constraint_solves},
          {"projections", counters.projections},
          {"energy_samples", counters.energy_samples},
          {"norms", report.norms},
          {"steps_at_rest", counters.steps_at_rest},
          {"flushed_steps", counters.flushed_steps},
          {"factors", counters.factors},
          {"shifted_solves", counters.shifted_solves},
          {"color_values", report.color_values},
          {"frames_drawn", report.drawing.frames_drawn},
          {"frames_repeated", report.drawing.frames_repeated},
          {"mesh_uploads", report.drawing.mesh_uploads}};
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

Fingerprint fingerprint(const std::string& path) {
  Fingerprint result{.path = path, .bytes = {}, .fnv1a = {}};
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return result;
  std::ifstream file(path, std::ios::binary);
  std::uint64_t hash = 0xcbf29ce484222325u, bytes = 0;
  std::array<char, 65536> block{};
  while (file.read(block.data(), block.size()), file.gcount() > 0) {
    const auto count = static_cast<std::size_t>(file.gcount());
    for (std::size_t i = 0; i < count; ++i)
      hash = (hash ^ static_cast<unsigned char>(block[i])) * 0x100000001b3u;
    bytes += count;
  }
  if (bytes == 0) return result;  // the reader found something in it: it cannot be read now
  result.bytes = bytes;
  result.fnv1a = hash;
  return result;
}

namespace {

// What both kinds of report begin with.
template <typename Report>
Json beginning(const Options& options, const rheo::Scene& scene, const Report& report) {
  Json json;
  json["rheo"] = RHEO_VERSION;
  json["compiler"] = RHEO_COMPILER;
  json["build_type"] = RHEO_BUILD_TYPE;
  json["toolchain"] = toolchain();
  json["libraries"] = libraries();
  json["command_line"] = options.words;
  std::error_code gone;
  json["working_directory"] = std::filesystem::current_path(gone).string();
  json["scene_file"] = options.scene.string();
  json["scene"] = report.scene_text;
  json["read_files"] = read_files_of(report.read_files);
  json["title"] = scene.title;
  return json;
}

void write(const std::filesystem::path& path, const Json& json) {
  rheo::AtomicFile file(path);
  // A path may hold bytes that are no UTF-8; they are replaced rather than refused after all the work.
  file.write(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  file.commit();
}

Json mesh_of(const rheo::Scene& scene) {
  return {{"nodes", scene.mesh.node_count()}, {"triangles", scene.mesh.triangle_count()}};
}

Json run_of(const Row& row) {
  const Setting& setting = row.setting;
  return {{"integrator", name_of(setting.integrator)},
          {"step_asked", setting.step > 0.0 ? Json(setting.step) : Json("auto")},
          {"tolerance", setting.tolerance > 0.0 ? Json(setting.tolerance) : Json(nullptr)},
          {"kernel", row.kernel},
          {"threads", row.threads},
          {"largest_step", row.largest_step},
          {"force_evaluations", row.force_evaluations},
          {"seconds", row.seconds},
          {"error", number(row.error)}};
}

Json pair_of(const rheo::Moduli& moduli) {
  return {{"lambda", moduli.lambda}, {"mu", moduli.mu}};
}

Json material_of(const rheo::Material& material) {
  Json branches = Json::array();
  for (std::size_t k = 0; k < material.branch_count(); ++k) {
    const rheo::MaxwellBranch b = material.branch(k);
    branches.push_back({{"lambda_ela", b.lambda_ela},
                        {"mu_ela", b.mu_ela},
                        {"lambda_vis", number(b.lambda_vis)},
                        {"mu_vis", number(b.mu_vis)}});
  }
  return {{"maxwell", branches},
          {"elastic", pair_of(material.elastic)},
          {"viscous", pair_of(material.viscous)},
          {"density", material.density}};
}

Json bodies_of(const rheo::Scene& scene) {
  Json bodies = Json::array();
  for (const rheo::BodyPart& body : scene.bodies)
    bodies.push_back({{"name", body.name},
                      {"nodes", body.node_count},
                      {"triangles", body.triangle_count},
                      {"materials", materials_in(scene, body)}});
  return bodies;
}

Json fit_of(const std::optional<rheo::MeasuredMaterial>& measured) {
  if (!measured) return nullptr;
  const rheo::PronySeries& series = measured->fit.series;
  Json terms = Json::array();
  for (const rheo::PronyTerm& term : series.terms)
    terms.push_back({{"modulus", term.modulus}, {"time", term.time}});
  return {{"file", measured->file},
          {"terms", terms},
          {"elastic", series.elastic},
          {"viscous", series.viscous},
          {"error_rms", measured->fit.rms},
          {"error_largest", measured->fit.largest},
          {"error_largest_at", measured->fit.largest_at}};
}

Json materials_json(const rheo::Scene& scene) {
  Json materials = Json::array();
  for (const MaterialPart& part : materials_of(scene)) {
    Json json{{"number", part.number}, {"name", part.name}, {"triangles", part.triangles}};
    json.update(material_of(*part.material));
    json["preset"] = part.origin->preset.empty() ? Json(nullptr) : Json(part.origin->preset);
    json["fit"] = fit_of(part.origin->measured);
    materials.push_back(std::move(json));
  }
  return materials;
}

}  // namespace

void write_check_report(const std::filesystem::path& path, const Options& options, const rheo::Scene& scene,
                        const CheckReport& report) {
  Json json = beginning(options, scene, report);
  json["preset"] = scene.origin.preset.empty() ? Json(nullptr) : Json(scene.origin.preset);
  json["material"] = material_of(scene.material);
  json["fit"] = fit_of(scene.origin.measured);
  json["bodies"] = bodies_of(scene);
  json["materials"] = materials_json(scene);
  json["files"] = report.files;
  json["notes"] = report.notes;
  json["exit_status"] = static_cast<int>(ExitCode::done);
  write(path, json);
}

std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw Failure(ExitCode::file, fmt::format("{}: cannot read the scene", path.string()));
  return text;
}

void write_bench_report(const std::filesystem::path& path, const Options& options, const rheo::Scene& scene,
                        const BenchReport& report) {
  Json json = beginning(options, scene, report);
  json["mesh"] = mesh_of(scene);
  json["exact"] = {{"method", report.reference.method},
                   {"check", report.reference.check},
                   {"uncertainty", report.reference.uncertainty}};
  json["runs"] = Json::array();
  for (const Row& row : report.runs.rows) json["runs"].push_back(run_of(row));
  json["forecasts"] = report.runs.forecasts;
  json["left_out"] = Json::array();
  for (const LeftOut& left : report.runs.left_out)
    json["left_out"].push_back({{"what", left.what}, {"why", left.why}});
  json["advice"] = report.advice;
  json["files"] = report.files;
  json["notes"] = report.notes;
  json["exit_status"] = static_cast<int>(ExitCode::done);
  write(path, json);
}

void write_run_report(const std::filesystem::path& path, const Options& options,
                      const rheo::Simulation& simulation, const RunReport& report) {
  const rheo::Scene& scene = simulation.scene();
  Json json = beginning(options, scene, report);
  json["settings"] = settings_of(options, simulation, report);
  json["mesh"] = mesh_of(scene);
  json["bodies"] = bodies_of(scene);
  json["materials"] = materials_json(scene);
  json["outputs"] = report.outputs;
  json["state_hash"] = report.exit_status ? Json(state_hash(simulation)) : Json(nullptr);
  json["files"] = report.files;
  json["counters"] = counters_of(simulation.counters(), report);
  json["seconds"] = seconds_of(report.seconds);
  json["notes"] = report.notes;
  json["warnings"] = report.warnings;
  json["exit_status"] = report.exit_status ? Json(static_cast<int>(*report.exit_status)) : Json(nullptr);
  json["divergence"] = divergence_of(report.divergence);
  write(path, json);
}

}  // namespace app
