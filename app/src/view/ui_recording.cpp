// Ui's recording: pictures of even times, each of which is asked of the physics, which rests between.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "view/ui.hpp"

namespace app::view {
namespace {

constexpr double recorded_rate = 60.0;  // frames a second of the user's time

// The tick at or before a time, which is a sum of sixtieths.
std::int64_t tick_at(double ticks) {
  return static_cast<std::int64_t>(std::floor(ticks + 1e-6));
}

}  // namespace

void Ui::toggle_recording() {
  if (recording_.is_on()) return end_recording(recording_.stop());
  std::string told = recording_.start();
  // Between ticks there is nothing to record.
  if (const double least = recorded_rate / physics_.rate(); recording_.is_on() && speed_ < least)
    told += fmt::format(": a tick a frame, x{:.2g} of real time", least);
  say(std::move(told));
  if (!recording_.is_on()) return;
  // Paused it waits as the body does.
  recording_runs_ = display_->running;
  physics_.pause();
  recorded_ticks_ = -1;
}

void Ui::end_recording(std::string why) {
  say(std::move(why));
  if (recording_runs_) physics_.run();
}

// A frame when the physics has come to its time; then the next is asked for.
void Ui::record() {
  if (!recording_.is_on()) return;
  const Display& d = *display_;
  if (d.diverged) {
    recording_runs_ = false;
    return end_recording(fmt::format("{}; {}", d.message, recording_.stop()));
  }
  if (recorded_ticks_ < 0 && d.running) return;            // not yet paused
  if (recorded_ticks_ < 0 || d.ticks < recorded_ticks_) {  // begun, or set back
    asked_ticks_ = d.ticks;
    wanted_ticks_ = static_cast<double>(d.ticks);
  }
  recorded_ticks_ = d.ticks;
  if (d.ticks >= tick_at(wanted_ticks_)) {
    if (!record_frame()) return;
    const double ticks = physics_.rate() * speed_ / recorded_rate;
    wanted_ticks_ = std::max(wanted_ticks_ + ticks, static_cast<double>(d.ticks) + 1.0);
  }
  const std::int64_t next = tick_at(wanted_ticks_);
  if (!recording_runs_ || asked_ticks_ >= next) return;
  physics_.step(static_cast<int>(next - asked_ticks_));
  asked_ticks_ = next;
}

// False: the recording has ended.
bool Ui::record_frame() {
  render::Image image = recording_.image();
  picture_.read(image);
  const std::array<int, 2> size{image.width, image.height};
  if (recording_.frames() == 0) recorded_size_ = size;
  if (size != recorded_size_) {  // frames of two sizes are no film
    end_recording(fmt::format("the picture's size has changed: {}", recording_.stop()));
    return false;
  }
  if (std::string trouble = recording_.add(std::move(image)); !trouble.empty()) {
    end_recording(std::move(trouble));
    return false;
  }
  return true;
}

}  // namespace app::view
