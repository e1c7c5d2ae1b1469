#include "view/signal_watch.hpp"

#include <ctime>
#include <utility>

namespace app::view {

SignalWatch::SignalWatch() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
}

SignalWatch::~SignalWatch() {
  over_ = true;
  if (thread_.joinable()) thread_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void SignalWatch::start(std::function<void()> came) {
  thread_ = std::thread([this, came = std::move(came)] {
    constexpr timespec while_open{0, 200'000'000};  // how late the window may close
    while (!over_) {
      const int signal = sigtimedwait(&signals_, nullptr, &while_open);
      if (signal <= 0) continue;
      asked_ = signal;
      came();
      return;
    }
  });
}

}  // namespace app::view
