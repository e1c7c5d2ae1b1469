// What the user sees while waiting: a bar on a terminal, a plain line now and then elsewhere, nothing when
// quiet.
//
// Standard error carries the bar only, and only on a terminal; lines go to standard output, so that a failure
// is the one line on standard error.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

namespace app {

enum class Verbosity { normal, quiet };

class Progress {
 public:
  explicit Progress(Verbosity verbosity);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { end(); }

  void begin(std::string phase, std::int64_t total);
  void update(std::int64_t done);
  void end();
  // A line for the user, above the bar.
  void line(const std::string& text);

 private:
  void clear_bar();

  bool quiet_;
  bool terminal_;
  bool bar_shown_ = false;
  std::string phase_;
  std::int64_t total_ = 0;
  std::chrono::steady_clock::time_point start_, shown_;
};

// For SimulationOptions::planning: a phase a trial run.
std::function<void(int, double)> trial_runs_on(Progress& progress);
// For SimulationOptions::searching.
std::function<void(double)> stable_step_on(Progress& progress);

}  // namespace app
