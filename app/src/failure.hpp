// Exit codes of the program and the exception that ends it: one line for the user and a code.
#pragma once

#include <stdexcept>
#include <string>

namespace app {

enum class ExitCode {
  done = 0,
  usage = 2,     // a wrong option, scene, mesh or folder
  diverged = 3,  // the simulation grew beyond what its energy explains
  file = 4,      // the system refused to read, write or draw
  // A run was told to stop, and did after the output in hand: 128 + the signal's number.
  interrupted = 130,
  terminated = 143
};

class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace app
