// The physics on a thread of its own: ticks at a rate that no display decides, the newest whole state for
// whoever looks.
//
//   ticks due = floor(speed rate (now - anchor))
//
// Where the machine cannot keep up the anchor is moved on: simulated time slows, and real_time_factor says
// so. At rest and paused the thread sleeps until something is posted.
//
// Errors   none: messages in the Display
// Threads  all but the constructor and destructor may be called from the window's thread while it runs
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "view/core.hpp"
#include "view/triple_buffer.hpp"

namespace app::view {

inline constexpr double slowest = 0.01, fastest = 10.0;  // speeds, simulated seconds a second

class Physics {
 public:
  // published: called on the physics' thread after each new Display.
  Physics(rheo::Scene scene, const CoreSettings& settings, std::function<void()> published = {});
  ~Physics();
  Physics(const Physics&) = delete;
  Physics& operator=(const Physics&) = delete;

  // Done between ticks, in order.
  void post(std::function<void(Core&)> command);
  // Other parameters; of several that wait only the newest is done.
  void edit(rheo::Scene edited);
  void aim(rheo::Vec2 target);  // likewise
  void run();
  void pause();
  void run_or_pause();  // the other of the two, counted from what was asked for last
  void set_speed(double speed);
  // So many ticks now, whether running or not; a recording asks for each of its frames that way.
  void step(int ticks);
  void forget_steps();  // those that are still owed: before another body or another beginning

  // The newest; stays as it is until the next call.
  const Display& newest() { return displays_.newest(); }
  double rate() const { return rate_; }

 private:
  using Clock = std::chrono::steady_clock;
  void loop();
  bool take_commands();
  void advance();
  void publish();
  void anchor_now();

  Core core_;
  double rate_;
  std::function<void()> published_;
  TripleBuffer<Display> displays_;

  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<std::function<void(Core&)>> commands_;
  std::optional<rheo::Scene> edit_;
  std::optional<rheo::Vec2> aim_;
  std::optional<bool> run_;
  bool turn_ = false, turned_ = false;  // running into paused or back, after run_; whether that was asked for
  std::optional<double> set_speed_;
  int asked_ticks_ = 0;
  bool forget_ticks_ = false;
  bool quit_ = false;

  // The thread's own.
  bool running_ = false, pending_ = false, resting_ = false;
  int owed_ticks_ = 0;
  double speed_ = 1.0;
  Clock::time_point anchor_;
  std::int64_t anchored_ticks_ = 0;  // done since the anchor
  double busy_seconds_ = 0.0;
  struct Mark {
    Clock::time_point at;
    double t;
  };
  std::vector<std::function<void(Core&)>> taken_;  // what the thread is at
  std::vector<Mark> marks_;                        // of the last second

  std::thread thread_;
};

}  // namespace app::view
