#include "runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "failure.hpp"
#include "history_file.hpp"
#include "linearity_watch.hpp"
#include "memory_need.hpp"
#include "option_values.hpp"
#include "output_folder.hpp"
#include "overrides.hpp"
#include "phase_clock.hpp"
#include "progress.hpp"
#include "recorder.hpp"
#include "rheo/io/results.hpp"
#include "rheo/simulation.hpp"
#include "run_notes.hpp"
#include "run_report.hpp"
#include "scene_parts.hpp"
#include "sequence.hpp"
#include "vtu_series.hpp"

namespace app {
namespace {

struct Sink {
  OutputSink* sink;
  double* seconds;  // where its time is booked
};

struct Passed {
  std::int64_t outputs = 0;  // completed
  std::optional<rheo::Divergence> divergence;
};

// Pass 1: from 0 to the duration, every sink at every output.
Passed simulate(rheo::Simulation& simulation, const std::vector<Sink>& sinks, Progress& progress,
                Seconds& seconds) {
  const rheo::TimeSettings& time = simulation.scene().time;
  const std::int64_t count = rheo::output_count(time);
  Passed passed;
  const auto advance = [&](double t) {
    const Timed timed(seconds.simulate);
    return simulation.advance(t);
  };
  progress.begin("simulating", count);
  for (std::int64_t k = 0; k < count; ++k) {
    passed.divergence = advance(rheo::output_time(time, k));
    if (passed.divergence) return passed;
    for (const Sink& each : sinks) {
      const Timed timed(*each.seconds);
      each.sink->record(simulation, k);
    }
    passed.outputs = k + 1;
    progress.update(passed.outputs);
  }
  // The last output may lie before the duration.
  passed.divergence = advance(time.duration);
  progress.end();
  return passed;
}

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

// All that a run may write: one that diverges leaves some of it out.
std::vector<std::string> files_to_come(const Options& options, const rheo::TimeSettings& time) {
  std::vector<std::string> names{"history.csv", "state.csv"};
  const bool pictures = options.command == Command::render;
  for (std::int64_t k = 0; k < rheo::output_count(time); ++k) {
    if (options.vtu) names.push_back(vtu_name(k));
    if (pictures) names.push_back(frame_name(k));
  }
  if (options.vtu) names.push_back("vtu/state.pvd");
  if (pictures) names.insert(names.end(), {"sheet.png", "residual.png"});
  return names;
}

// One line a file; frames and .vtu files as one line each.
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

}  // namespace

void run_scene(const Options& options) {
  Progress progress(options.quiet ? Verbosity::quiet : Verbosity::normal);
  RunReport report;
  Seconds& seconds = report.seconds;

  std::optional<Timed> timed(seconds.read);
  rheo::Scene scene = load_scene(options);
  report.scene_text = file_text(options.scene);
  for (const std::string& file : scene.files) report.read_files.push_back(fingerprint(file));
  require_memory(scene, options);
  timed.emplace(seconds.build);
  rheo::SimulationOptions simulation_options = options.simulation;
  simulation_options.planning = trial_runs_on(progress);
  rheo::Simulation simulation(std::move(scene), simulation_options);
  progress.end();
  timed.emplace(seconds.draw);
  std::optional<Sequence> sequence;
  if (options.command == Command::render) sequence.emplace(simulation.scene().picture, options);
  if (sequence) report.renderer = sequence->description();
  timed.reset();

  OutputFolder folder(options.folder, options.force ? Replace::earlier_run : Replace::nothing);
  // Whatever is in the way of the files to come shows now, not after the simulation.
  if (options.vtu) folder.expect_series(vtu_name(0));
  if (sequence) folder.expect_series(frame_name(0));
  std::optional<Recorder> recorder;
  if (sequence) recorder.emplace(simulation.scene(), folder.path());
  folder.clear();
  report.notes = run_notes(simulation.scene());
  for (std::string& note : plan_notes(simulation, options.simulation))
    report.notes.push_back(std::move(note));
  for (const std::string& note : report.notes) progress.line("note: " + note);
  report.files = folder.free_of(files_to_come(options, simulation.scene().time));
  report.files.push_back("run.json");
  write_run_report(folder.file("run.json"), options, simulation, report);
  HistoryFile history(folder.file("history.csv"), simulation.scene());
  LinearityWatch watch(progress);
  std::vector<Sink> sinks{{&history, &seconds.write}, {&watch, &seconds.write}};
  std::optional<VtuSeries> vtu;
  if (options.vtu) sinks.push_back({&vtu.emplace(folder), &seconds.write});
  if (recorder) sinks.push_back({&*recorder, &seconds.write});

  const Passed passed = simulate(simulation, sinks, progress, seconds);
  progress.end();

  timed.emplace(seconds.write);
  history.commit();
  folder.made("history.csv");
  if (!passed.divergence) {
    rheo::write_state_csv(folder.file("state.csv"), simulation.scene().mesh,
                          {simulation.u(), simulation.v(), simulation.w_lambda(), simulation.w_mu()},
                          {simulation.scene().bodies, simulation.scene().region_of_triangle});
    folder.made("state.csv");
  }
  if (vtu) vtu->finish();
  timed.reset();

  if (recorder && nothing_to_colour(simulation.scene().picture, *recorder)) {
    report.notes.push_back(fmt::format("{} is zero everywhere and always: there is nothing to colour",
                                       name_of(simulation.scene().picture.color)));
    progress.line("note: " + report.notes.back());
  }
  if (sequence) {
    sequence->draw(simulation.scene(), *recorder, history, folder, progress, seconds);
    report.color_values = recorder->color_values();
    report.drawing = sequence->counters();
  }

  folder.made("run.json");
  report.outputs = passed.outputs;
  report.files = folder.all_made();
  report.warnings = watch.warnings();
  report.divergence = passed.divergence;
  report.exit_status = passed.divergence ? ExitCode::diverged : ExitCode::done;
  write_run_report(folder.file("run.json"), options, simulation, report);

  summarise(simulation.counters(), seconds, sequence ? passed.outputs : 0, progress);
  list_files(folder, progress);
  if (passed.divergence) throw Failure(ExitCode::diverged, divergence_text(*passed.divergence, simulation));
}

}  // namespace app
