// SIGINT and SIGTERM as a wish to be asked for between outputs: a run finishes the one in hand, writes what
// it owes and ends with 128 + the signal's number. The same once more ends the program at once.
//
// Not here writing to a pipe without a reader or beyond a file's size limit (standard_streams.hpp)
#pragma once

#include <csignal>
#include <optional>

namespace app {

enum class StopSignal { interrupt, terminate };

// While one lives, the first of either signal is noted.
class StopSignals {
 public:
  // at_terminal: one line on standard error where that is one.
  enum class Answer { none, at_terminal };
  explicit StopSignals(Answer answer);
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();

  std::optional<StopSignal> asked() const;

 private:
  struct sigaction interrupt_before_ {
  }, terminate_before_{};
};

}  // namespace app
