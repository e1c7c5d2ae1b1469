// Constraints: exact elimination against Baumgarte, drift, impulses, reactions, and what is refused.

#include <gtest/gtest.h>

#include <cmath>

#include "rheo/error.hpp"
#include "rheo/simulation.hpp"
#include "support/exact.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

std::string refusal(const Scene& scene) {
  try {
    Simulation simulation(scene);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::input);
    return e.what();
  }
  return {};
}

Scene tied_beam(Mass mass) {
  Scene scene = paper_beam(mass);
  scene.constraints.push_back(
      {{{9, Axis::x, 1.0}, {4, Axis::x, -1.0}}, 0.0, "scene.toml:40: [[constraint]]"});
  return scene;
}

TEST(Baumgarte, DriftStaysAtRoundingFromAFulfilledStart) {
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    Scene scene = tied_beam(mass);
    scene.time.constraints = ConstraintMethod::baumgarte;
    Simulation simulation(scene);
    for (double t : {0.5, 1.0, 3.0, 5.0}) {
      ASSERT_FALSE(simulation.advance(t));
      // Displacements of order 1: some roundings of them, which the stabilisation keeps from growing.
      EXPECT_NEAR(simulation.u()[18] - simulation.u()[8], 0.0, 1e-12);
      for (int node : {0, 5}) {
        EXPECT_NEAR(simulation.u()[2 * node], 0.0, 1e-12);
        EXPECT_NEAR(simulation.u()[2 * node + 1], 0.0, 1e-12);
      }
    }
  }
}

TEST(Baumgarte, ViolationDecaysCritically) {
  // c'' = -2 omega c' - omega^2 c from c = c0, c' = 0: c0 (1 + omega t) exp(-omega t), whatever the body
  // does.
  Scene scene = tied_beam(Mass::lumped);
  scene.constraints[0].value = 0.1;
  scene.time.step = 1e-4;
  Simulation simulation(scene);
  for (double t : {0.05, 0.1, 0.3, 1.0}) {
    ASSERT_FALSE(simulation.advance(t));
    const double c = simulation.u()[18] - simulation.u()[8] - 0.1;
    EXPECT_NEAR(c, -0.1 * (1 + 20 * t) * std::exp(-20 * t), 1e-9 * 0.1) << t;  // RK4 at h omega = 2e-3
  }
}

TEST(Baumgarte, DecayOfAViolationIsLeftAloneByOtherConstraints) {
  // The same decay while holds begin and end elsewhere, by elimination and by columns of their own.
  for (ConstraintMethod method : {ConstraintMethod::automatic, ConstraintMethod::baumgarte}) {
    Scene scene = tied_beam(Mass::consistent);
    scene.constraints[0].value = 0.1;
    scene.fixes.push_back({{2}, Axis::both, {0.03, 0.06}, "hold"});
    scene.moves.push_back({{7},
                           Axis::y,
                           {0.02, 0.5},
                           {{0, {0, 0}, {}}, {0.1, {0, 0.01}, {}}, {0.2, {0, 0}, {}}},
                           Profile::linear,
                           "tap"});
    scene.time.constraints = method;
    scene.time.step = 1e-4;
    Simulation simulation(scene);
    for (double t : {0.05, 0.1, 0.3}) {
      ASSERT_FALSE(simulation.advance(t));
      const double c = simulation.u()[18] - simulation.u()[8] - 0.1;
      EXPECT_NEAR(c, -0.1 * (1 + 20 * t) * std::exp(-20 * t), 1e-9 * 0.1) << t;
    }
  }
}

TEST(Baumgarte, AgreesWithEliminationOnFixedNodes) {
  Scene scene = paper_beam(Mass::consistent);
  scene.time.step = 1e-3;
  const auto eliminated = simulate(scene, {0.5, 1.0, 2.0});
  scene.time.constraints = ConstraintMethod::baumgarte;
  // The same dynamics; only rounding differs.
  EXPECT_LT(run_error(eliminated, simulate(scene, {0.5, 1.0, 2.0})), 1e-10);
}

TEST(Elimination, NeedsNoSolve) {
  Simulation lumped(paper_beam(Mass::lumped));
  ASSERT_FALSE(lumped.advance(0.5));
  EXPECT_EQ(lumped.counters().mass_solves, 0);
  EXPECT_EQ(lumped.counters().constraint_solves, 0);
  EXPECT_EQ(lumped.counters().projections, 0);
  Simulation tied(tied_beam(Mass::lumped));
  ASSERT_FALSE(tied.advance(0.5));
  EXPECT_GT(tied.counters().constraint_solves, 0);
}

