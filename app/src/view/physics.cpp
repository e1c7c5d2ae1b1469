#include "view/physics.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace app::view {
namespace {

constexpr double burst = 0.008;    // [s] after which the display gets a state even when more is due
constexpr double patience = 0.05;  // [s] behind which simulated time slows
constexpr double least_sleep = 0.002;

double seconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

}  // namespace

Physics::Physics(rheo::Scene scene, const CoreSettings& settings, std::function<void()> published)
    : core_(std::move(scene), settings), rate_(settings.rate), published_(std::move(published)) {
  publish();
  thread_ = std::thread([this] { loop(); });
}

Physics::~Physics() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void Physics::post(std::function<void(Core&)> command) {
  {
    const std::lock_guard lock(mutex_);
    commands_.push_back(std::move(command));
  }
  wake_.notify_one();
}
void Physics::edit(rheo::Scene edited) {
  {
    const std::lock_guard lock(mutex_);
    edit_ = std::move(edited);
  }
  wake_.notify_one();
}
void Physics::aim(rheo::Vec2 target) {
  {
    const std::lock_guard lock(mutex_);
    aim_ = target;
  }
  wake_.notify_one();
}
void Physics::run() {
  {
    const std::lock_guard lock(mutex_);
    run_ = true;
    turn_ = false;
  }
  wake_.notify_one();
}
void Physics::pause() {
  {
    const std::lock_guard lock(mutex_);
    run_ = false;
    turn_ = false;
  }
  wake_.notify_one();
}
void Physics::run_or_pause() {
  {
    const std::lock_guard lock(mutex_);
    turn_ = !turn_;
    turned_ = true;
  }
  wake_.notify_one();
}
void Physics::set_speed(double speed) {
  {
    const std::lock_guard lock(mutex_);
    set_speed_ = std::clamp(speed, slowest, fastest);
  }
  wake_.notify_one();
}
void Physics::step(int ticks) {
  {
    const std::lock_guard lock(mutex_);
    asked_ticks_ += ticks;
  }
  wake_.notify_one();
}

void Physics::forget_steps() {
  const std::lock_guard lock(mutex_);
  asked_ticks_ = 0;
  forget_ticks_ = true;
}

void Physics::anchor_now() {
  anchor_ = Clock::now();
  anchored_ticks_ = 0;
}

// Whether anything was asked for. Commands run without the lock: loading a scene takes its time.
bool Physics::take_commands() {
  taken_.clear();
  std::optional<rheo::Scene> edited;
  std::optional<rheo::Vec2> target;
  bool any = false;
  {
    const std::lock_guard lock(mutex_);
    taken_.swap(commands_);
    edited.swap(edit_);
    target.swap(aim_);
    any = !taken_.empty() || edited || target || run_ || turned_ || set_speed_ || asked_ticks_ > 0;
    const bool running = run_.value_or(running_) != turn_;
    if (running != running_ || set_speed_) {
      running_ = running;
      speed_ = set_speed_.value_or(speed_);
      marks_.clear();
      anchor_now();
    }
    run_.reset();
    turn_ = turned_ = false;
    set_speed_.reset();
    if (std::exchange(forget_ticks_, false)) owed_ticks_ = 0;
    owed_ticks_ += std::exchange(asked_ticks_, 0);
  }
  try {
    for (const auto& command : taken_) command(core_);
    if (edited) core_.change(std::move(*edited));
  } catch (const std::exception& error) {  // no memory for another scene: the old one goes on
    core_.say(error.what());
  }
  if (target) core_.aim(*target, speed_);
  if (any && resting_) anchor_now();
  return any;
}

void Physics::advance() {
  const Clock::time_point begin = Clock::now();
  const double speed_rate = speed_ * rate_;
  auto due = static_cast<std::int64_t>(std::floor(seconds(begin - anchor_) * speed_rate)) - anchored_ticks_;
  if (!running_ || resting_) due = 0;
  const std::int64_t all = due + owed_ticks_;
  for (std::int64_t k = 0; k < all; ++k) {
    if (!core_.tick()) {
      running_ = false;
      owed_ticks_ = 0;
      break;
    }
    if (k < due)
      ++anchored_ticks_;
    else
      --owed_ticks_;
    pending_ = true;
    if (seconds(Clock::now() - begin) > burst) break;
  }
  busy_seconds_ += seconds(Clock::now() - begin);
  const double behind =
      seconds(Clock::now() - anchor_) - static_cast<double>(anchored_ticks_) / std::max(speed_rate, 1e-9);
  if (running_ && behind > std::max(patience, 2.0 / speed_rate)) anchor_now();
}

void Physics::publish() {
  Display& display = displays_.back();
  core_.show(display);
  const Clock::time_point now = Clock::now();
  if (running_ && !resting_) {
    if (!marks_.empty() && marks_.back().t > display.t) marks_.clear();
    marks_.push_back({now, display.t});
    std::size_t old = 0;
    while (marks_.size() - old > 2 && seconds(now - marks_[old].at) > 1.0) ++old;
    marks_.erase(marks_.begin(), marks_.begin() + static_cast<std::ptrdiff_t>(old));
  } else {
    marks_.clear();
  }
  display.real_time_factor = speed_;
  if (!marks_.empty() && seconds(now - marks_.front().at) > 0.2)
    display.real_time_factor = (display.t - marks_.front().t) / seconds(now - marks_.front().at);
  display.running = running_;
  display.resting = running_ && resting_;
  display.speed_wanted = speed_;
  display.busy_seconds = busy_seconds_;
  displays_.publish();
  pending_ = false;
  if (published_) published_();
}

void Physics::loop() {
  anchor_now();
  for (;;) {
    const bool asked = take_commands();
    const bool rested = resting_;
    resting_ = core_.still();
    if (rested && !resting_) anchor_now();
    advance();
    resting_ = core_.still();
    const bool idle = (!running_ || resting_) && owed_ticks_ == 0;
    // A display that has not looked yet gets the newer one when it comes to rest at the latest.
    if (asked || (pending_ && (idle || !displays_.waits())) || rested != resting_) publish();
    std::unique_lock lock(mutex_);
    if (quit_) return;
    const auto something = [this] {
      return quit_ || !commands_.empty() || edit_ || aim_ || run_ || turned_ || set_speed_ ||
             asked_ticks_ > 0;
    };
    if (idle) {
      wake_.wait(lock, something);
    } else if (owed_ticks_ == 0) {
      const double next = static_cast<double>(anchored_ticks_ + 1) / (speed_ * rate_);
      const auto due =
          anchor_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(next));
      const auto soon = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(least_sleep));
      wake_.wait_until(lock, std::max(due, soon), something);
    }
    if (quit_) return;
  }
}

}  // namespace app::view
