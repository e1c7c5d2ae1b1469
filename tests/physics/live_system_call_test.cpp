// No system call is made in a tick, nor by what a user does between ticks; with several threads none but a
// thread's sleep and wake.
//
// A process of its own goes on under a filter of the kernel that traps all calls but those named here.

#include <gtest/gtest.h>

#include "rheo/live.hpp"
#include "support/live_cases.hpp"

#if defined(__linux__) && defined(__x86_64__) && !defined(RHEO_SANITIZE_THREAD) && \
    !defined(RHEO_SANITIZE_ADDRESS)
#define RHEO_CAN_TRAP 1
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#endif

namespace rheo::test {
namespace {

#ifdef RHEO_CAN_TRAP
constexpr int report = 200;  // a copy of standard error, the one place that may be written to
constexpr int trapped = 3;

void name_the_call(int /*signal*/, siginfo_t* info, void* /*context*/) {
  char text[] = "system call 000\n";
  for (int at = 14, number = info->si_syscall; at >= 12; --at, number /= 10)
    text[at] = static_cast<char>('0' + number % 10);
  (void)!write(report, text, sizeof text - 1);
  _exit(trapped);
}

// The documented way to ask: a filter that is not there is a bad address where filters are known.
bool filters_are_known() {
  return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, nullptr) == -1 && errno == EFAULT;
}

// From now on, in all threads, a call beyond these ends the process with `trapped`.
void trap_calls_but(const std::vector<unsigned>& allowed) {
  if (dup2(STDERR_FILENO, report) < 0) std::abort();
  struct sigaction action {};
  action.sa_sigaction = name_the_call;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSYS, &action, nullptr);
  const auto load = [](std::size_t offset) {
    return sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<unsigned>(offset));
  };
  const auto skip_unless = [](unsigned value) {
    return sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 1);
  };
  const auto end = [](unsigned verdict) { return sock_filter BPF_STMT(BPF_RET | BPF_K, verdict); };
  std::vector<sock_filter> filter{load(offsetof(seccomp_data, nr))};
  for (const unsigned call : allowed) {
    filter.push_back(skip_unless(call));
    filter.push_back(end(SECCOMP_RET_ALLOW));
  }
  filter.push_back(skip_unless(SYS_exit_group));
  filter.push_back(end(SECCOMP_RET_ALLOW));
  filter.push_back(sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_write, 0, 3));
  filter.push_back(load(offsetof(seccomp_data, args)));
  filter.push_back(skip_unless(report));
  filter.push_back(end(SECCOMP_RET_ALLOW));
  filter.push_back(end(SECCOMP_RET_TRAP));
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &program) != 0) {
    std::perror("seccomp");
    std::abort();
  }
}

std::vector<unsigned> calls_of(int threads) {
  if (threads == 1) return {};
  return {SYS_futex, SYS_sched_yield};
}

[[noreturn]] void work_under_filter(const LiveCase& each) {
  Live live = live_of(each);
  bool fine = live.simulation().threads() == each.threads && !live.tick();
  trap_calls_but(calls_of(each.threads));
  fine = work(live, each, 1000) && fine;
  _exit(fine ? 0 : 1);
}

[[noreturn]] void ask_for_the_parent_under_filter() {
  trap_calls_but({});
  _exit(static_cast<int>(syscall(SYS_getppid)) > 0 ? 0 : 1);
}
#endif

class LiveSystemCalls : public ::testing::TestWithParam<LiveCase> {};

TEST_P(LiveSystemCalls, NoneInAThousandTicks) {
#ifndef RHEO_CAN_TRAP
  GTEST_SKIP() << "system calls are trapped on Linux, x86-64, without a sanitizer that makes its own";
#else
  if (!filters_are_known()) GTEST_SKIP() << "this kernel filters no system calls";
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // started anew: other tests' threads do not outlive a fork
  EXPECT_EXIT(work_under_filter(GetParam()), ::testing::ExitedWithCode(0), "");
#endif
}

// What is trapped is trapped.
TEST(LiveSystemCallTrap, SeesACall) {
#ifndef RHEO_CAN_TRAP
  GTEST_SKIP();
#else
  if (!filters_are_known()) GTEST_SKIP() << "this kernel filters no system calls";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(ask_for_the_parent_under_filter(), ::testing::ExitedWithCode(trapped), "system call 110");
#endif
}

INSTANTIATE_TEST_SUITE_P(Kernels, LiveSystemCalls, ::testing::ValuesIn(live_cases),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace rheo::test
