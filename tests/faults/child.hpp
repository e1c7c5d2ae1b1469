// The built program as a process of its own: started under conditions, killed, signalled, waited for.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fault_tests {

namespace fs = std::filesystem;

struct Ended {
  int exit_code = -1;  // -1: by a signal
  int signal = 0;
  std::string out, err;
};

class Child {
 public:
  // `prepare` is run in the new process before the program is: limits, streams. out/err go to files in
  // `folder`, the program's current one.
  Child(const fs::path& folder, const std::vector<std::string>& arguments,
        const std::function<void()>& prepare = {});
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  void send(int signal) const;
  // Holds it where it is, until SIGCONT; false where it has ended before.
  bool pause();
  bool has_ended();
  Ended wait();
  // Until the condition holds or the program has ended; whether it holds.
  bool wait_until(const std::function<bool()>& condition);

 private:
  fs::path folder_;
  int process_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

inline Ended run(const fs::path& folder, const std::vector<std::string>& arguments,
                 const std::function<void()>& prepare = {}) {
  return Child(folder, arguments, prepare).wait();
}

std::string read_text(const fs::path& file);

}  // namespace fault_tests