TEST(Branches, OfAZeroModulusAreNotThere) {
  Scene scene = paper_beam(Mass::lumped);
  scene.material.lambda_ela = 0.0;
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(1.0));
  for (double w : simulation.w_lambda()) EXPECT_EQ(w, 0.0);
  // The same as the exact solution with lambda_ela = 0.
  scene.time.step = 5e-4;
  EXPECT_LT(run_error(ExactSolution(scene).at({0.5, 1.0}), simulate(scene, {0.5, 1.0})), 1e-6);
}

TEST(Multiplier, IsTheForceThatTiesTheNodes) {
  // Pull one of the tied corners only: the tie carries to the other what the balance of forces at that node
  // says.
  Scene scene = tied_beam(Mass::lumped);
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(0.7));
  const double multiplier = simulation.multipliers()[0];
  const auto r = simulation.reaction();
  EXPECT_NEAR(r[18], multiplier, 1e-12 * std::abs(multiplier));
  EXPECT_NEAR(r[8], -multiplier, 1e-12 * std::abs(multiplier));
  EXPECT_GT(std::abs(multiplier), 1e-3);
}

TEST(Impulse, CatchingAMovingEdgeTakesItsEnergyAsWork) {
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    Scene scene = paper_beam(mass);
    scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("right")), Axis::both, {0.25, 0.75}, "catch"});
    scene.time.step = 1e-4;
    Simulation simulation(scene);
    ASSERT_FALSE(simulation.advance(0.24999));
    const Energies before = simulation.energies();
    ASSERT_FALSE(simulation.advance(0.25));  // just after the catch
    const Energies after = simulation.energies();
    EXPECT_LT(after.work, before.work);
    EXPECT_LT(after.kinetic, 0.9 * before.kinetic);
    EXPECT_EQ(simulation.v()[8], 0.0);
    EXPECT_EQ(simulation.v()[19], 0.0);
    const double held = simulation.u()[18];
    ASSERT_FALSE(simulation.advance(0.7));
    EXPECT_EQ(simulation.u()[18], held);
    ASSERT_FALSE(simulation.advance(1.0));
    EXPECT_NE(simulation.u()[18], held);  // let go
    const Energies e = simulation.energies();
    EXPECT_NEAR(e.kinetic + e.stored + e.dissipated - e.work, 0.0, 1e-8 * e.work);
    EXPECT_EQ(simulation.counters().projections, 1);
  }
}

TEST(Move, FollowsItsKeysExactlyAndLetsGo) {
  Scene scene = paper_beam(Mass::consistent);
  scene.tractions.clear();
  scene.moves.push_back({nodes_of(scene.mesh.edge_groups.at("right")),
                         Axis::x,
                         {0.5, 2.0},
                         {{0.0, {0, 0}, {}}, {1.0, {0.2, 9}, {}}},
                         Profile::smooth,
                         "grip"});
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(0.75));
  const auto smooth = [](double s) { return 0.2 * s * s * s * (10 - 15 * s + 6 * s * s); };
  // b(t) = u(from) + key(t) - key(from): begins at t = 0.5 in the middle of the keys, at rest before.
  EXPECT_NEAR(simulation.u()[8], smooth(0.75) - smooth(0.5), 1e-15);
  EXPECT_NE(simulation.u()[9], 0.0);  // y is free
  ASSERT_FALSE(simulation.advance(1.5));
  EXPECT_NEAR(simulation.u()[8], smooth(1.0) - smooth(0.5), 1e-15);
  EXPECT_EQ(simulation.v()[8], 0.0);
  EXPECT_EQ(simulation.held_dofs(), (std::vector<int>{0, 1, 8, 10, 11, 18}));
  ASSERT_FALSE(simulation.advance(2.5));
  EXPECT_EQ(simulation.held_dofs(), (std::vector<int>{0, 1, 10, 11}));
}

TEST(Refused, NodeHeldInTwoWaysAtOnce) {
  Scene scene = paper_beam(Mass::lumped);
  scene.moves.push_back({{5},
                         Axis::y,
                         {0.5, 1.0},
                         {{0, {0, 0}, {}}, {1, {0, 1}, {}}},
                         Profile::smooth,
                         "scene.toml:30: [[move]]"});
  const std::string text = refusal(scene);
  EXPECT_NE(text.find("scene.toml:30: [[move]]: node 5 is held in y by left"), std::string::npos) << text;
  scene.fixes[0].window.until = 0.5;  // hands over instead
  EXPECT_EQ(refusal(scene), "");
}

