// A body under the window's hand, tick by tick.
#include "view/core.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>

#include "rheo/io/scene_file.hpp"
#include "rheo/io/scene_text.hpp"
#include "support/allocation_count.hpp"
#include "view/history.hpp"
#include "view/triple_buffer.hpp"
#include "view_scene.hpp"

namespace view_tests {
namespace {

using app::view::Core;
using app::view::Display;
using app::view::Hold;
using testing::HasSubstr;

void run(Core& core, int ticks) {
  for (int k = 0; k < ticks; ++k) ASSERT_TRUE(core.tick()) << core.message();
}

std::vector<rheo::Edge> right_of(const rheo::Scene& scene) {
  return scene.mesh.edge_groups.at("right");
}

// The node at the top right.
double corner_x(const Core& core) {
  const auto u = core.live().simulation().u();
  return u[u.size() - 2];
}

TEST(ViewCore, WhatIsPushedAndReleasedComesBackPartOfTheWay) {
  Core core(block(), {});
  ASSERT_TRUE(core.begin(Hold::push, right_of(core.scene())));
  core.aim({300.0, 0.0}, 1.0);
  run(core, 300);
  Display pushed;
  core.show(pushed);
  EXPECT_NEAR(pushed.hand.traction.x, 300.0, 0.1);  // the hand's course is there after fifteen times 0.02 s
  EXPECT_GT(pushed.hand.force.x, 0.0);
  const double far = corner_x(core);
  EXPECT_GT(far, 1e-4);
  core.let_go();
  run(core, 2000);
  EXPECT_LT(corner_x(core), 0.95 * far);
  EXPECT_GT(corner_x(core), 0.05 * far);
  Display released;
  core.show(released);
  EXPECT_EQ(released.hand.hold, Hold::nothing);
  EXPECT_EQ(released.hand.traction, rheo::Vec2{});
}

// Physics and what the display is fed with, frame by frame, as the window's thread does it.
TEST(ViewCore, NothingIsAllocatedInAFrame) {
  if (!rheo::test::can_count_allocations()) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  for (const Hold hold : {Hold::push, Hold::grab}) {
    Core core(block(), {});
    ASSERT_TRUE(core.begin(hold, right_of(core.scene())));
    const auto aim = [&](int k) {
      core.aim(hold == Hold::push ? rheo::Vec2{300.0 + k, 0.0} : rheo::Vec2{1e-3 + 1e-6 * k, 0.0}, 1.0);
    };
    std::array<Display, 3> displays;
    const auto frames = [&](int count) {
      bool fine = true;
      for (int k = 0; k < count; ++k) {
        aim(k);
        for (int tick = 0; tick < 16; ++tick) fine = core.tick() && fine;
        core.show(displays[static_cast<std::size_t>(k) % displays.size()]);
      }
      return fine;
    };
    ASSERT_TRUE(frames(12));  // past the first look whether it rests, at 0.1 s
    const rheo::test::AllocationCount count;
    const bool fine = frames(60);
    const rheo::test::Allocations made = count.so_far();
    EXPECT_TRUE(fine);
    EXPECT_EQ(made.calls, 0) << (hold == Hold::push ? "push" : "grab");
  }
}

TEST(ViewCore, AGrabFollowsTheHandAndTellsTheReaction) {
  Core core(block(), {});
  ASSERT_TRUE(core.begin(Hold::grab, right_of(core.scene())));
  core.aim({0.004, 0.001}, 1.0);
  run(core, 150);  // before the stress has relaxed
  Display display;
  core.show(display);
  EXPECT_GT(display.hand.force.x, 0.0);
  run(core, 850);
  // One node of the right side is the table's.
  const auto u = core.live().simulation().u();
  EXPECT_DOUBLE_EQ(u[u.size() - 2], 0.004);
  EXPECT_DOUBLE_EQ(u[u.size() - 1], 0.001);
}

TEST(ViewCore, NothingToGrabWhereTheSceneHoldsAll) {
  Core core(block(), {});
  EXPECT_FALSE(core.begin(Hold::grab, core.scene().mesh.edge_groups.at("bottom")));
  EXPECT_THAT(core.message(), HasSubstr("nothing to grab"));
}

// A traction needs no constraint, and a hold is exact, which such a scene asks not to be.
TEST(ViewCore, UnderBaumgarteABodyIsPushedButNotGrabbed) {
  rheo::Scene scene = block();
  scene.time.constraints = rheo::ConstraintMethod::baumgarte;
  Core core(scene, {});
  ASSERT_TRUE(core.begin(Hold::push, right_of(core.scene()))) << core.message();
  core.aim({300.0, 0.0}, 1.0);
  run(core, 300);
  const double far = corner_x(core);
  EXPECT_GT(far, 1e-4);
  core.let_go();
  run(core, 500);
  EXPECT_LT(corner_x(core), 0.95 * far);
  EXPECT_FALSE(core.begin(Hold::grab, right_of(core.scene())));
  EXPECT_THAT(core.message(), HasSubstr("push"));
  EXPECT_THAT(core.message(), HasSubstr("baumgarte"));
  run(core, 10);
  // What was done is a scene again.
  const auto session = core.session();
  ASSERT_TRUE(session) << core.message();
  rheo::Simulation again(rheo::parse_scene(rheo::scene_text(*session), "session.toml", "."));
  for (std::int64_t k = 0; k < rheo::output_count(again.scene().time); ++k)
    ASSERT_FALSE(again.advance(rheo::output_time(again.scene().time, k)));
  const auto u = again.u(), live = core.live().simulation().u();
  EXPECT_TRUE(std::equal(u.begin(), u.end(), live.begin(), live.end()));
}

TEST(ViewCore, ARefusedStepNamesTheLimitAndTheOldOneGoesOn) {
  Core core(block(), {});
  run(core, 10);
  rheo::Scene edited = core.scene();
  edited.time.step = 1.0;
  EXPECT_FALSE(core.change(edited));
  EXPECT_THAT(core.message(), HasSubstr("stable"));
  EXPECT_EQ(core.scene().time.step, 0.0);
  EXPECT_EQ(core.live().ticks(), 10);
  run(core, 10);
  EXPECT_EQ(core.live().ticks(), 20);
}

TEST(ViewCore, AnotherMaterialGoesOnFromTheSameShape) {
  Core core(block(), {});
  ASSERT_TRUE(core.begin(Hold::push, right_of(core.scene())));
  core.aim({300.0, 0.0}, 1.0);
  run(core, 200);
  const double before = corner_x(core);
  Display books;
  core.show(books);
  rheo::Scene edited = core.scene();
  edited.material.mu_ela *= 3.0;
  ASSERT_TRUE(core.change(edited)) << core.message();
  EXPECT_EQ(corner_x(core), before);
  EXPECT_EQ(core.live().ticks(), 200);
  Display changed;
  core.show(changed);
  const double jump = changed.energies.stored - books.energies.stored;
  EXPECT_LT(jump, 0.0) << "stiffer, the same residual forces hold less";
  EXPECT_NEAR(changed.energies.work - books.energies.work, jump, 1e-12 * books.energies.work);
  run(core, 1);
  Display display;
  core.show(display);
  EXPECT_EQ(display.hand.hold, Hold::push);
  EXPECT_NEAR(display.hand.traction.x, 300.0, 1.0);
  // Its books go on, and the drift with them.
  EXPECT_NEAR(display.energies.work, changed.energies.work, 0.01 * books.energies.work);  // of one tick
  EXPECT_GE(display.energies.dissipated, books.energies.dissipated);
  EXPECT_NEAR(app::view::drift_of(display), 0.0, 1e-6 * display.energies.work);
  EXPECT_FALSE(core.session());
  EXPECT_THAT(core.message(), HasSubstr("changed"));
  core.reset();
  EXPECT_EQ(core.live().ticks(), 0);
  EXPECT_EQ(corner_x(core), 0.0);
  EXPECT_EQ(core.scene().material.mu_ela, edited.material.mu_ela);
}

TEST(ViewCore, ComesToRestAndWakesUp) {
  Core core(block(), {});
  run(core, 700);
  EXPECT_TRUE(core.still());  // nothing ever happened
  ASSERT_TRUE(core.begin(Hold::push, right_of(core.scene())));
  EXPECT_FALSE(core.still());
  core.aim({100.0, 0.0}, 1.0);
  run(core, 700);
  EXPECT_FALSE(core.still());  // it creeps
  core.let_go();
  int ticks = 0;
  while (!core.still() && ticks < 20000) {
    ASSERT_TRUE(core.tick());
    ++ticks;
  }
  EXPECT_LT(ticks, 20000);
}

// A session of pushes and a grab, written as a scene file and read again, gives the same bits with the same
// step.
void expect_session_repeats(rheo::Scene scene, const std::vector<rheo::Edge>& pushed,
                            const std::vector<rheo::Edge>& held) {
  Core core(std::move(scene), {});
  run(core, 20);
  ASSERT_TRUE(core.begin(Hold::push, pushed));
  core.aim({200.0, -80.0}, 0.7);
  run(core, 60);
  core.aim({-100.0, 30.0}, 0.7);
  run(core, 40);
  core.let_go();
  run(core, 30);
  ASSERT_TRUE(core.begin(Hold::grab, held));
  core.aim({0.001, 0.002}, 1.0);
  run(core, 50);
  core.let_go();
  run(core, 17);
  const auto session = core.session();
  ASSERT_TRUE(session) << core.message();
  const std::string text = rheo::scene_text(*session);
  rheo::Simulation again(rheo::parse_scene(text, "session.toml", "."));
  for (std::int64_t k = 0; k < rheo::output_count(again.scene().time); ++k)
    ASSERT_FALSE(again.advance(rheo::output_time(again.scene().time, k)));
  const rheo::Simulation& live = core.live().simulation();
  EXPECT_EQ(again.time(), live.time());
  const auto same = [](std::span<const double> a, std::span<const double> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  };
  EXPECT_TRUE(same(again.u(), live.u()));
  EXPECT_TRUE(same(again.v(), live.v()));
  EXPECT_TRUE(same(again.w_lambda(), live.w_lambda()));
  EXPECT_TRUE(same(again.w_mu(), live.w_mu()));
  EXPECT_EQ(again.counters().steps, live.counters().steps);
  EXPECT_EQ(rheo::scene_text(again.scene()), text);
}

TEST(ViewCore, ASessionReadFromItsTextRepeatsToTheBit) {
  rheo::Scene scene = block();
  rheo::Traction& pulse = scene.tractions.emplace_back();
  pulse.edges = scene.mesh.edge_groups.at("top");
  pulse.keys = {{0.0, {0, 0}}, {0.1, {0, -50}}, {0.2, {0, 0}}};
  const auto pushed = right_of(scene), held = scene.mesh.edge_groups.at("top");
  expect_session_repeats(std::move(scene), pushed, held);
}

TEST(ViewCore, ASessionOfSeveralBodiesAndMaterialsRepeatsToTheBit) {
  const char* const body = R"(
[[body]]
name = "{}"
position = [{}, 0.0]
[body.mesh]
shape = "rectangle"
size = [0.1, 0.05]
nodes = [9, 5]
[body.material]
lambda_ela = {}
mu_ela = 1500
lambda_vis = 800
mu_vis = 300
density = 1000
[[body.fix]]
edges = "bottom"
[[body.region]]
disk = [0.05, 0.025, 0.015]
[body.region.material]
density = 1200
[body.region.material.elastic]
lambda = 2000
mu = 900
[body.region.material.viscous]
lambda = 3
mu = 2
[[body.region.material.maxwell]]
lambda_ela = 3000
mu_ela = 1000
time = 0.1
[[body.region.material.maxwell]]
lambda_ela = 1000
mu_ela = 3000
time = 0.01
)";
  const std::string text = fmt::format(fmt::runtime(body), "left", 0.0, 4000) +
                           fmt::format(fmt::runtime(body), "right", 0.2, 9000) +
                           "[time]\nduration = 5\n[render]\nsheet = [0.0, [1.5, \"half\"]]\n";
  rheo::Scene scene = rheo::parse_scene(text, "bodies.toml", ".");
  ASSERT_EQ(scene.regions.size(), 2u);  // the two disks are of one material
  std::vector<rheo::Edge> pushed, held;
  for (const rheo::Edge& e : scene.mesh.edge_groups.at("boundary")) {
    const rheo::Vec2 p = scene.mesh.points[static_cast<std::size_t>(e[0])],
                     q = scene.mesh.points[static_cast<std::size_t>(e[1])];
    if (p.x == 0.1 && q.x == 0.1) pushed.push_back(e);
    if (p.x > 0.15 && p.y == 0.05 && q.y == 0.05) held.push_back(e);
  }
  ASSERT_EQ(pushed.size(), 4u);
  ASSERT_EQ(held.size(), 8u);
  expect_session_repeats(std::move(scene), pushed, held);
}

TEST(ViewCore, ShowsOneBranchWhereTheSceneAsksForIt) {
  rheo::Scene scene = block();
  scene.material.more_branches.push_back({2000, 900, 40, 18});
  const auto shown = [&](int branch) {
    scene.picture.branch = branch;
    Core core(scene, {});
    EXPECT_TRUE(core.begin(Hold::push, right_of(core.scene())));
    core.aim({300.0, 0.0}, 1.0);
    run(core, 50);
    Display display;
    core.show(display);
    return display;
  };
  const Display all = shown(0), first = shown(1), second = shown(2);
  EXPECT_EQ(all.w_mu_norm, first.w_mu_norm) << "the plots' norms are of all";
  EXPECT_NE(first.w_mu, second.w_mu);
  for (std::size_t i = 0; i < all.w_mu.size(); ++i) {
    EXPECT_LE(all.w_mu[i], (first.w_mu[i] + second.w_mu[i]) * (1 + 1e-12));
    EXPECT_GE(all.w_mu[i], std::abs(first.w_mu[i] - second.w_mu[i]) * (1 - 1e-12));
  }
}

TEST(ViewCore, ABodyThatDivergesIsKeptAndSaysSo) {
  app::view::CoreSettings settings;
  settings.simulation.allow_unstable = true;
  rheo::Scene scene = block();
  scene.time.step = 1e-3;  // a tick; made too long by a hundredfold stiffness
  scene.material.lambda_ela *= 1e4;
  scene.material.mu_ela *= 1e4;
  Core core(std::move(scene), settings);
  ASSERT_TRUE(core.begin(Hold::push, right_of(core.scene())));
  core.aim({10.0, 0.0}, 1.0);
  bool well = true;
  for (int k = 0; k < 1000 && well; ++k) well = core.tick();
  ASSERT_FALSE(well);
  EXPECT_THAT(core.message(), HasSubstr("diverged"));
  EXPECT_FALSE(core.begin(Hold::push, right_of(core.scene())));
  core.reset();
  EXPECT_TRUE(core.tick());
}

TEST(TripleBuffer, TheReaderSeesWholeValuesThatNeverGoBack) {
  struct Pair {
    int a = 0, b = 0;
  };
  app::view::TripleBuffer<Pair> buffer;
  constexpr int last = 20000;
  std::thread writer([&] {
    for (int k = 1; k <= last; ++k) {
      buffer.back() = {k, -k};
      buffer.publish();
    }
  });
  int seen = 0;
  while (seen < last) {
    const Pair& now = buffer.newest();
    ASSERT_EQ(now.a, -now.b);
    ASSERT_GE(now.a, seen);
    seen = now.a;
  }
  writer.join();
}

}  // namespace
}  // namespace view_tests
