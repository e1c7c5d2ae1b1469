// Materials of many branches with an elastic and a viscous part: every integrator against the matrix
// exponential, energy, momentum, rest.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rheo/dense_flow.hpp"
#include "rheo/error.hpp"
#include "rheo/live.hpp"
#include "rheo/simulation.hpp"
#include "support/exact.hpp"
#include "support/sanitized.hpp"
#include "support/scenes.hpp"
#include "support/whole_materials.hpp"

namespace rheo::test {
namespace {

const std::vector<double> times{0.1, 0.4, 0.8};

// Loads and motions that come and go, on a small irregular body of a random material.
Scene random_scene(std::mt19937& random, Mass mass) {
  Scene scene;
  scene.mesh = rectangle({1.0, 0.6}, 3, 3, Diagonal::alternating);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (Vec2& p : scene.mesh.points) p.x += 0.05 * unit(random), p.y += 0.05 * unit(random);
  prepare(scene.mesh);
  scene.material = random_material(random, 0.2, 4.0, 10.0);
  scene.material.mass = mass;
  scene.body_acceleration = {0.2, -0.5};
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, "left"});
  scene.tractions.push_back(
      {scene.mesh.edge_groups.at("right"), {{0.0, {1.0, 0.0}}, {0.3, {0.4, 0.3}}}, {0.0, 0.45}, "pull"});
  scene.moves.push_back(
      {{8}, Axis::y, {0.2, 0.7}, {{0.2, {}, {}}, {0.5, {0.0, 0.05}, {}}}, Profile::smooth, "lift"});
  scene.time.duration = 0.8;
  scene.time.frame_rate = 20.0;
  return scene;
}

constexpr int exact_scenes = is_sanitized ? 1 : 4, constraint_scenes = is_sanitized ? 1 : 2;

TEST(WholeMaterial, EveryIntegratorFollowsTheExactSolution) {
  std::mt19937 random(1);
  for (int k = 0; k < exact_scenes; ++k) {
    Scene scene = random_scene(random, k % 2 == 0 ? Mass::lumped : Mass::consistent);
    const auto exact = ExactSolution(scene).at(times);
    scene.time.integrator = IntegratorKind::exponential;
    scene.time.tolerance = 1e-11;
    EXPECT_LT(run_error(exact, simulate(scene, times)), 1e-9) << k;
    scene.time.integrator = IntegratorKind::implicit;
    scene.time.step = 0.005;
    EXPECT_LT(run_error(exact, simulate(scene, times)), 1e-5) << k;
    scene.time.integrator = IntegratorKind::rk4;
    scene.time.step = 0.0;
    const double stable = Simulation(scene).stable_step();
    std::vector<double> errors;
    for (const double parts : {8.0, 32.0}) {
      scene.time.step = stable / parts;
      errors.push_back(run_error(exact, simulate(scene, times)));
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[1]) / 2, 4.0, 0.25) << k << ": " << errors[0];
    const auto flow = dense_flow(scene, times);
    std::vector<ExactState> states;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const Eigen::Map<const Eigen::VectorXd> y(flow[i].data(), static_cast<Eigen::Index>(flow[i].size()));
      const Eigen::Index d = y.size() / 4;
      states.push_back(
          {times[i], y.segment(0, d), y.segment(d, d), y.segment(2 * d, d), y.segment(3 * d, d)});
    }
    EXPECT_LT(run_error(exact, states), 1e-9) << k;
  }
}

