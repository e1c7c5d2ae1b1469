#include "stop_signals.hpp"

#include <unistd.h>

#include <cerrno>

namespace app {
namespace {

// A handler can reach nothing else.
volatile std::sig_atomic_t noted = 0;
volatile std::sig_atomic_t says_so = 0;  // to somebody at a terminal

void note(int signal) {
  noted = signal;
  if (says_so == 0) return;
  static constexpr char text[] = "\nstops after the output in hand; the same once more ends it at once\n";
  const int error = errno;  // of the call that was interrupted
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
  errno = error;
}

// What ignores a signal (nohup, a shell's background job) goes on doing so.
void install(int signal, struct sigaction& before) {
  struct sigaction action {};
  action.sa_handler = note;
  // Calls that wait go on waiting; the handler serves once.
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigaction(signal, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
}

}  // namespace

StopSignals::StopSignals(Answer answer) {
  noted = 0;
  says_so = answer == Answer::at_terminal && isatty(STDERR_FILENO) != 0 ? 1 : 0;
  install(SIGINT, interrupt_before_);
  install(SIGTERM, terminate_before_);
}

StopSignals::~StopSignals() {
  sigaction(SIGINT, &interrupt_before_, nullptr);
  sigaction(SIGTERM, &terminate_before_, nullptr);
}

std::optional<StopSignal> StopSignals::asked() const {
  if (noted == SIGINT) return StopSignal::interrupt;
  if (noted == SIGTERM) return StopSignal::terminate;
  return std::nullopt;
}

}  // namespace app
