// A body at rest takes no steps until something acts, and goes on exactly.

#include <gtest/gtest.h>

#include <cmath>

#include "rheo/live.hpp"
#include "rheo/simulation.hpp"
#include "support/exact.hpp"
#include "support/sanitized.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// The paper's beam, relaxing twice as fast, pulled for 0.2 s at once, at 30 s and upwards at 50.3 s.
Scene pulled_three_times(Mass mass) {
  Scene scene = paper_beam(mass);
  scene.material.lambda_vis /= 2.0;
  scene.material.mu_vis /= 2.0;
  Traction traction = scene.tractions[0];
  scene.tractions.clear();
  for (const double from : {0.0, 30.0, 50.3}) {
    traction.window = {from, from + 0.2};
    if (from > 50.0) traction.keys[0].p = {0.0, 3.0};
    scene.tractions.push_back(traction);
  }
  scene.time.duration = 55.0;
  scene.time.frame_rate = 1.0;
  scene.time.step = 1e-3;
  return scene;
}

TEST(Rest, IsSkippedAndWokenExactly) {
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    const Scene scene = pulled_three_times(mass);
    const std::vector<double> times{1.0, 29.0, 30.1, 50.0, 55.0};
    const auto exact = ExactSolution(scene).at(times);
    // RK4's own error: 1e4 times that of the paper's beam with a tenth of the step (Reference).
    EXPECT_LT(run_error(exact, simulate(scene, times)), mass == Mass::lumped ? 2e-5 : 8e-4);
    Simulation simulation(scene);
    ASSERT_FALSE(simulation.advance(scene.time.duration));
    EXPECT_GT(simulation.counters().steps_at_rest, 15'000) << "within a stretch from event to event too";
    EXPECT_EQ(simulation.counters().steps + simulation.counters().steps_at_rest, 55'000);
    Simulation watched(scene);
    for (std::int64_t k = 0; k < output_count(scene.time); ++k)
      ASSERT_FALSE(watched.advance(output_time(scene.time, k)));
    // 1e-16 is reached some 20 s after a pull: about a third of the steps is at rest.
    EXPECT_GT(watched.counters().steps_at_rest, 15'000);
    EXPECT_EQ(watched.counters().steps + watched.counters().steps_at_rest, watched.planned_steps());
    for (std::size_t i = 0; i < watched.u().size(); ++i) {
      EXPECT_NEAR(watched.u()[i], simulation.u()[i], 1e-12);
      EXPECT_NEAR(watched.w_mu()[i], simulation.w_mu()[i], 1e-12);
    }
  }
}

// A hand pushes, and later grabs, a body at rest: against matrix exponentials of the session, in which
// nothing rests.
TEST(Rest, AHandWakesExactly) {
  Scene scene = pulled_three_times(Mass::lumped);
  scene.tractions.resize(1);
  scene.time.step = 5e-4;
  LiveSettings settings;
  settings.rate = 50.0;
  settings.record = 5000;
  settings.handles.push_back({"hand", {}, scene.mesh.edge_groups.at("right")});
  Live live(scene, settings);
  const auto tick_until = [&](double t) {
    while (live.time() < t - 0.5 / settings.rate && !HasFailure()) EXPECT_FALSE(live.tick());
  };
  const auto at_rest = [&] { return live.simulation().counters().steps_at_rest; };
  tick_until(28.0);
  std::int64_t rested = at_rest();
  EXPECT_GT(rested, 0);
  ASSERT_TRUE(live.press(0, {3.0, 1.0}));
  tick_until(28.2);
  EXPECT_EQ(at_rest(), rested) << "awake at once";
  ASSERT_TRUE(live.push(0, {}));
  tick_until(56.0);
  EXPECT_GT(at_rest(), rested);
  rested = at_rest();
  ASSERT_GT(live.grab(0), 0);
  ASSERT_TRUE(live.drag(0, {0.01, -0.02}));
  tick_until(56.1);
  EXPECT_EQ(at_rest(), rested) << "awake at once";
  live.release(0);
  tick_until(57.0);

  const Simulation& s = live.simulation();
  const auto vector = [](std::span<const double> x) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  const ExactState state{live.time(), vector(s.u()), vector(s.v()), vector(s.w_lambda()), vector(s.w_mu())};
  // RK4's own error (IsSkippedAndWokenExactly), by a step half as long.
  EXPECT_LT(run_error(ExactSolution(live.session()).at({live.time()}), {state}), 2e-5 / 16);
}

TEST(Rest, NothingIsDoneBeforeTheFirstLoad) {
  Scene scene = paper_beam(Mass::lumped);
  scene.tractions[0].window = {3.0, 4.0};
  scene.time.duration = 3.0;
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(2.5));
  EXPECT_EQ(simulation.counters().steps, 0);
  EXPECT_EQ(simulation.counters().force_evaluations, 0);
  EXPECT_GT(simulation.counters().steps_at_rest, 0);
}

// w of a rigid motion holds no energy but goes on to decay: at rest too.
TEST(Rest, ResidualForcesOfARigidMotionGoOnToDecay) {
  Scene scene = paper_beam(Mass::lumped);
  scene.fixes.clear();
  scene.tractions.clear();
  std::vector<int> all(10);
  for (int i = 0; i < 10; ++i) all[i] = i;
  Move move;
  move.nodes = all;
  move.keys = {{0.0, {0.0, 0.0}, {}}, {1.0, {0.3, 0.1}, {}}};
  move.profile = Profile::smooth;
  move.where = "move";
  scene.moves.push_back(move);
  scene.time.duration = 4.0;
  scene.time.step = 1e-3;
  Simulation simulation(scene);
  std::vector<double> w;
  for (double t = 0.5; t <= 4.0; t += 0.5) {
    ASSERT_FALSE(simulation.advance(t));
    w.push_back(simulation.w_lambda()[0]);
  }
  EXPECT_GT(simulation.counters().steps_at_rest, 0);
  const double rate = scene.material.lambda_rate();
  for (std::size_t k = 3; k < w.size(); ++k) EXPECT_NEAR(w[k], w[k - 1] * std::exp(-0.5 * rate), 1e-12);
  EXPECT_GT(std::abs(w.back()), 1e-4);
}

TEST(Rest, WhatIsHeldUnderTensionOrMovesFreelyIsNotAtRest) {
  Scene elastic = paper_beam(Mass::lumped);
  elastic.material.lambda_vis = elastic.material.mu_vis = infinite;
  elastic.tractions[0].window = {0.0, 0.2};
  elastic.time.duration = 3.0;
  Simulation ringing(elastic);
  for (double t = 0.5; t <= 3.0; t += 0.5) ASSERT_FALSE(ringing.advance(t));
  EXPECT_EQ(ringing.counters().steps_at_rest, 0);
}

// A block that finds back: springs and dashpots beside the relaxing branches. Its weight for ever, a traction
// until 15 s.
Scene springy_block(Mass mass) {
  Scene scene = paper_beam(mass);
  scene.material = {7.0, 5.0, 0.7, 0.5, 0.2, mass};
  scene.material.elastic = {6.0, 4.0};
  scene.material.viscous = {0.5, 0.3};
  scene.fixes[0].nodes = nodes_of(scene.mesh.edge_groups.at("bottom"));
  scene.tractions[0].keys[0].p = {1.0, 0.0};
  scene.tractions[0].window = {0.0, 15.0};
  scene.body_acceleration = {0.0, -0.5};
  scene.time.duration = 30.0;
  scene.time.frame_rate = 1.0;
  return scene;
}

// Under sanitizers one is enough: the other's way to rest is ComesUnderLoadsToo's.
std::vector<Mass> masses_of_variants() {
  return is_sanitized ? std::vector{Mass::lumped} : std::vector{Mass::lumped, Mass::consistent};
}

void expect_rest_within(double tolerance, const Scene& scene) {
  const std::vector<double> times{0.5, 3.0, 14.0, 15.25, 16.0, 29.0, 30.0};
  const auto exact = ExactSolution(scene).at(times);
  EXPECT_LT(run_error(exact, simulate(scene, times)), tolerance);
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(scene.time.duration));
  const Counters& counters = simulation.counters();
  // Some 10 s of each 15 pass before nothing goes on; fewer looks at v make less sure of the slowest swing.
  const std::int64_t whole = counters.steps + counters.steps_at_rest;
  EXPECT_GT(counters.steps_at_rest, whole / 40);
  EXPECT_LT(counters.steps_at_rest, whole * 3 / 4);
  Simulation watched(scene);
  for (std::int64_t k = 0; k < output_count(scene.time); ++k)
    ASSERT_FALSE(watched.advance(output_time(scene.time, k)));
  EXPECT_GT(watched.counters().steps_at_rest, whole / 40);
  for (std::size_t i = 0; i < watched.u().size(); ++i)
    EXPECT_NEAR(watched.u()[i], simulation.u()[i], 1e-12) << i;
}

