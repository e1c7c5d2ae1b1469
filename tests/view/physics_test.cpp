// The physics on its own thread: what is asked for comes, and nothing is done when nothing is to be done.
#include "view/physics.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "view_scene.hpp"

namespace view_tests {
namespace {

using app::view::Core;
using app::view::Display;
using app::view::Hold;
using app::view::Physics;

// Looks until it is so; a failure where it does not become so within a minute.
template <class Condition>
const Display& wait_for(Physics& physics, const Condition& holds) {
  const auto begin = std::chrono::steady_clock::now();
  for (;;) {
    const Display& display = physics.newest();
    if (holds(display)) return display;
    if (std::chrono::steady_clock::now() - begin > std::chrono::minutes(1)) {
      ADD_FAILURE() << "not within a minute";
      return display;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(ViewPhysics, StepsExactlyWhatIsAskedForWhilePaused) {
  Physics physics(block(), {});
  physics.step(7);
  physics.step(5);
  const Display& display = wait_for(physics, [](const Display& d) { return d.ticks >= 12; });
  EXPECT_EQ(display.ticks, 12);
  EXPECT_DOUBLE_EQ(display.t, 0.012);
  EXPECT_FALSE(display.running);
}

TEST(ViewPhysics, RunsPausesAndRunsBackToTheStart) {
  Physics physics(block(), {});
  physics.post([](Core& core) { core.begin(Hold::push, core.scene().mesh.edge_groups.at("top")); });
  physics.aim({0.0, -50.0});
  physics.run();
  wait_for(physics, [](const Display& d) { return d.ticks > 50 && d.hand.traction.y < -1.0; });
  physics.pause();
  const std::int64_t stopped = wait_for(physics, [](const Display& d) { return !d.running; }).ticks;
  EXPECT_GT(stopped, 50);
  physics.post([](Core& core) { core.reset(); });
  EXPECT_EQ(wait_for(physics, [](const Display& d) { return d.ticks == 0; }).hand.hold, Hold::nothing);
}

TEST(ViewPhysics, AtRestNothingIsDoneUntilAHandComes) {
  std::atomic<int> published{0};
  Physics physics(block(), {}, [&] { ++published; });
  physics.run();
  const std::int64_t ticks = wait_for(physics, [](const Display& d) { return d.resting; }).ticks;
  const int before = published;
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(physics.newest().ticks, ticks);
  EXPECT_LE(published - before, 1);
  physics.post([](Core& core) { core.begin(Hold::push, core.scene().mesh.edge_groups.at("top")); });
  physics.aim({0.0, -50.0});
  wait_for(physics, [&](const Display& d) { return d.ticks > ticks + 20; });
}

TEST(ViewPhysics, OfSeveralEditsTheNewestIsInForce) {
  Physics physics(block(), {});
  rheo::Scene edited = block();
  for (int k = 1; k <= 20; ++k) {
    edited.material.density = 1000.0 + k;
    physics.edit(edited);
  }
  wait_for(physics, [](const Display& d) { return d.scene->material.density == 1020.0; });
}

}  // namespace
}  // namespace view_tests