TEST(WholeMaterial, GeneralConstraintsAndBaumgarteToo) {
  std::mt19937 random(2);
  for (int k = 0; k < constraint_scenes; ++k) {
    Scene scene = random_scene(random, k % 2 == 0 ? Mass::lumped : Mass::consistent);
    scene.moves.clear();
    scene.constraints.push_back({{{5, Axis::x, 1.0}, {1, Axis::x, -1.0}}, 0.01, "tie"});
    if (k == 1) scene.time.constraints = ConstraintMethod::baumgarte;
    const auto exact = ExactSolution(scene).at(times);
    scene.time.step = Simulation(scene).stable_step() / 32;
    EXPECT_LT(run_error(exact, simulate(scene, times)), 1e-5) << k;
    scene.time.integrator = IntegratorKind::implicit;
    scene.time.step = 0.0025;
    EXPECT_LT(run_error(exact, simulate(scene, times)), 1e-5) << k;
  }
}

TEST(WholeMaterial, BranchesByNumberAddUpToTheWhole) {
  std::mt19937 random(3);
  Scene scene = random_scene(random, Mass::lumped);
  scene.material = material_of({{{2.0, 1.0}, {1.0, 30.0}}, 0.5, 0.02}, {{{3.0, 2.0}}, 0.7, 0.03}, 0.2);
  scene.time.step = 1e-3;
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(0.3));
  const auto u = simulation.u(), v = simulation.v();
  const auto l = simulation.w_lambda(), m = simulation.w_mu();
  const auto pl = simulation.pull_lambda(), pm = simulation.pull_mu();
  for (std::size_t i = 0; i < u.size(); ++i) {
    EXPECT_DOUBLE_EQ(l[i], simulation.w_lambda(0)[i] + simulation.w_lambda(1)[i] + 0.02 * v[i]);
    EXPECT_DOUBLE_EQ(m[i], simulation.w_mu(0)[i] + 0.03 * v[i]);
    EXPECT_EQ(simulation.w_mu(1)[i], 0.0);
    EXPECT_NEAR(pl[i], l[i] + 0.5 * u[i], 1e-15);
    EXPECT_NEAR(pm[i], m[i] + 0.7 * u[i], 1e-15);
  }
}

// One branch written as several, and one that never relaxes as an elastic part: the same body.
TEST(WholeMaterial, EquivalentMaterialsMoveAlike) {
  std::mt19937 random(4);
  Scene one = random_scene(random, Mass::lumped);
  one.material = {.lambda_ela = 7, .mu_ela = 5, .lambda_vis = 4, .mu_vis = 2, .density = 0.2};
  one.time.step = 1e-3;
  Scene split = one;
  split.material.lambda_ela = 3, split.material.lambda_vis = 12.0 / 7.0;
  split.material.more_branches.push_back({4.0, 5.0, 16.0 / 7.0, 2.0});
  split.material.mu_ela = 0.0;
  const auto a = simulate(one, times);
  EXPECT_LT(run_error(a, simulate(split, times)), 1e-12);
  one.material.lambda_vis = one.material.mu_vis = forever;
  Scene elastic = one;
  elastic.material.lambda_ela = elastic.material.mu_ela = 0.0;
  elastic.material.elastic = {7.0, 5.0};
  const auto b = simulate(one, times), c = simulate(elastic, times);
  for (std::size_t k = 0; k < times.size(); ++k) {
    EXPECT_LT((b[k].u - c[k].u).norm(), 1e-12 * b[k].u.norm());
    EXPECT_EQ(c[k].w_mu.norm(), 0.0) << "elastic forces are no residual forces";
  }
}

double balance(const Energies& e) {
  return e.kinetic + e.stored + e.dissipated - e.work;
}