TEST(Rest, ComesUnderLoadsToo) {
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    Scene scene = springy_block(mass);
    scene.time.step = 8e-4;
    expect_rest_within(1e-9, scene);  // RK4's own, three times
  }
}

TEST(Rest, ComesUnderGeneralConstraintsToo) {
  for (const Mass mass : masses_of_variants()) {
    Scene scene = springy_block(mass);
    scene.constraints.push_back({{{9, Axis::x, 1.0}, {8, Axis::x, -1.0}}, 0.01, "constraint"});
    scene.time.step = 8e-4;
    expect_rest_within(2e-9, scene);
  }
}

TEST(Rest, EndsWhereAMoveBeginsOrAHoldLetsGo) {
  for (const Mass mass : masses_of_variants()) {
    Scene moved = springy_block(mass);
    moved.tractions[0].window = {0.0, 30.0};
    moved.time.step = 8e-4;
    Scene let_go = moved;
    moved.moves.push_back(
        {{9}, Axis::x, {15.0, 17.0}, {{15.0, {}, {}}, {16.0, {0.05, 0.0}, {}}}, Profile::smooth, "pinch"});
    expect_rest_within(2e-9, moved);
    let_go.fixes.push_back({{9}, Axis::both, {0.0, 15.0}, "grip"});
    expect_rest_within(2e-9, let_go);
  }
}

