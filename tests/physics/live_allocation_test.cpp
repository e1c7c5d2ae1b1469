// Nothing is allocated in a tick, nor by what a user does between ticks.

#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>

#include "rheo/live.hpp"
#include "support/live_scenes.hpp"

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

struct Case {
  const char* name;
  Mass mass;
  Kernel kernel;
  int threads;
  bool general_constraint;
};

class LiveAllocation : public ::testing::TestWithParam<Case> {};

TEST_P(LiveAllocation, NoneInAThousandTicks) {
#ifdef RHEO_CANNOT_COUNT
  GTEST_SKIP() << "the sanitizer has an allocator of its own";
#else
  const Case& c = GetParam();
  // Large enough for two threads to have work.
  Scene scene = c.threads > 1 ? live_block(c.mass, 61, 41) : live_block(c.mass);
  scene.time.step = 0.0;
  if (c.general_constraint) {
    scene.constraints.push_back({{{30, Axis::x, 1.0}, {31, Axis::x, -1.0}}, 0.0, "tie"});
  }
  LiveSettings settings = live_settings(scene);
  settings.rate = 1000.0;
  settings.simulation.kernel = c.kernel;
  settings.simulation.threads = c.threads;
  settings.record = 100'000;
  Live live(scene, settings);
  ASSERT_EQ(live.simulation().threads(), c.threads);
  ASSERT_FALSE(live.tick());  // OpenMP starts its threads
  double checked = 0.0;
  count = 0;
  counting = true;
  bool fine = true;
  for (int k = 0; k < 1000; ++k) {
    // With factors to make, a hold of what was picked would make one.
    if (k % 120 != 25 || (c.mass == Mass::lumped && !c.general_constraint)) act(live, k % 120);
    fine = fine && !live.tick();
    checked += live.read(grab_handle).force.x + live.simulation().u()[0] + live.simulation().energies().work;
  }
  counting = false;
  EXPECT_TRUE(fine);
  EXPECT_TRUE(std::isfinite(checked));
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

INSTANTIATE_TEST_SUITE_P(Kernels, LiveAllocation,
                         ::testing::Values(Case{"edge", Mass::lumped, Kernel::edge, 1, false},
                                           Case{"edge_on_two_threads", Mass::lumped, Kernel::edge, 2, false},
                                           Case{"element", Mass::lumped, Kernel::element, 1, false},
                                           Case{"csr", Mass::lumped, Kernel::csr, 1, false},
                                           Case{"csr_consistent", Mass::consistent, Kernel::csr, 1, false},
                                           Case{"csr_constraint", Mass::lumped, Kernel::csr, 1, true}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace rheo::test