TEST(WholeMaterial, EnergyBalanceHasOrderFourAndDissipationNeverFalls) {
  std::mt19937 random(5);
  for (int k = 0; k < 4; ++k) {
    Scene scene = random_scene(random, k % 2 == 0 ? Mass::lumped : Mass::consistent);
    const double stable = Simulation(scene).stable_step();
    std::vector<double> drifts;
    for (const double refinement : {4.0, 8.0, 16.0}) {
      scene.time.step = stable / 4;
      scene.time.refinement = refinement;
      Simulation simulation(scene);
      double worst = 0.0, scale = 0.0, before = 0.0;
      for (int i = 1; i <= 40; ++i) {
        ASSERT_FALSE(simulation.advance(i / 50.0));
        const Energies e = simulation.energies();
        EXPECT_GE(e.dissipated, before);
        before = e.dissipated;
        worst = std::max(worst, std::abs(balance(e)));
        scale = std::max({scale, std::abs(e.work), e.stored});
      }
      drifts.push_back(worst / scale);
    }
    // Fast rates come to the order late: 3.6 to 4.03 here.
    EXPECT_GE(std::log2(drifts.front() / drifts.back()) / 2, 3.5) << k << ": " << drifts.front();
    EXPECT_LT(drifts.back(), 1e-10) << k;
  }
}

TEST(WholeMaterial, AnElasticBodyConservesToTheOrder) {
  Scene scene = paper_beam(Mass::lumped);
  scene.material = material_of({{}, 7.0}, {{}, 5.0}, 0.2);
  std::vector<double> losses;
  for (const double step : {2e-3, 1e-3, 5e-4}) {
    scene.time.step = step;
    Simulation simulation(scene);
    ASSERT_FALSE(simulation.advance(1.0));
    const double released = simulation.energies().kinetic + simulation.energies().stored;
    ASSERT_FALSE(simulation.advance(5.0));
    const Energies later = simulation.energies();
    EXPECT_EQ(later.dissipated, 0.0);
    losses.push_back(std::abs((later.kinetic + later.stored) / released - 1.0));
  }
  // RK4 takes (omega h)^6 / 72 of a mode's energy a step: order 5 of what is lost in a time.
  EXPECT_NEAR(std::log2(losses[0] / losses[2]) / 2, 5.0, 0.2) << losses[0];
}

TEST(WholeMaterial, AFreeBodyKeepsItsMomentum) {
  std::mt19937 random(6);
  for (const IntegratorKind integrator :
       {IntegratorKind::rk4, IntegratorKind::exponential, IntegratorKind::implicit}) {
    Scene scene = random_scene(random, Mass::lumped);
    scene.fixes.clear();
    scene.moves.clear();
    scene.body_acceleration = {};
    scene.tractions[0].keys.resize(1);
    scene.tractions[0].window = {0.0, 0.2};
    scene.time.integrator = integrator;
    Simulation simulation(scene);
    const DenseMatrices m = dense_matrices(scene.mesh, scene.material);
    // Px, Py and the angular momentum about the reference position (linear theory).
    const auto momenta = [&]() {
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      for (int i = 0; i < scene.mesh.node_count(); ++i) {
        const double mass = m.mass(2 * i, 2 * i);
        const double px = mass * simulation.v()[2 * i], py = mass * simulation.v()[2 * i + 1];
        const Vec2 x = scene.mesh.points[i];
        p += Eigen::Vector3d(px, py, x.x * py - x.y * px);
      }
      return p;
    };
    ASSERT_FALSE(simulation.advance(0.2));
    const Eigen::Vector3d begin = momenta();
    ASSERT_FALSE(simulation.advance(0.8));
    EXPECT_GT(begin.norm(), 1e-3);
    EXPECT_LT((momenta() - begin).norm(), 1e-11 * begin.norm());
  }
}