TEST(Rest, ComesUnderLoadsByStepsOfAnyLength) {
  for (const Mass mass : masses_of_variants()) {
    Scene scene = springy_block(mass);
    scene.time.step = 0.01;
    scene.time.integrator = IntegratorKind::implicit;
    expect_rest_within(1e-9, scene);
    scene.time.step = 0.1;
    scene.time.integrator = IntegratorKind::exponential;
    expect_rest_within(scene.time.tolerance, scene);
    scene.time.tolerance = finest_tolerance;
    expect_rest_within(2e-12, scene);  // of 400 steps' rounding
  }
}

// Under its weight a Maxwell body sinks for ever, and a purely elastic one swings.
TEST(Rest, NeverComesToWhatCreepsOrSwings) {
  Scene sinking = springy_block(Mass::lumped);
  sinking.material.elastic = {};
  sinking.time.step = 2e-3;
  Simulation sinks(sinking);
  ASSERT_FALSE(sinks.advance(30.0));
  EXPECT_EQ(sinks.counters().steps_at_rest, 0);
  Scene swinging = springy_block(Mass::lumped);
  swinging.material.viscous = {};
  swinging.material.lambda_vis = swinging.material.mu_vis = infinite;
  swinging.time.step = 2e-3;
  Simulation swings(swinging);
  ASSERT_FALSE(swings.advance(30.0));
  EXPECT_EQ(swings.counters().steps_at_rest, 0);
}

// The same block under loads a million times smaller and larger: no length decides.
TEST(Rest, HangsOnNoUnit) {
  std::vector<std::int64_t> steps;
  for (const double scale : {1.0, 1e-6, 1e6}) {
    Scene scene = springy_block(Mass::lumped);
    scene.tractions[0].keys[0].p.x *= scale;
    scene.body_acceleration.y *= scale;
    scene.time.step = 1e-3;
    Simulation simulation(scene);
    ASSERT_FALSE(simulation.advance(15.0));
    steps.push_back(simulation.counters().steps);
  }
  // Roundings differ, and the next look is 64 steps away.
  EXPECT_NEAR(static_cast<double>(steps[1]), static_cast<double>(steps[0]), 640.0);
  EXPECT_NEAR(static_cast<double>(steps[2]), static_cast<double>(steps[0]), 640.0);
}

}  // namespace
}  // namespace rheo::test
