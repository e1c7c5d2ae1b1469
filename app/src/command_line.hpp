// The command line as plain data.
//
// Errors   Failure(usage), one line that names the option, its value and what is allowed
// Not here what the options do to a scene (overrides.hpp)
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rheo/io/read_options.hpp"
#include "rheo/scene.hpp"
#include "rheo/simulation.hpp"

namespace app {

enum class Command { run, render, view, check, bench };
enum class DrawBackend { automatic, osmesa, egl };

struct ColorRange {
  bool automatic = true;
  std::array<double, 2> limits{0.0, 1.0};
};

// An override that may not fit the scene's other values: a refusal then shows it as it was typed.
struct TypedNumber {
  double value = 0.0;
  std::string text;
};

struct Options {
  Command command = Command::run;
  std::filesystem::path scene;
  std::filesystem::path folder;    // of the outputs
  std::vector<std::string> words;  // the command line as it was typed

  // Overrides of the scene's [time] and [render]; empty: as the scene says.
  std::optional<rheo::IntegratorKind> integrator;
  std::optional<TypedNumber> step;  // [s]; 0: auto
  std::optional<double> tolerance;  // integrator exponential only
  std::optional<double> accuracy;
  std::optional<TypedNumber> duration;
  std::optional<TypedNumber> frame_rate;
  std::optional<rheo::ColorBy> color;
  std::optional<int> branch;
  std::optional<ColorRange> range;
  std::optional<std::array<int, 2>> size;
  std::optional<int> every;

  DrawBackend backend = DrawBackend::automatic;
  int threads = 2;            // encoders of the frame sequence
  std::optional<int> sheet;   // shapes on the sheet; empty: 8 to 12, as suits the run
  std::filesystem::path csv;  // bench: its table; empty: into the folder
  double budget = 60.0;       // bench: seconds
  double close_after = 0.0;   // view: seconds; 0: never
  bool vtu = false;
  bool plot = false;  // check: the material's curves into the folder
  bool force = false;
  bool resume = false;
  double checkpoint_seconds = 10.0;  // of wall time between checkpoints; 0: at every output; infinite: never
  bool keeps_checkpoint = false;     // the end's: where the above was asked for
  std::filesystem::path from;        // a checkpoint to begin with; empty: at rest
  rheo::SimulationOptions simulation;
  bool quiet = false;
  rheo::ReadOptions read;
};

// nullopt: help or the version was asked for and printed.
std::optional<Options> read_command_line(int argc, char** argv);

}  // namespace app
