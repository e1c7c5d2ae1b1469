// kinetic + stored + dissipated - work stays constant, to the integrator's order.

#include <gtest/gtest.h>

#include <cmath>

#include "rheo/simulation.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

double balance(const Energies& e) {
  return e.kinetic + e.stored + e.dissipated - e.work;
}

Scene short_beam(Mass mass) {
  Scene scene = paper_beam(mass);
  scene.mesh = rectangle({2.0, 1.0}, 3, 2);
  scene.fixes[0].nodes = nodes_of(scene.mesh.edge_groups.at("left"));
  scene.tractions[0].edges = scene.mesh.edge_groups.at("right");
  scene.tractions[0].keys = {{0.0, {10, 0}}, {0.31, {4, 3}}, {0.77, {6, -8}}};
  scene.tractions[0].window = {0.0, 0.7654321};
  scene.body_acceleration = {0.3, -1.0};
  scene.time.duration = 1.0;
  return scene;
}

Scene moving_beam(Mass mass, Profile profile) {
  Scene scene = short_beam(mass);
  scene.moves.push_back({nodes_of(scene.mesh.edge_groups.at("right")),
                         Axis::both,
                         {0.1, 0.8},
                         {{0.0, {0, 0}, {0, 0}}, {0.4321, {0.2, 0.1}, {0.3, 0}}, {0.7, {0.1, 0}, {0, 0}}},
                         profile,
                         "grip"});
  return scene;
}

// Largest imbalance at the outputs over the work's turnover.
double imbalance(Scene scene, double step) {
  scene.time.step = step;
  Simulation simulation(scene);
  double worst = 0.0, scale = 0.0;
  for (int k = 0; k <= 20; ++k) {
    EXPECT_FALSE(simulation.advance(k / 20.0));
    worst = std::max(worst, std::abs(balance(simulation.energies())));
    scale = std::max({scale, std::abs(simulation.energies().work), simulation.energies().stored});
  }
  return worst / scale;
}

// Over two halvings, from steps so small that the leading term rules to steps where rounding does not yet.
void expect_order(const Scene& scene, double first_step, double order) {
  std::vector<double> drifts;
  for (int halving = 0; halving <= 2; ++halving)
    drifts.push_back(imbalance(scene, first_step / std::exp2(halving)));
  std::string all;
  for (double d : drifts) all += std::to_string(std::log10(d)) + " ";
  EXPECT_NEAR(std::log2(drifts.front() / drifts.back()) / 2, order, 0.1) << "log10 of the drifts: " << all;
}

TEST(Energy, BalanceHasOrderFourUnderLoads) {
  expect_order(short_beam(Mass::lumped), 1e-3, 4.0);
  expect_order(short_beam(Mass::consistent), 5e-4, 4.0);
}

TEST(Energy, BalanceHasOrderFourWithMovingConstraints) {
  expect_order(moving_beam(Mass::lumped, Profile::smooth), 1e-3, 4.0);
  expect_order(moving_beam(Mass::consistent, Profile::smooth), 5e-4, 4.0);
  expect_order(moving_beam(Mass::lumped, Profile::hermite), 1e-3, 4.0);
}

TEST(Energy, BalanceHasOrderFourWithImpulses) {
  expect_order(moving_beam(Mass::lumped, Profile::linear), 1e-3, 4.0);
  expect_order(moving_beam(Mass::consistent, Profile::linear), 5e-4, 4.0);
}

TEST(Energy, BalanceHasOrderFourWithGeneralConstraints) {
  Scene scene = short_beam(Mass::lumped);
  scene.constraints.push_back({{{5, Axis::x, 1.0}, {2, Axis::x, -1.0}}, 0.05, "tie"});
  expect_order(scene, 1e-3, 4.0);
  scene.material.mass = Mass::consistent;
  expect_order(scene, 5e-4, 4.0);
  Scene all = moving_beam(Mass::lumped, Profile::smooth);
  all.time.constraints = ConstraintMethod::baumgarte;
  expect_order(all, 1e-3, 4.0);
}

TEST(Energy, BalanceHasOrderOneWithEuler) {
  Scene scene = short_beam(Mass::lumped);
  scene.time.integrator = IntegratorKind::euler;
  expect_order(scene, 1e-4, 1.0);
}

TEST(Energy, ElasticBodyConserves) {
  Scene scene = paper_beam(Mass::consistent);
  scene.material.lambda_vis = scene.material.mu_vis = forever;
  scene.time.step = 1e-3;
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(1.0));
  const Energies released = simulation.energies();
  ASSERT_FALSE(simulation.advance(5.0));
  const Energies later = simulation.energies();
  EXPECT_EQ(later.dissipated, 0.0);
  EXPECT_EQ(later.work, released.work);
  // RK4 takes (omega h)^6 / 72 of a mode's energy a step; the beam's modes up to 220 rad/s, mostly the low
  // ones.
  EXPECT_NEAR((later.kinetic + later.stored) / (released.kinetic + released.stored), 1.0, 1e-3);
  EXPECT_GT(later.kinetic + later.stored, 0.1 * released.work);
}

TEST(Energy, DissipationNeverFalls) {
  Simulation simulation(moving_beam(Mass::lumped, Profile::smooth));
  double before = 0.0;
  for (int k = 1; k <= 100; ++k) {
    ASSERT_FALSE(simulation.advance(k / 100.0));
    const double now = simulation.energies().dissipated;
    EXPECT_GE(now, before);
    before = now;
  }
  EXPECT_GT(before, 0.0);
}

TEST(Energy, WorkOfAConstantLoadIsForceTimesDisplacement) {
  const Scene scene = paper_beam(Mass::lumped);
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(0.8));
  // 10 Pa over 0.25 m of thickness 1 m, half at each of nodes 4 and 9.
  const double expected = 1.25 * (simulation.u()[8] + simulation.u()[18]);
  EXPECT_NEAR(simulation.energies().work, expected, 1e-12 * expected);
}

}  // namespace
}  // namespace rheo::test
