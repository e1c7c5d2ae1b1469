#include "runner.hpp"

#include <fmt/format.h>

#include <cmath>
#include <new>
#include <optional>
#include <string_view>
#include <vector>

#include "failure.hpp"
#include "frame_outputs.hpp"
#include "memory_need.hpp"
#include "option_values.hpp"
#include "output_folder.hpp"
#include "overrides.hpp"
#include "phase_clock.hpp"
#include "progress.hpp"
#include "records.hpp"
#include "rheo/io/results.hpp"
#include "rheo/simulation.hpp"
#include "run_checkpoint.hpp"
#include "run_identity.hpp"
#include "run_notes.hpp"
#include "run_report.hpp"
#include "run_summary.hpp"
#include "sequence.hpp"
#include "sheet_frames.hpp"
#include "stop_signals.hpp"

namespace app {
namespace {

// All that a run may write: one that diverges leaves some of it out.
std::vector<std::string> files_to_come(const Options& options, const rheo::Scene& scene) {
  std::vector<std::string> names{"history.csv", "state.csv", checkpoint_name};
  const std::int64_t outputs = rheo::output_count(scene.time);
  if (options.vtu) {
    for (std::int64_t k = 0; k < outputs; ++k) names.push_back(vtu_name(k));
    names.push_back("vtu/state.pvd");
  }
  if (options.command == Command::render) {
    for (std::int64_t k = 0; k < frame_count(outputs, scene.picture.every); ++k)
      names.push_back(frame_name(k));
    names.insert(names.end(), {"sheet.png", "residual.png"});
  }
  return names;
}

// A run that has ended is not gone on with: what there is to say about it, said.
bool has_ended(const Options& options, Progress& progress) {
  const std::optional<EarlierRun> earlier = find_earlier_run(options.folder);
  if (!earlier || earlier->is_cut()) return false;
  if (earlier->exit_status == static_cast<int>(ExitCode::diverged))
    throw Failure(
        ExitCode::usage,
        fmt::format("{}: the run there has diverged, and would again: change its step or its scene, "
                    "and begin anew with --force",
                    options.folder.string()));
  // Killed after its last word and before its last deed.
  std::error_code ignored;
  std::filesystem::remove(options.folder / "positions.bin.part", ignored);
  progress.line(fmt::format("note: {}: the run there has ended: nothing to resume", options.folder.string()));
  return true;
}

// The checkpoint to go on from; nothing: the run begins anew.
std::optional<CutRun> cut_run(const Options& options) {
  const std::filesystem::path file = options.folder / checkpoint_name;
  const std::optional<EarlierRun> earlier = find_earlier_run(options.folder);
  if (!options.resume || !earlier || !std::filesystem::exists(file)) return std::nullopt;
  rheo::Checkpoint checkpoint = rheo::read_checkpoint(file);
  // That of an end, whose run.json alone was still to come.
  if (checkpoint.companion.empty()) return std::nullopt;
  return std::optional<CutRun>(std::in_place, std::move(checkpoint));
}

// From a scene that is read to the files that are written.
class Run {
 public:
  Run(const Options& options, rheo::Scene scene, RunReport report, Progress& progress);
  void go();

 private:
  void do_all();
  rheo::Simulation build(rheo::Scene scene);
  void open_folder();
  void begin_or_take_up();
  // Pass 1: to the duration, noting every output.
  std::optional<rheo::Divergence> simulate();
  // Pass 2; false where it was told to stop.
  bool draw();
  void write_tables();
  [[noreturn]] void stop(StopSignal signal);
  void finish();
  void write_report() { write_run_report(folder_.file("run.json"), options_, simulation_, report_); }
  void checkpoint() {
    const Timed timed(seconds_.write);
    checkpoint_.write(simulation_, records_, progress_made_, seconds_);
    end_is_kept_ = progress_made_.simulated;
  }

