// The plots' samples: even, bounded, and the same whoever looks.
#include "view/history.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "view/physics.hpp"
#include "view_scene.hpp"

namespace view_tests {
namespace {

using app::view::Display;
using app::view::History;
using app::view::Hold;
using app::view::Physics;

TEST(ViewHistory, StaysEvenAndWithinItsRoom) {
  History history;
  history.begin(10);
  const double* memory = history.t.data();
  for (std::int64_t tick = 0; tick < 1'000'000; ++tick) {
    if (!history.is_due(tick)) continue;
    const double t = 1e-3 * static_cast<double>(tick);
    history.add({t, 2 * t, 0, 0, 0, 0, 0, 0, 0, 3 * t});
    ASSERT_LT(history.size(), History::most_samples);
  }
  EXPECT_EQ(history.t.data(), memory) << "no memory is taken later";
  ASSERT_GE(history.size(), History::most_samples / 2);
  const double apart = history.t[1];
  for (std::size_t i = 0; i < history.size(); ++i) {
    EXPECT_NEAR(history.t[i], static_cast<double>(i) * apart, 1e-9);
    EXPECT_EQ(history.w_lambda[i], 2 * history.t[i]);
    EXPECT_EQ(history.force[i], 3 * history.t[i]);
  }
}

TEST(ViewHistory, AFollowerHasTheSameAfterAnyPause) {
  History newer, follower;
  newer.begin(1);
  for (std::int64_t tick = 0; tick < 20'000; ++tick) {
    if (newer.is_due(tick)) newer.add({1.0 * static_cast<double>(tick), 0, 0, 0, 0, 0, 0, 0, 0, 0});
    if (tick == 9'000) newer.begin(2);
    if (tick % 1'237 == 0 || tick > 19'000) {
      follower.follow(newer);
      ASSERT_EQ(follower.t, newer.t) << tick;
      ASSERT_EQ(follower.force.size(), newer.force.size());
    }
  }
}

// So many ticks of a push, looked at after each `looks` of them.
History curve(int ticks, int looks) {
  Physics physics(block(), app::view::CoreSettings{});
  physics.post(
      [](app::view::Core& core) { core.begin(Hold::push, core.scene().mesh.edge_groups.at("right")); });
  physics.aim({200.0, 50.0});
  for (int done = 0; done < ticks; done += looks) {
    physics.step(looks);
    while (physics.newest().ticks < done + looks) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return physics.newest().history;
}

TEST(ViewHistory, DoesNotDependOnTheDisplay) {
  const History often = curve(200, 1), once = curve(200, 200);
  ASSERT_EQ(often.size(), 21u);
  EXPECT_GT(often.force.back(), 0.0);
  EXPECT_EQ(often.t, once.t);
  EXPECT_EQ(often.w_lambda, once.w_lambda);
  EXPECT_EQ(often.work, once.work);
  EXPECT_EQ(often.drift, once.drift);
  EXPECT_EQ(often.moved, once.moved);
  EXPECT_EQ(often.force, once.force);
}

}  // namespace
}  // namespace view_tests
