// Motions as short as a step of the body: resolved by the automatic step, and no divergence whatever the
// step.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rheo/simulation.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

// The beam's right edge goes 0.1 m within `duration`, rest to rest, and stays there.
Scene jerked_beam(double duration, ConstraintMethod method) {
  Scene scene = paper_beam(Mass::lumped);
  scene.tractions.clear();
  scene.moves.push_back({nodes_of(scene.mesh.edge_groups.at("right")),
                         Axis::both,
                         {},
                         {{0, {0, 0}, {}}, {duration, {0.1, 0}, {}}},
                         Profile::smooth,
                         "right"});
  scene.time.duration = 0.5;
  scene.time.frame_rate = 2;
  scene.time.constraints = method;
  return scene;
}

double largest_difference(std::span<const double> a, std::span<const double> b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max(difference, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return difference / size;
}

struct FastMotion {
  double duration;
  ConstraintMethod method;
};

class FastMotions : public testing::TestWithParam<FastMotion> {};

TEST_P(FastMotions, AreResolvedByTheAutomaticStep) {
  const Scene scene = jerked_beam(GetParam().duration, GetParam().method);
  Scene fine = scene;
  fine.time.step = GetParam().duration / 400;
  Simulation automatic(scene), reference(fine);
  EXPECT_LT(GetParam().duration, 6 * automatic.step_bound()) << "a motion of few steps";
  ASSERT_FALSE(automatic.advance(0.5));
  ASSERT_FALSE(reference.advance(0.5));
  // The automatic step itself, a quarter of the stable one, is good for about a hundredth.
  EXPECT_LT(largest_difference(automatic.u(), reference.u()), 0.01);
  EXPECT_LT(largest_difference(automatic.v(), reference.v()), 0.03);
  EXPECT_LT(largest_difference(automatic.w_lambda(), reference.w_lambda()), 0.01);
  EXPECT_LT(largest_difference(automatic.w_mu(), reference.w_mu()), 0.01);
  EXPECT_EQ(automatic.planned_steps(), automatic.counters().steps);
}

// Whether energies are asked for changes nothing but what is known at the end.
TEST_P(FastMotions, AreNoDivergenceWithAnyStableStep) {
  for (const double steps : {0.2, 1.0, 2.3, 5.0, 50.0}) {
    Scene scene = jerked_beam(GetParam().duration, GetParam().method);
    scene.time.step = GetParam().duration / steps;
    const double stable = Simulation(jerked_beam(1.0, GetParam().method)).stable_step();
    scene.time.step = std::min(scene.time.step, 0.9 * stable);
    Simulation with(scene), without(scene, {.energies = false});
    EXPECT_FALSE(with.advance(0.5)) << steps;
    EXPECT_FALSE(without.advance(0.5)) << steps;
    EXPECT_TRUE(std::equal(with.u().begin(), with.u().end(), without.u().begin())) << steps;
  }
}

// Excuses for what a quadrature misses do not save an unstable run.
TEST_P(FastMotions, AnUnstableStepIsStillNoticed) {
  Scene scene = jerked_beam(GetParam().duration, GetParam().method);
  scene.moves[0].keys.back().t = 10.0;  // moving all the time
  scene.time.duration = 10.0;
  scene.time.step = 1.2 * Simulation(scene).stable_step();
  Simulation simulation(scene, {.allow_unstable = true});
  const auto found = simulation.advance(10.0);
  ASSERT_TRUE(found);
  EXPECT_LT(simulation.counters().steps, 150);
  for (const double x : simulation.u()) EXPECT_TRUE(std::isfinite(x));
}

INSTANTIATE_TEST_SUITE_P(Durations, FastMotions,
                         testing::Values(FastMotion{0.001, ConstraintMethod::automatic},
                                         FastMotion{0.008, ConstraintMethod::automatic},
                                         FastMotion{0.02, ConstraintMethod::automatic},
                                         FastMotion{0.001, ConstraintMethod::baumgarte},
                                         FastMotion{0.008, ConstraintMethod::baumgarte},
                                         FastMotion{0.02, ConstraintMethod::baumgarte}));

}  // namespace
}  // namespace rheo::test
