// The short part of long life (rheo_long_life runs 1e8 steps): no drift beyond rounding, no more work a step
// at the end than at the beginning.

#include <gtest/gtest.h>

#include <cmath>

#include "stability/runs/long_life_run.hpp"

namespace rheo::test {
namespace {

#if defined(RHEO_SANITIZE_ADDRESS) || defined(RHEO_SANITIZE_THREAD)
constexpr int fewer = 3;
#else
constexpr int fewer = 1;
#endif

void expect_long_life(const LongLife& life) {
  const LongLifeOutcome outcome = live_long(life);
  ASSERT_FALSE(outcome.diverged);
  ASSERT_TRUE(outcome.finite);
  ASSERT_EQ(outcome.tenths.size(), 10u);
  EXPECT_LE(outcome.worst_drift(), outcome.allowed_drift());
  EXPECT_NEAR(outcome.tenths.back().evaluations, outcome.tenths[1].evaluations,
              0.01 * outcome.tenths[1].evaluations);
  EXPECT_EQ(outcome.tenths.back().steps, outcome.tenths[1].steps);
  if (!std::isnan(outcome.tenths[0].balance)) {
    // RK4's error of a step is always the same share of what is dissipated: it does not grow.
    EXPECT_NEAR(outcome.tenths.back().balance, outcome.tenths[1].balance,
                0.1 * std::abs(outcome.tenths[1].balance) + 1e-12);
  }
}

TEST(LongLife, OfTheBeamWithRk4) {
  expect_long_life(long_lived_beam(IntegratorKind::rk4, 2000 / fewer));
}
TEST(LongLife, OfABlockWithRk4) {
  expect_long_life(long_lived_block(IntegratorKind::rk4, 11, 6, 600));
}
TEST(LongLife, OfTheBeamWithEuler) {
  expect_long_life(long_lived_beam(IntegratorKind::euler, 200));
}
TEST(LongLife, OfTheExponentialIntegrator) {
  expect_long_life(long_lived_beam(IntegratorKind::exponential, 500));
}
TEST(LongLife, OfTheImplicitIntegrator) {
  expect_long_life(long_lived_beam(IntegratorKind::implicit, 500));
}

}  // namespace
}  // namespace rheo::test
