#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "printable.hpp"

namespace app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto bar_interval = std::chrono::milliseconds(100);
constexpr auto line_interval = std::chrono::seconds(10);
constexpr int bar_width = 30;

// A run is worth more than its lines: what cannot be printed shows at the program's end (program.cpp).
void print(std::FILE* stream, const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stream);
}

std::string duration_text(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

}  // namespace

Progress::Progress(Verbosity verbosity) : quiet_(verbosity == Verbosity::quiet), terminal_(isatty(2) == 1) {}

void Progress::begin(std::string phase, std::int64_t total) {
  end();
  phase_ = std::move(phase);
  total_ = std::max<std::int64_t>(total, 1);
  start_ = shown_ = Clock::now();
}

void Progress::update(std::int64_t done) {
  if (quiet_ || total_ == 0) return;
  const auto now = Clock::now();
  if (now - shown_ < (terminal_ ? Clock::duration(bar_interval) : Clock::duration(line_interval))) return;
  shown_ = now;
  const double share = std::clamp(static_cast<double>(done) / static_cast<double>(total_), 0.0, 1.0);
  const double passed = std::chrono::duration<double>(now - start_).count();
  const std::string left = share > 0.0 ? duration_text(passed / share * (1.0 - share)) + " left" : "";
  if (terminal_) {
    const int full = static_cast<int>(share * bar_width);
    print(stderr, fmt::format("\r\x1b[K{:<10} [{:#>{}}{:.>{}}] {:3.0f} %  {}", phase_, "", full, "",
                              bar_width - full, 100.0 * share, left));
    std::fflush(stderr);
    bar_shown_ = true;
  } else {
    line(fmt::format("{}: {} of {}, {}", phase_, done, total_, left));
    std::fflush(stdout);
  }
}

void Progress::end() {
  clear_bar();
  total_ = 0;
}

void Progress::line(const std::string& text) {
  if (quiet_) return;
  clear_bar();
  print(stdout, printable(text) + "\n");
}

void Progress::clear_bar() {
  if (!bar_shown_) return;
  print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  bar_shown_ = false;
}

std::function<void(int, double)> trial_runs_on(Progress& progress) {
  return [&progress, shown = 0](int trial, double done) mutable {
    constexpr std::int64_t hundredths = 100;
    if (trial != shown) progress.begin(fmt::format("trial run {}", trial), hundredths);
    shown = trial;
    progress.update(static_cast<std::int64_t>(done * hundredths));
  };
}

std::function<void(double)> stable_step_on(Progress& progress) {
  return [&progress, has_begun = false](double done) mutable {
    constexpr std::int64_t hundredths = 100;
    if (!has_begun) progress.begin("largest stable step", hundredths);
    has_begun = true;
    progress.update(static_cast<std::int64_t>(done * hundredths));
  };
}

}  // namespace app