  const Options& options_;
  Progress& progress_;
  RunReport report_;
  Seconds& seconds_ = report_.seconds;
  std::string identity_;
  std::optional<CutRun> cut_;
  rheo::Simulation simulation_;
  std::optional<Sequence> sequence_;
  OutputFolder folder_;
  StopSignals signals_;
  Records records_;
  RunCheckpoint checkpoint_;
  RunProgress progress_made_;
  bool end_is_kept_ = false;  // in the checkpoint: only drawing is left
};

Replace replace_of(const Options& options) {
  return options.resume ? Replace::cut_run : options.force ? Replace::earlier_run : Replace::nothing;
}

std::optional<Sequence> open_sequence(const rheo::Scene& scene, const Options& options, Seconds& seconds) {
  if (options.command != Command::render) return std::nullopt;
  const Timed timed(seconds.draw);
  return std::optional<Sequence>(std::in_place, scene.picture, options);
}

std::vector<std::int64_t> sheet_of(const std::optional<Sequence>& sequence, const rheo::Scene& scene) {
  if (!sequence) return {};
  return sequence->sheet_outputs(scene, rheo::output_count(scene.time));
}

// Everything that can be refused is refused here, before the folder is made or cleared.
Run::Run(const Options& options, rheo::Scene scene, RunReport report, Progress& progress)
    : options_(options),
      progress_(progress),
      report_(std::move(report)),
      identity_(run_identity(options, scene, report_.scene_text, report_.read_files)),
      cut_(cut_run(options)),
      simulation_(build(std::move(scene))),
      sequence_(open_sequence(simulation_.scene(), options, seconds_)),
      folder_(options.folder, replace_of(options)),
      signals_(options.quiet ? StopSignals::Answer::none : StopSignals::Answer::at_terminal),
      records_(simulation_.scene(), folder_, options, sheet_of(sequence_, simulation_.scene()), progress),
      checkpoint_(folder_.path() / checkpoint_name, options.checkpoint_seconds, identity_) {
  if (sequence_) report_.renderer = sequence_->description();
  if (cut_) checkpoint_.adopt();
}

rheo::Simulation Run::build(rheo::Scene scene) {
  if (cut_) cut_->require_same(identity_);
  std::optional<rheo::Checkpoint> start;
  if (!options_.from.empty() && !cut_) start = rheo::read_checkpoint(options_.from);
  const Timed timed(seconds_.build);
  rheo::SimulationOptions simulation_options = options_.simulation;
  simulation_options.planning = trial_runs_on(progress_);
  simulation_options.searching = stable_step_on(progress_);
  rheo::Simulation simulation(std::move(scene), simulation_options);
  progress_.end();
  if (start) rheo::begin_from(simulation, *start);
  return simulation;
}

void Run::open_folder() {
  // Whatever is in the way of the files to come shows now, not after the simulation.
  if (options_.vtu) folder_.expect_series(vtu_name(0));
  if (sequence_) folder_.expect_series(frame_name(0));
  if (cut_)
    folder_.adopt({"history.csv.part", "positions.bin.part"});
  else
    folder_.clear();
}

void Run::begin_or_take_up() {
  const rheo::Scene& scene = simulation_.scene();
  if (cut_) {
    progress_made_ = cut_->take_up(simulation_, records_, seconds_);
    end_is_kept_ = progress_made_.simulated;
    progress_.line(fmt::format("note: goes on after {} of {} outputs, at t = {:.6g} s",
                               progress_made_.outputs, rheo::output_count(scene.time), simulation_.time()));
  } else if (options_.resume) {
    progress_.line(
        fmt::format("note: {}: no checkpoint to go on from: begins at t = 0", options_.folder.string()));
  }
  report_.notes = run_notes(scene);
  for (std::string& note : plan_notes(simulation_, options_.simulation))
    report_.notes.push_back(std::move(note));
  for (const std::string& note : report_.notes) progress_.line("note: " + note);
  report_.files = folder_.free_of(files_to_come(options_, scene));
  report_.files.push_back("run.json");
  write_report();
  if (!cut_) records_.begin();
}

std::optional<rheo::Divergence> Run::simulate() {
  const rheo::TimeSettings& time = simulation_.scene().time;
  const std::int64_t count = rheo::output_count(time);
  const auto advance = [&](double t) {
    const Timed timed(seconds_.simulate);
    return simulation_.advance(t);
  };
  progress_.begin("simulating", count);
  for (std::int64_t k = progress_made_.outputs; k < count; ++k) {
    if (const auto divergence = advance(rheo::output_time(time, k))) return divergence;
    records_.record(simulation_, k, seconds_);
    progress_made_.outputs = k + 1;
    folder_.require_presence();
    if (const auto signal = signals_.asked()) stop(*signal);
    if (checkpoint_.is_due()) checkpoint();
    progress_.update(k + 1);
  }
  // The last output may lie before the duration.
  const auto divergence = progress_made_.simulated ? std::nullopt : advance(time.duration);
  progress_made_.simulated = !divergence;
  progress_.end();
  return divergence;
}

void Run::write_tables() {
  const Timed timed(seconds_.write);
  records_.commit();
  if (!report_.divergence) {
    const rheo::Scene& scene = simulation_.scene();
    rheo::write_state_csv(folder_.file("state.csv"), scene.mesh,
                          {simulation_.u(), simulation_.v(), simulation_.w_lambda(), simulation_.w_mu()},
                          {scene.bodies, scene.region_of_triangle});
    folder_.made("state.csv");
  }
}

bool Run::draw() {
  const Recorder& recorder = *records_.recorder();
  const rheo::Scene& scene = simulation_.scene();
  if (nothing_to_colour(scene.picture, recorder)) {
    report_.notes.push_back(fmt::format("{} is zero everywhere and always: there is nothing to colour",
                                        name_of(scene.picture.color)));
    progress_.line("note: " + report_.notes.back());
  }
  if (!options_.sheet && recorder.count() > 0) {
    for (const std::string& note : notes_on_sheet_times(scene, recorder.count())) {
      report_.notes.push_back(note);
      progress_.line("note: " + note);
    }
  }
  // Frames that are there are whole and as they would be drawn again.
  const auto is_there = [&](std::int64_t k) { return cut_ && folder_.has_own(frame_name(k)); };
  const auto goes_on = [&] {
    folder_.require_presence();
    // Once is enough. (A diverged run's end is none to go on from.)
    if (progress_made_.simulated && !end_is_kept_ && checkpoint_.is_due()) checkpoint();
    return !signals_.asked();
  };
  const bool done = sequence_->draw(scene, recorder, records_.history(), folder_, progress_, seconds_,
                                    {.is_there = is_there, .goes_on = goes_on});
  report_.color_values = recorder.color_values();
  report_.drawing = sequence_->counters();
  return done;
}

void Run::stop(StopSignal signal) {
  progress_.end();
  const bool keeps = std::isfinite(options_.checkpoint_seconds);
  // A diverged run, told to stop while it draws, diverges again from its latest checkpoint or the beginning.
  if (keeps && !end_is_kept_ && !report_.divergence) checkpoint();
  if (checkpoint_.exists()) folder_.made(checkpoint_name);
  folder_.made("run.json");
  report_.outputs = progress_made_.outputs;
  report_.norms = 2 * static_cast<std::int64_t>(records_.history().times().size());
  report_.files = folder_.all_made();
  report_.warnings = records_.warnings();
  report_.exit_status = signal == StopSignal::interrupt ? ExitCode::interrupted : ExitCode::terminated;
  write_report();
  summarise(simulation_.counters(), seconds_, 0, progress_);
  list_files(folder_, progress_);
  throw Failure(*report_.exit_status,
                fmt::format("stopped by {} after {} of {} outputs{}: {}",
                            signal == StopSignal::interrupt ? "SIGINT" : "SIGTERM", progress_made_.outputs,
                            rheo::output_count(simulation_.scene().time),
                            progress_made_.simulated ? ", while drawing" : "",
                            keeps ? "the same command with --resume goes on from there"
                                  : "--force begins anew (and without --checkpoint never it could go on)"));
}

void Run::finish() {
  const bool keeps = options_.keeps_checkpoint && !report_.divergence;
  if (keeps) folder_.made(checkpoint_name);
  folder_.made("run.json");
  report_.outputs = progress_made_.outputs;
  report_.norms = 2 * static_cast<std::int64_t>(records_.history().times().size());
  report_.files = folder_.all_made();
  report_.warnings = records_.warnings();
  report_.exit_status = report_.divergence ? ExitCode::diverged : ExitCode::done;
  if (keeps) rheo::write_checkpoint(folder_.path() / checkpoint_name, simulation_);
  write_report();
  // In this order: a run that is killed in between has ended, and has_ended() sees to what is left.
  records_.discard();
  if (!keeps) checkpoint_.remove();
}

void Run::go() {
  open_folder();
  try {
    do_all();
  } catch (const rheo::Error&) {
    folder_.require_presence();  // else that is why
    throw;
  }
}

void Run::do_all() {
  begin_or_take_up();
  report_.divergence = simulate();
  progress_.end();
  write_tables();
  if (sequence_ && !draw()) stop(*signals_.asked());
  finish();
  const int every = simulation_.scene().picture.every;
  summarise(simulation_.counters(), seconds_, sequence_ ? frame_count(progress_made_.outputs, every) : 0,
            progress_);
  list_files(folder_, progress_);
  if (report_.divergence)
    throw Failure(ExitCode::diverged, divergence_text(*report_.divergence, simulation_));
}

}  // namespace

void run_scene(const Options& options) {
  Progress progress(options.quiet ? Verbosity::quiet : Verbosity::normal);
  if (options.resume && has_ended(options, progress)) return;
  RunReport report;
  rheo::Scene scene;
  // Made while there is memory for it.
  std::string need =
      fmt::format("no room to read {}{}: take a coarser mesh", options.scene.string(), limit_text());
  try {
    {
      const Timed timed(report.seconds.read);
      scene = load_scene(options);
      report.scene_text = file_text(options.scene);
      for (const std::string& file : scene.files) report.read_files.push_back(fingerprint(file));
    }
    if (!options.from.empty() && scene.time.accuracy > 0.0)
      throw Failure(
          ExitCode::usage,
          "--from with an accuracy: steps are chosen for a run that begins at rest: name a --step, or "
          "--integrator exponential with a --tolerance");
    require_memory(scene, options);
    need = memory_text(scene, options, limit_text());
    Run(options, std::move(scene), std::move(report), progress).go();
  } catch (const std::bad_alloc&) {
    throw Failure(ExitCode::file, "out of memory: " + need);
  }
}

}  // namespace app
