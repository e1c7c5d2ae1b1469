// Frames between the ticks of slow motion.
#include "view/slow_motion.hpp"

#include <gmock/gmock.h>

namespace view_tests {
namespace {

using app::view::Display;
using app::view::SlowMotion;

// One node on x = t^3 - 2 t, y = t^2, |w| = t, at a tick of half a second.
Display at_tick(std::int64_t ticks) {
  Display d;
  const double t = 0.5 * static_cast<double>(ticks);
  d.t = t;
  d.ticks = ticks;
  d.positions = {t * t * t - 2 * t, t * t};
  d.velocities = {3 * t * t - 2, 2 * t};
  d.w_lambda = d.w_mu = d.speed = {t};
  d.running = true;
  d.speed_wanted = 0.01;
  return d;
}

TEST(SlowMotion, FollowsCubicsBetweenTicks) {
  SlowMotion motion;
  const double rate = 2.0;  // 0.02 ticks a second of the user's
  const Display first = at_tick(2), second = at_tick(3);
  EXPECT_EQ(&motion.shown(first, rate, 100.0), &first) << "nothing before it";
  for (const double s : {0.0, 0.25, 0.5, 0.875}) {
    const Display& d = motion.shown(second, rate, 200.0 + 50.0 * s);
    const double t = 1.0 + 0.5 * s;
    EXPECT_DOUBLE_EQ(d.t, t);
    EXPECT_NEAR(d.positions[0], t * t * t - 2 * t, 1e-14);
    EXPECT_NEAR(d.positions[1], t * t, 1e-14);
    EXPECT_NEAR(d.w_mu[0], t, 1e-14);
    EXPECT_EQ(d.ticks, 3);
  }
  EXPECT_EQ(&motion.shown(second, rate, 251.0), &second);
}

TEST(SlowMotion, ShowsTheNewestWhereTicksAreNotRareOrNotInOneRun) {
  SlowMotion motion;
  motion.shown(at_tick(2), 2.0, 0.0);
  Display other = at_tick(3);
  other.run = 1;
  EXPECT_EQ(&motion.shown(other, 2.0, 1.0), &other);
  Display back = at_tick(1);
  back.run = 1;
  EXPECT_EQ(&motion.shown(back, 2.0, 2.0), &back) << "set back";
  Display paused = at_tick(2);
  paused.run = 1;
  paused.running = false;
  EXPECT_EQ(&motion.shown(paused, 2.0, 3.0), &paused);
  Display fast = at_tick(3);
  EXPECT_EQ(&motion.shown(fast, 1e5, 4.0), &fast);
}

}  // namespace
}  // namespace view_tests
