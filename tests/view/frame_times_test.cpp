// What is told of the last frames.
#include "view/frame_times.hpp"

#include <gtest/gtest.h>

namespace view_tests {
namespace {

using app::view::FrameTimes;

void add(FrameTimes& times, int count, double interval, double drawing) {
  for (int k = 0; k < count; ++k) times.add(interval, {drawing, 2.0 * drawing, 7.0});
}

TEST(ViewFrameTimes, AreCountedOverTheLastTwoSeconds) {
  FrameTimes times;
  EXPECT_EQ(times.frames_per_second(), 0.0) << "not known";
  add(times, 1, 30.0, 0.01);
  EXPECT_EQ(times.frames_per_second(), 0.0) << "one frame is no row";
  add(times, 300, 1.0 / 60.0, 0.01);
  EXPECT_NEAR(times.frames_per_second(), 60.0, 1e-6);
  // A frame takes half a second now: known within two seconds.
  add(times, 4, 0.5, 0.4);
  EXPECT_NEAR(times.frames_per_second(), 2.0, 1e-6);
  EXPECT_NEAR(times.drawing().high, 0.4, 1e-12);
  // After the five seconds that costs are of, nothing is left of what was before.
  add(times, 7, 0.5, 0.4);
  EXPECT_EQ(times.drawing().median, 0.4);
  EXPECT_EQ(times.physics().median, 0.8);
  EXPECT_EQ(times.steps().high, 7.0);
  add(times, 1, 10.0, 0.4);
  EXPECT_NEAR(times.frames_per_second(), 0.1, 1e-12);
}

TEST(ViewFrameTimes, UnevenOnesAreCountedNotTheirUsualOne) {
  FrameTimes times;
  // Three quick ones after each slow one: the median says 100 a second.
  add(times, 1, 0.0, 0.01);
  for (int k = 0; k < 20; ++k) {
    add(times, 3, 0.01, 0.01);
    add(times, 1, 0.17, 0.01);
  }
  EXPECT_NEAR(times.frames_per_second(), 20.0, 1.0);
}

TEST(ViewFrameTimes, BeginAgainAfterAPause) {
  FrameTimes times;
  add(times, 100, 0.01, 0.3);
  times.begin_again();
  EXPECT_EQ(times.drawing().median, 0.0);
  add(times, 1, 3600.0, 0.02);
  add(times, 10, 0.1, 0.02);
  EXPECT_NEAR(times.frames_per_second(), 10.0, 1e-9);
  EXPECT_EQ(times.drawing().high, 0.02);
}

}  // namespace
}  // namespace view_tests
