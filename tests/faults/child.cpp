#include "child.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace fault_tests {
namespace {

constexpr const char* out_name = ".stdout";
constexpr const char* err_name = ".stderr";

}  // namespace

Child::Child(const fs::path& folder, const std::vector<std::string>& arguments,
             const std::function<void()>& prepare)
    : folder_(folder) {
  const std::string out = folder / out_name, err = folder / err_name;
  std::vector<std::string> words{RHEO_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  process_ = fork();
  if (process_ < 0) throw std::runtime_error("cannot start a process");
  if (process_ > 0) return;
  const int out_file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (chdir(folder.c_str()) != 0 || dup2(out_file, 1) < 0 || dup2(err_file, 2) < 0) _exit(126);
  setenv("ASAN_OPTIONS", "detect_leaks=0", 1);  // graphics drivers leak
  if (prepare) prepare();
  execv(RHEO_PROGRAM, argv.data());
  _exit(127);
}

Child::~Child() {
  if (ended_) return;
  send(SIGKILL);
  waitpid(process_, &status_, 0);
}

void Child::send(int signal) const {
  kill(process_, signal);
}

bool Child::pause() {
  if (ended_) return false;
  send(SIGSTOP);
  waitpid(process_, &status_, WUNTRACED);
  ended_ = !WIFSTOPPED(status_);
  return !ended_;
}

bool Child::has_ended() {
  if (!ended_) ended_ = waitpid(process_, &status_, WNOHANG) == process_;
  return ended_;
}

Ended Child::wait() {
  if (!ended_) waitpid(process_, &status_, 0);
  ended_ = true;
  Ended ended;
  if (WIFEXITED(status_)) ended.exit_code = WEXITSTATUS(status_);
  if (WIFSIGNALED(status_)) ended.signal = WTERMSIG(status_);
  ended.out = read_text(folder_ / out_name);
  ended.err = read_text(folder_ / err_name);
  return ended;
}

bool Child::wait_until(const std::function<bool()>& condition) {
  while (!condition()) {
    if (has_ended()) return condition();
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return true;
}

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace fault_tests
