// Nothing is allocated in a tick, nor by what a user does between ticks.

#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>

#include "rheo/live.hpp"
#include "support/live_cases.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define RHEO_CANNOT_COUNT 1
#endif

namespace {

[[maybe_unused]] std::atomic<bool> counting{false};
[[maybe_unused]] std::atomic<long> count{0};

[[maybe_unused]] void note() {
  if (counting.load(std::memory_order_relaxed)) count.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

#ifndef RHEO_CANNOT_COUNT
// glibc's own names behind the program's: everything that allocates comes through here, whatever thread and
// library it is in (operator new too).
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  note();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) noexcept {
  note();
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  note();
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  note();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  note();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  note();
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? 12 : 0;
}
}
#endif

namespace rheo::test {
namespace {

class LiveAllocation : public ::testing::TestWithParam<LiveCase> {};

TEST_P(LiveAllocation, NoneInAThousandTicks) {
#ifdef RHEO_CANNOT_COUNT
  GTEST_SKIP() << "the sanitizer has an allocator of its own";
#else
  Live live = live_of(GetParam());
  ASSERT_EQ(live.simulation().threads(), GetParam().threads);
  ASSERT_FALSE(live.tick());
  count = 0;
  counting = true;
  const bool fine = work(live, GetParam(), 1000);
  counting = false;
  EXPECT_TRUE(fine);
  EXPECT_TRUE(live.session_is_complete());
  EXPECT_EQ(count.load(), 0);
#endif
}

// Steps of the implicit integrator, once it has the factor of their size.
TEST(ImplicitAllocation, NoneInAStep) {
#ifdef RHEO_CANNOT_COUNT
  GTEST_SKIP() << "the sanitizer has an allocator of its own";
#else
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    Scene scene = live_block(mass);
    scene.time.integrator = IntegratorKind::implicit;
    scene.time.step = 1.0 / 64;
    Simulation simulation(scene);
    // Past the last event, and a step of the size of those that count.
    ASSERT_FALSE(simulation.advance(8.0 / 64));
    ASSERT_FALSE(simulation.advance(9.0 / 64));
    const auto before = simulation.counters();
    count = 0;
    counting = true;
    const auto diverged = simulation.advance(1.0);
    counting = false;
    EXPECT_FALSE(diverged);
    EXPECT_EQ(count.load(), 0);
    EXPECT_EQ(simulation.counters().factors, before.factors);
    EXPECT_EQ(simulation.counters().steps, before.steps + 55);
  }
#endif
}

// What counts would count.
TEST(LiveAllocationCount, SeesAnAllocation) {
#ifdef RHEO_CANNOT_COUNT
  GTEST_SKIP();
#else
  count = 0;
  counting = true;
  auto* memory = new std::vector<double>(1000);
  counting = false;
  EXPECT_GE(count.load(), 2) << memory->size();
  delete memory;
#endif
}

INSTANTIATE_TEST_SUITE_P(Kernels, LiveAllocation, ::testing::ValuesIn(live_cases),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace rheo::test
