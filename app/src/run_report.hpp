// run.json: what is needed to do a run again and what it cost.
//
//   rheo, compiler, build_type, toolchain, libraries, command_line, working_directory, scene_file, scene (its
//   text), read_files (path, bytes, fnv1a_64 of each file that the scene names), title
//   settings: integrator, kernel (csr, edge or element), step_asked (seconds or "auto"), step_bound,
//   largest_step (used), stable_step, tolerance (exponential only), plan (of an accuracy: as AccuracyPlan, or
//   null), duration, frame_rate, threads, encoder_threads, renderer mesh: nodes, triangles
//   bodies: name, nodes, triangles, materials (their numbers) of each of several
//   materials: number, name, triangles and all numbers of each
//   outputs; state_hash: the state's bits at the end (state_hash.hpp); files;
//   counters; seconds by phase; notes; warnings; exit_status; divergence or null. Of a run that was gone on
//   with: counters of all of it, seconds up to its latest checkpoint and from there on, drawing counted anew
//
// A run writes it twice: when it begins, with exit_status null, nothing counted yet and as files those to
// come where nothing stands so far; and when it ends, in the place of that.
//
// Counters: what was done, so that what a scene does not need shows as 0
//
//   steps, force_evaluations    of the integrator; each evaluation both products, J_lambda w and J_mu w
//   mass_solves                 with the consistent mass; 0 where it is lumped
//   constraint_solves           for Lagrange multipliers; 0 where constraints are eliminated or absent
//   projections                 velocity jumps where constraints begin
//   energy_samples              looks at the energies: after every step, with --no-energies at outputs and
//                               every 16th step only
//   norms                       of w_lambda and of w_mu over all nodes: at outputs only
//   steps_at_rest               steps that were not taken because nothing moved and nothing acted
//   flushed_steps               steps with denormal numbers taken for zero, which are slow: all, on x86-64
//   color_values                colours computed: nodes times outputs; 0 without pictures and with color =
//                               "none"
//   frames_drawn, _repeated     whole frames drawn; frames taken from the one before but for their time
//   mesh_uploads                of positions and colours to the graphics library: those that had changed
//
// Source   FNV-1a: Fowler, Noll and Vo, IETF draft-eastlake-fnv; offset basis 0xcbf29ce484222325, prime
//          0x100000001b3
// Units    SI
// Errors   rheo::Error::Kind::file
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench_runs.hpp"
#include "command_line.hpp"
#include "failure.hpp"
#include "phase_clock.hpp"
#include "rheo/simulation.hpp"
#include "sequence.hpp"

namespace app {

// Which content a file had. Not against forgery: FNV-1a is a checksum.
struct Fingerprint {
  std::string path;  // as opened, from the working directory
  std::optional<std::uint64_t> bytes;
  std::optional<std::uint64_t>
      fnv1a;  // FNV-1a, 64 bits; both empty where it is a pipe and cannot be read twice
};

Fingerprint fingerprint(const std::string& path);

// The scene's file as it is; the reader has accepted it a moment ago. Errors: Failure(file)
std::string file_text(const std::filesystem::path& path);

struct RunReport {
  std::string scene_text;
  std::string renderer;  // empty: nothing was drawn
  std::int64_t outputs = 0;
  std::int64_t norms = 0;
  std::int64_t color_values = 0;
  DrawCounters drawing;
  std::vector<Fingerprint> read_files;
  std::vector<std::string> files;
  std::vector<std::string> notes;
  std::vector<std::string> warnings;
  Seconds seconds;
  std::optional<ExitCode> exit_status;  // empty: the run has not ended
  std::optional<rheo::Divergence> divergence;
};

// Of bench: exact (how errors were measured), runs (all that the table shows, every run's seconds), left_out
// and advice take the place of settings, outputs, counters and seconds.
struct BenchReport {
  std::string scene_text;
  std::vector<Fingerprint> read_files;
  std::vector<std::string> files;
  std::vector<std::string> notes;
  Reference reference;
  Rows runs;
  std::string advice;
};

// Of check --plot: the materials' numbers and the fits' take the place of settings, outputs, counters and
// seconds; preset, material and fit are those of material 0.
struct CheckReport {
  std::string scene_text;
  std::vector<Fingerprint> read_files;
  std::vector<std::string> files;
  std::vector<std::string> notes;
};

void write_check_report(const std::filesystem::path& file, const Options& options, const rheo::Scene& scene,
                        const CheckReport& report);

void write_bench_report(const std::filesystem::path& file, const Options& options, const rheo::Scene& scene,
                        const BenchReport& report);

void write_run_report(const std::filesystem::path& file, const Options& options,
                      const rheo::Simulation& simulation, const RunReport& report);

}  // namespace app
