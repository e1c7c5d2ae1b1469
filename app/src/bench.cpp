#include "bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>

#include "bench_picture.hpp"
#include "bench_reference.hpp"
#include "bench_runs.hpp"
#include "bench_table.hpp"
#include "failure.hpp"
#include "memory_need.hpp"
#include "output_folder.hpp"
#include "overrides.hpp"
#include "progress.hpp"
#include "rheo/io/atomic_file.hpp"
#include "run_notes.hpp"
#include "run_report.hpp"

namespace app {
namespace {

constexpr const char* csv_name = "bench.csv";
constexpr const char* picture_name = "bench.png";

// The scene with its own integrator's choice taken back: bench makes all choices itself.
rheo::Scene load(const Options& options) {
  Options neutral = options;
  neutral.integrator.reset();
  return load_scene(neutral);
}

// Refuses what any run of the scene would refuse, before anything is made.
void require_runnable(const rheo::Scene& scene, const rheo::SimulationOptions& options) {
  const rheo::Simulation simulation(scene_with(scene, {}), options);
}

void require_new_file(const std::filesystem::path& file, const Options& options) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw Failure(ExitCode::file, fmt::format("--csv '{}': is a folder: name a file", file.string()));
  if (std::filesystem::exists(file, error) && !options.force)
    throw Failure(ExitCode::usage,
                  fmt::format("--csv '{}': exists: name another file, or add --force, which replaces it",
                              file.string()));
  rheo::AtomicFile probe(file);  // unwritable shows now, not after the runs
}

bool has_marks(const std::vector<Row>& rows) {
  return std::ranges::any_of(rows, [](const Row& row) { return row.error > 0.0 && row.median() > 0.0; });
}

void bench_loaded(const Options& options, const rheo::Scene& scene) {
  const auto start = std::chrono::steady_clock::now();
  Progress progress(options.quiet ? Verbosity::quiet : Verbosity::normal);
  require_runnable(scene, options.simulation);
  BenchReport report;
  report.scene_text = file_text(options.scene);
  for (const std::string& file : scene.files) report.read_files.push_back(fingerprint(file));
  if (!options.csv.empty()) require_new_file(options.csv, options);
  OutputFolder folder(options.folder, options.force ? Replace::earlier_run : Replace::nothing);
  folder.clear();

  progress.line(fmt::format("{}: {} nodes, {} triangles, {} outputs in {:g} s",
                            scene.title.empty() ? options.scene.string() : scene.title,
                            scene.mesh.node_count(), scene.mesh.triangle_count(),
                            rheo::output_count(scene.time), scene.time.duration));
  report.notes = run_notes(scene);
  if (rheo::output_count(scene.time) == 1)
    report.notes.push_back(
        fmt::format("no output but t = 0 lies within the duration: errors are those at its end, t = {:g} s",
                    scene.time.duration));
  const std::string no_drawing = no_picture(scene.picture, options);
  if (!no_drawing.empty()) report.notes.push_back("no picture: " + no_drawing);
  for (const std::string& note : report.notes) progress.line("note: " + note);

  // Shares of the budget: the exact solution, the runs, and what is left for the check, in this order.
  const auto spent = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  report.reference = make_reference(scene, options.simulation, 0.4 * options.budget, progress);
  progress.line("exact: " + report.reference.method);
  const bool to_check = report.reference.by_exponential();
  const double until = (to_check ? 0.8 : 1.0) * options.budget;
  report.runs = bench_runs(scene, options.simulation, report.reference, options.integrator,
                           std::max(until - spent(), 0.1 * options.budget), progress);
  check_reference(report.reference, scene, options.simulation, 0.1 * options.budget, progress);
  if (!report.reference.check.empty()) progress.line("exact: " + report.reference.check);
  for (const std::string& line : table_of(report.runs, report.reference)) progress.line(line);
  report.advice = advice_of(report.runs.rows, report.reference);

  const std::filesystem::path csv = options.csv.empty() ? folder.file(csv_name) : options.csv;
  rheo::AtomicFile file(csv);
  file.write(csv_of(report.runs.rows));
  file.commit();
  if (options.csv.empty()) folder.made(csv_name);
  if (no_drawing.empty() && has_marks(report.runs.rows)) {
    draw_bench(folder.file(picture_name), scene, report.runs.rows, options);
    folder.made(picture_name);
  } else if (no_drawing.empty()) {
    progress.line("note: no picture: no run has an error and a time above 0");
  }
  folder.made("run.json");
  report.files = folder.all_made();
  write_bench_report(folder.file("run.json"), options, scene, report);
  progress.line(report.advice);
  if (!options.csv.empty()) progress.line(csv.string());
  for (const std::string& name : folder.all_made()) progress.line((folder.path() / name).string());
}

}  // namespace

void bench_scene(const Options& options) {
  const rheo::Scene scene = load(options);
  require_memory(scene, options);
  telling_need(scene, options, [&] { bench_loaded(options, scene); });
}

}  // namespace app