TEST(Refused, ButOverlapsThatAgreeAreFine) {
  Scene scene = paper_beam(Mass::lumped);
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("bottom")), Axis::y, {}, "bottom"});
  EXPECT_EQ(refusal(scene), "");
  const Move move{{4, 9}, Axis::both, {}, {{0, {0, 0}, {}}, {1, {0.1, 0}, {}}}, Profile::smooth, "grip"};
  scene.fixes.pop_back();
  scene.moves = {move, move};
  EXPECT_EQ(refusal(scene), "");
}

TEST(Refused, DependentConstraints) {
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    Scene scene = tied_beam(mass);
    scene.constraints.push_back(
        {{{9, Axis::x, -2.0}, {4, Axis::x, 2.0}}, 0.0, "scene.toml:44: [[constraint]]"});
    std::string text = refusal(scene);
    EXPECT_NE(text.find("[[constraint]]: this constraint follows from the others"), std::string::npos)
        << text;
    scene.constraints[1].value = 0.5;
    text = refusal(scene);
    EXPECT_NE(text.find("contradicts the others"), std::string::npos) << text;
    // Three that depend only together.
    scene = tied_beam(mass);
    scene.constraints.push_back({{{9, Axis::x, 1.0}, {3, Axis::y, 1.0}}, 0.0, "b"});
    EXPECT_EQ(refusal(scene), "");
    scene.constraints.push_back({{{4, Axis::x, 1.0}, {3, Axis::y, 1.0}}, 0.0, "c"});
    EXPECT_NE(refusal(scene).find("follows from"), std::string::npos);
  }
}

TEST(Refused, BaumgarteThatWantsMoreStepsThanAnyRunTakes) {
  Scene scene = paper_beam(Mass::lumped);
  scene.constraints.push_back({{{9, Axis::x, 1.0}, {4, Axis::x, -1.0}}, 0.0, "tie"});
  scene.time.baumgarte = 1e12;
  try {
    Simulation simulation(scene);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("baumgarte"), std::string::npos) << error.what();
  }
}

TEST(Refused, ConstraintOnHeldNodesOnly) {
  Scene scene = paper_beam(Mass::lumped);
  scene.constraints.push_back(
      {{{0, Axis::x, 1.0}, {5, Axis::x, -1.0}}, 0.0, "scene.toml:40: [[constraint]]"});
  EXPECT_NE(refusal(scene).find("all its nodes are held"), std::string::npos) << refusal(scene);
}

TEST(Simulation, FollowsTheSameCourseWhateverTheCallsBetween) {
  // advance() in one go and in pieces that divide the same steps give the same numbers.
  Scene scene = paper_beam(Mass::consistent);
  scene.time.step = 1.0 / 1024;
  Simulation once(scene), pieces(scene);
  ASSERT_FALSE(once.advance(0.75));
  for (double t : {0.25, 0.5, 0.75}) ASSERT_FALSE(pieces.advance(t));
  for (std::size_t i = 0; i < once.u().size(); ++i) EXPECT_EQ(once.u()[i], pieces.u()[i]);
}

// A body that hangs at rest pulls at its clamp with all of its weight, that of the clamped nodes too.
TEST(Probe, OfAClampReadsTheWeightThatHangsOnIt) {
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    for (ConstraintMethod method : {ConstraintMethod::automatic, ConstraintMethod::baumgarte}) {
      Scene scene;
      scene.mesh = rectangle({0.1, 0.1}, 3, 3);
      scene.material = {4e4, 2e4, forever, 2e2, 1000, mass};
      scene.body_acceleration = {0.0, -9.81};
      scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("top")), Axis::both, {}, ""});
      scene.time.duration = 2.0;
      scene.time.constraints = method;
      Simulation simulation(scene);
      ASSERT_FALSE(simulation.advance(2.0));
      const ProbeReading reading = simulation.read({"top", scene.fixes[0].nodes, {}, ""});
      // Shear relaxes within 10 ms, and with it nearly all vibration.
      EXPECT_NEAR(reading.force.y, 0.1 * 0.1 * 1000 * 9.81, 1e-3);
      EXPECT_NEAR(reading.force.x, 0.0, 1e-3);
    }
  }
}

}  // namespace
}  // namespace rheo::test
