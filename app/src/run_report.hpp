// run.json: what is needed to do a run again and what it cost.
//
//   rheo, compiler, build_type, toolchain, libraries, command_line, working_directory, scene_file, scene (its
//   text), read_files (path, bytes, fnv1a_64 of each file that the scene names), title
//   settings: integrator, step_asked (seconds or "auto"), step_bound, largest_step (used), stable_step,
//   tolerance (exponential only), plan (of an accuracy: as AccuracyPlan, or null), duration, frame_rate,
//   threads, renderer mesh: nodes, triangles; outputs; files; counters; seconds by phase; notes; warnings;
//   exit_status; divergence or null
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

#include "command_line.hpp"
#include "failure.hpp"
#include "phase_clock.hpp"
#include "rheo/simulation.hpp"

namespace app {

// Which content a file had. Not against forgery: FNV-1a is a checksum.
struct Fingerprint {
  std::string path;  // as opened, from the working directory
  std::optional<std::uint64_t> bytes;
  std::optional<std::uint64_t>
      fnv1a;  // FNV-1a, 64 bits; both empty where it is a pipe and cannot be read twice
};

Fingerprint fingerprint(const std::string& path);

struct RunReport {
  std::string scene_text;
  std::string renderer;  // empty: nothing was drawn
  std::int64_t outputs = 0;
  std::vector<Fingerprint> read_files;
  std::vector<std::string> files;
  std::vector<std::string> notes;
  std::vector<std::string> warnings;
  Seconds seconds;
  std::optional<rheo::Divergence> divergence;
};

void write_run_report(const std::filesystem::path& file, const Options& options,
                      const rheo::Simulation& simulation, const RunReport& report);

}  // namespace app
