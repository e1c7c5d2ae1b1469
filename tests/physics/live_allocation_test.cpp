// Nothing is allocated in a tick, nor by what a user does between ticks.

#include <gtest/gtest.h>

#include "rheo/live.hpp"
#include "support/allocation_count.hpp"
#include "support/live_cases.hpp"

namespace rheo::test {
namespace {

class LiveAllocation : public ::testing::TestWithParam<LiveCase> {};

TEST_P(LiveAllocation, NoneInAThousandTicks) {
  if (!can_count_allocations()) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  Live live = live_of(GetParam());
  ASSERT_EQ(live.simulation().threads(), GetParam().threads);
  ASSERT_FALSE(live.tick());
  const AllocationCount count;
  const bool fine = work(live, GetParam(), 1000);
  const Allocations made = count.so_far();
  EXPECT_TRUE(fine);
  EXPECT_TRUE(live.session_is_complete());
  EXPECT_EQ(made.calls, 0);
}

// Steps of the implicit integrator, once it has the factor of their size.
TEST(ImplicitAllocation, NoneInAStep) {
  if (!can_count_allocations()) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    Scene scene = live_block(mass);
    scene.time.integrator = IntegratorKind::implicit;
    scene.time.step = 1.0 / 64;
    Simulation simulation(scene);
    // Past the last event, and a step of the size of those that count.
    ASSERT_FALSE(simulation.advance(8.0 / 64));
    ASSERT_FALSE(simulation.advance(9.0 / 64));
    const auto before = simulation.counters();
    const AllocationCount count;
    const auto diverged = simulation.advance(1.0);
    const Allocations made = count.so_far();
    EXPECT_FALSE(diverged);
    EXPECT_EQ(made.calls, 0);
    EXPECT_EQ(simulation.counters().factors, before.factors);
    EXPECT_EQ(simulation.counters().steps, before.steps + 55);
  }
}

// What counts would count.
TEST(LiveAllocationCount, SeesAnAllocation) {
  if (!can_count_allocations()) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  const AllocationCount count;
  auto* memory = new std::vector<double>(1000);
  const Allocations made = count.so_far();
  EXPECT_GE(made.calls, 2) << memory->size();
  EXPECT_GE(made.held, 8000);
  delete memory;
  EXPECT_EQ(count.so_far().held, 0);
  EXPECT_EQ(count.so_far().most, made.most);
}

INSTANTIATE_TEST_SUITE_P(Kernels, LiveAllocation, ::testing::ValuesIn(live_cases),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace rheo::test
