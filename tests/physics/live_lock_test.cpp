// No lock is taken in a tick, nor by what a user does between ticks, on one thread or several.

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <shared_mutex>

#include "rheo/live.hpp"
#include "support/live_cases.hpp"

#if defined(RHEO_SANITIZE_ADDRESS) || defined(RHEO_SANITIZE_THREAD) || !defined(__GLIBC__)
#define RHEO_CANNOT_COUNT_LOCKS 1
#else
#include <dlfcn.h>
#include <pthread.h>
#endif

namespace {

[[maybe_unused]] std::atomic<bool> counting{false};
[[maybe_unused]] std::atomic<long> count{0};

}  // namespace

#ifndef RHEO_CANNOT_COUNT_LOCKS
// The program's own in front of the library's: every lock of every library comes through here.
#define RHEO_COUNT(name, Parameter)                                                              \
  extern "C" int name(Parameter* object) noexcept {                                              \
    static std::atomic<int (*)(Parameter*)> next{nullptr};                                       \
    auto* call = next.load(std::memory_order_relaxed);                                           \
    if (call == nullptr) {                                                                       \
      call = reinterpret_cast<int (*)(Parameter*)>(dlsym(RTLD_NEXT, #name));                     \
      next.store(call, std::memory_order_relaxed);                                               \
    }                                                                                            \
    if (counting.load(std::memory_order_relaxed)) count.fetch_add(1, std::memory_order_relaxed); \
    return call(object);                                                                         \
  }
RHEO_COUNT(pthread_mutex_lock, pthread_mutex_t)
RHEO_COUNT(pthread_mutex_trylock, pthread_mutex_t)
RHEO_COUNT(pthread_rwlock_rdlock, pthread_rwlock_t)
RHEO_COUNT(pthread_rwlock_wrlock, pthread_rwlock_t)
RHEO_COUNT(pthread_rwlock_tryrdlock, pthread_rwlock_t)
RHEO_COUNT(pthread_rwlock_trywrlock, pthread_rwlock_t)
RHEO_COUNT(pthread_spin_lock, volatile pthread_spinlock_t)
#undef RHEO_COUNT
#endif

namespace rheo::test {
namespace {

class LiveLocks : public ::testing::TestWithParam<LiveCase> {};

TEST_P(LiveLocks, NoneInAThousandTicks) {
#ifdef RHEO_CANNOT_COUNT_LOCKS
  GTEST_SKIP() << "the sanitizer stands before the locks itself";
#else
  Live live = live_of(GetParam());
  ASSERT_FALSE(live.tick());
  count = 0;
  counting = true;
  const bool fine = work(live, GetParam(), 1000);
  counting = false;
  EXPECT_TRUE(fine);
  EXPECT_EQ(count.load(), 0);
#endif
}

// What counts would count.
TEST(LiveLockCount, SeesLocks) {
#ifdef RHEO_CANNOT_COUNT_LOCKS
  GTEST_SKIP();
#else
  std::mutex mutex;
  std::shared_mutex shared;
  count = 0;
  counting = true;
  { const std::scoped_lock both(mutex, shared); }
  { const std::shared_lock reader(shared); }
  counting = false;
  EXPECT_EQ(count.load(), 3);
#endif
}

INSTANTIATE_TEST_SUITE_P(Kernels, LiveLocks, ::testing::ValuesIn(live_cases),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace rheo::test
