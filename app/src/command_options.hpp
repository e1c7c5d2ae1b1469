// The options of the commands in groups: their help, and their texts as they were typed. Values are read and
// refused elsewhere (command_line.hpp, option_values.hpp).
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace app {

inline constexpr int most_threads = 64;
inline constexpr int fewest_shapes = 2;
inline constexpr int most_shapes = 64;
inline constexpr int most_branches = 1000;

// Option texts as they were typed; read after CLI11 has sorted them.
struct Texts {
  std::string scene, folder, integrator, step, tolerance, accuracy, duration, frame_rate, threads;
  std::string size, color, branch, range, every, backend, sheet;
  std::string kernel, csv, budget, seconds, checkpoint, from;
  std::string memory_limit, output_limit;
  bool allow_outside = false;
  bool vtu = false, force = false, resume = false, quiet = false, allow_unstable = false, no_energies = false,
       plot = false;
};

// Of a run to its end, and of the window, which has none and keeps all its books.
void add_time_options(CLI::App& command, Texts& texts);
void add_output_options(CLI::App& command, Texts& texts);
void add_picture_options(CLI::App& command, Texts& texts);
// bench chooses steps and tolerances itself.
void add_bench_options(CLI::App& command, Texts& texts);
void add_plot_options(CLI::App& command, Texts& texts);
void add_view_options(CLI::App& command, Texts& texts);
// A scene may come from a stranger.
void add_limit_options(CLI::App& command, Texts& texts);

}  // namespace app
