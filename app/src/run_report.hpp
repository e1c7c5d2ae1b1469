// run.json: what is needed to do a run again and what it cost.
//
//   rheo, compiler, build_type, command_line, scene_file, scene (its text), title
//   settings: integrator, step_asked (0: auto), step_bound, largest_step (used), stable_step,
//   tolerance (exponential only), duration, frame_rate, threads, renderer mesh: nodes, triangles; outputs;
//   files; counters; seconds by phase; notes; warnings; exit_status; divergence or null
//
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

struct RunReport {
  std::string scene_text;
  std::string renderer;  // empty: nothing was drawn
  std::int64_t outputs = 0;
  double largest_step = 0.0;  // [s]
  std::vector<std::string> files;
  std::vector<std::string> warnings;
  Seconds seconds;
  std::optional<rheo::Divergence> divergence;
};

void write_run_report(const std::filesystem::path& file, const Options& options,
                      const rheo::Simulation& simulation, const RunReport& report);

}  // namespace app