TEST(WholeMaterial, RestIsFoundAndWokenExactly) {
  Scene scene = paper_beam(Mass::lumped);
  scene.material = material_of({{{3.0, 5.0}}, 4.0, 0.3}, {{{2.0, 4.0}, {1.0, 9.0}}, 3.0, 0.2}, 0.2);
  Traction pull = scene.tractions[0];
  pull.window = {0.0, 0.2};
  scene.tractions = {pull};
  pull.window = {60.0, 60.2};
  scene.tractions.push_back(pull);
  scene.time.duration = 61.0;
  scene.time.frame_rate = 1.0;
  const std::vector<double> outputs{1.0, 5.0, 60.1, 61.0};
  const auto exact = ExactSolution(scene).at(outputs);
  scene.time.step = Simulation(scene).stable_step() / 8;
  EXPECT_LT(run_error(exact, simulate(scene, outputs)), 1e-4);
  Simulation watched(scene);
  for (int k = 1; k <= 61; ++k) ASSERT_FALSE(watched.advance(k));
  EXPECT_GT(watched.counters().steps_at_rest, watched.counters().steps / 4);
  for (std::size_t i = 0; i < watched.u().size(); ++i)
    EXPECT_NEAR(watched.u()[i], exact.back().u[static_cast<Eigen::Index>(i)], 1e-4);
}

TEST(WholeMaterial, HandsPushAndGrabAndTheSessionGivesTheSameBits) {
  std::mt19937 random(7);
  Scene scene = random_scene(random, Mass::lumped);
  scene.moves.clear();
  LiveSettings settings;
  settings.rate = 100.0;
  settings.record = 1000;
  settings.handles.push_back({"tip", {8}, scene.mesh.edge_groups.at("right")});
  Live live(scene, settings);
  ASSERT_GT(live.grab(0), 0);
  for (int k = 0; k < 20; ++k) {
    live.drag(0, {0.002 * k, 0.001 * k});
    ASSERT_FALSE(live.tick());
  }
  EXPECT_NE(live.read(0).force.x, 0.0);
  live.release(0);
  live.push(0, {0.5, 0.2});
  for (int k = 0; k < 20; ++k) ASSERT_FALSE(live.tick());
  Simulation again(live.session());
  for (int k = 1; k <= 40; ++k) ASSERT_FALSE(again.advance(k / 100.0));
  for (std::size_t i = 0; i < again.u().size(); ++i) {
    EXPECT_EQ(again.u()[i], live.simulation().u()[i]);
    EXPECT_EQ(again.w_mu()[i], live.simulation().w_mu()[i]);
  }
}

// A dashpot that makes the body a hundred times stiffer than its springs: `auto` stays stable, `accuracy`
// finds an integrator that can do it and what it promises holds.
TEST(WholeMaterial, AStiffViscousPartIsForeseen) {
  Scene scene = paper_beam(Mass::lumped);
  scene.material = material_of({{{7.0, 2.0}}, 2.0, 5.0}, {{{5.0, 2.0}}, 1.0, 3.0}, 0.2);
  scene.tractions[0].window.until = 0.2;
  scene.time.duration = 0.4;
  scene.time.frame_rate = 10.0;
  const std::vector<double> outputs{0.1, 0.2, 0.3, 0.4};
  const auto exact = ExactSolution(scene).at(outputs);
  Scene automatic = scene;
  const Simulation probe(automatic);
  EXPECT_LT(probe.stable_step(), 0.1 * 2.8 / probe.spectrum().omega_max) << "the dashpots rule";
  EXPECT_LT(run_error(exact, simulate(automatic, outputs)), 1e-3);
  for (const double accuracy : {1e-4, 1e-8}) {
    Scene wish = scene;
    wish.time.accuracy = accuracy;
    const double error = run_error(exact, simulate(wish, outputs));
    EXPECT_LT(error, accuracy);
  }
}

TEST(WholeMaterial, EulerHasItsLimitToo) {
  Scene scene = paper_beam(Mass::lumped);
  scene.material = material_of({{{7.0, 2.0}}, 2.0, 0.05}, {{{5.0, 2.0}}, 1.0, 0.03}, 0.2);
  scene.time.integrator = IntegratorKind::euler;
  const std::vector<double> outputs{0.5, 1.0, 2.0};
  const auto exact = ExactSolution(scene).at(outputs);
  scene.time.step = 2e-5;
  EXPECT_LT(run_error(exact, simulate(scene, outputs)), 2e-2);
}

}  // namespace
}  // namespace rheo::test
