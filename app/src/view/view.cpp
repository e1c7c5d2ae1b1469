#include "view/view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include "drawing_room.hpp"
#include "failure.hpp"
#include "program.hpp"
#include "view/display_loss.hpp"
#include "view/glfw_window.hpp"
#include "view/signal_watch.hpp"
#include "view/view_setup.hpp"

namespace app {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

constexpr double longest_wait = 3600.0;
constexpr double minimised_wait = 0.25;  // [s]

std::string title_of(const rheo::Scene& scene) {
  return scene.title.empty() ? "rheo" : scene.title + " - rheo";
}

void print_summary(const view::Ui& ui, Clock::time_point start) {
  const view::Percentiles frames = view::percentiles_of(ui.frame_seconds());
  fmt::print(
      "{} frames in {:.1f} s, median {:.2f} ms, 99th percentile {:.2f} ms a frame; {} steps to t = {:.3f} "
      "s\n",
      ui.frame_count(), seconds_since(start), 1e3 * frames.median, 1e3 * frames.high, ui.shown().steps,
      ui.shown().t);
}

// Whoever finds out that the display is gone waits for a frame that is being drawn, at most so long.
constexpr std::chrono::seconds patience{2};
using DrawingMutex = std::recursive_timed_mutex;

// Frames at the display's rate while something moves; else none until something happens.
void show(view::GlfwWindow& window, view::Ui& ui, const view::SignalWatch& signals, DrawingMutex& drawing,
          double close_after) {
  const Clock::time_point start = Clock::now();
  Clock::time_point last = start;
  std::shared_ptr<const rheo::Scene> scene = ui.shown().scene;
  while (!window.is_closed() && !ui.wants_to_quit() && signals.asked() == 0) {
    const double left = close_after > 0.0 ? close_after - seconds_since(start) : longest_wait;
    if (left <= 0.0) break;
    if (!window.is_visible()) {
      window.wait(std::min(left, minimised_wait));
      continue;
    }
    if (ui.is_lively()) {
      window.poll();
      // Where the display does not hold the swap back.
      while (seconds_since(last) < 0.9 * window.frame_period())
        window.wait(0.95 * window.frame_period() - seconds_since(last));
    } else {
      window.wait(std::min(left, ui.next_change()));
    }
    const double interval = seconds_since(last);
    last = Clock::now();
    {
      const std::lock_guard lock(drawing);
      ui.frame(window.inputs(interval));
      ui.screen().present();
    }
    if (ui.shown().scene != scene) {
      scene = ui.shown().scene;
      window.set_title(title_of(*scene));
    }
    window.swap();
  }
}

}  // namespace

void view_scene(const Options& options) {
  require_drawing_room();
  ViewSetup setup = view_setup(options);
  view::SignalWatch signals;
  std::unique_ptr<view::GlfwWindow> window;
  try {
    window = std::make_unique<view::GlfwWindow>(title_of(setup.scene), setup.size[0], setup.size[1]);
  } catch (const std::runtime_error& error) {
    throw Failure(ExitCode::usage, fmt::format("view: {}: use rheo render {}, which needs no display",
                                               error.what(), options.scene.string()));
  }
  setup.ui.scale = window->scale();
  view::Physics physics(std::move(setup.scene), setup.core, [&window] { window->wake(); });
  std::optional<view::Ui> ui(std::in_place, window->context(), physics, std::move(setup.ui));
  physics.run();
  signals.start([&window] { window->wake(); });
  const Clock::time_point start = Clock::now();
  DrawingMutex drawing;
  bool over = false;  // guarded by drawing: the summary is the other thread's
  const view::DisplayLoss loss([&] {
    if (drawing.try_lock_for(patience) && !over) {
      ui->finish_files();
      if (!options.quiet) print_summary(*ui, start);
    }
    end_at_once(Failure(ExitCode::file, "view: the display is gone"));
  });
  show(*window, *ui, signals, drawing, options.close_after);
  {
    const std::lock_guard lock(drawing);
    over = true;
  }
  if (!options.quiet) print_summary(*ui, start);
  if (const int signal = signals.asked())
    throw Failure(signal == SIGINT ? ExitCode::interrupted : ExitCode::terminated,
                  fmt::format("view: closed by {}", signal == SIGINT ? "SIGINT" : "SIGTERM"));
}

}  // namespace app
