// SIGINT and SIGTERM while a window is open: noted by a thread of its own, which wakes the window.
//
// Errors   none
// Threads  construct it before other threads: they inherit that these signals are not theirs
#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <thread>

namespace app::view {

class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  // From here on; came: called on the watch's thread.
  void start(std::function<void()> came);
  int asked() const { return asked_.load(); }  // the signal's number; 0: none

 private:
  sigset_t signals_{}, before_{};
  std::atomic<int> asked_{0};
  std::atomic<bool> over_{false};
  std::thread thread_;
};

}  // namespace app::view
