// Units do not matter: a scene in m-kg-s, mm-g-ms and km-t-h gives one answer, to 1e-10 of the largest in
// each block, whatever the integrator, the kernel, the material, the loads and the constraints. No tolerance
// in the engine is absolute; what has units of its own are the defaults of frame_rate, baumgarte and
// grab_time, which a scene in other units has to give, and the bounds of limits.hpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "rheo/error.hpp"
#include "rheo/live.hpp"
#include "support/event_scenes.hpp"
#include "support/live_scenes.hpp"
#include "support/units.hpp"
#include "support/whole_materials.hpp"

namespace rheo::test {
namespace {

constexpr double promised = 1e-10;

// Numbers of one kind over a run, and the largest of them.
struct Block {
  std::vector<double> values;
  double largest = 0.0;

  void add(std::span<const double> x, double unit) {
    for (const double value : x) add(value, unit);
  }
  void add(double value, double unit) {
    values.push_back(value / unit);  // in SI
    largest = std::max(largest, std::abs(values.back()));
  }
};

struct Answer {
  Block u, v, w, reactions, energies, limits;
  std::int64_t steps = 0;
};

void look(Simulation& simulation, const Units& units, Answer& answer) {
  answer.u.add(simulation.u(), units.length);
  answer.v.add(simulation.v(), units.velocity());
  for (const auto w : {simulation.w_lambda(), simulation.w_mu()}) answer.w.add(w, units.residual_force());
  answer.reactions.add(simulation.reaction(), units.force());
  const Energies e = simulation.energies();
  for (const double energy : {e.kinetic, e.stored, e.dissipated, e.work})
    answer.energies.add(std::isnan(energy) ? 0.0 : energy, units.energy());
}

Answer answer_in(const Units& units, const Scene& scene, const SimulationOptions& options = {}) {
  Simulation simulation(in_units(units, scene), options);
  Answer answer;
  const TimeSettings& time = simulation.scene().time;
  for (std::int64_t k = 0; k < output_count(time); ++k) {
    const auto diverged = simulation.advance(output_time(time, k));
    EXPECT_FALSE(diverged) << units.name;
    if (diverged) break;
    look(simulation, units, answer);
  }
  answer.steps = simulation.counters().steps + simulation.counters().steps_at_rest;
  for (const double step : {simulation.stable_step(), simulation.step_bound()})
    if (std::isfinite(step)) answer.limits.add(step, units.time);
  return answer;
}

double difference(const Block& a, const Block& b) {
  if (a.values.size() != b.values.size()) return std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    worst = std::max(worst, std::abs(a.values[i] - b.values[i]));
  return a.largest > 0.0 ? worst / a.largest : worst;
}

void expect_same(const Answer& a, const Answer& b, const std::string& what) {
  EXPECT_GT(a.u.largest, 0.0) << what << ": nothing moved";
  EXPECT_LE(difference(a.u, b.u), promised) << what << ": u";
  EXPECT_LE(difference(a.v, b.v), promised) << what << ": v";
  EXPECT_LE(difference(a.w, b.w), promised) << what << ": w";
  EXPECT_LE(difference(a.reactions, b.reactions), promised) << what << ": reactions";
  EXPECT_LE(difference(a.energies, b.energies), promised) << what << ": energies";
  EXPECT_LE(difference(a.limits, b.limits), promised) << what << ": steps";
  EXPECT_EQ(a.steps, b.steps) << what;
}

void expect_no_units(const Scene& scene, const std::string& what, const SimulationOptions& options = {}) {
  const Answer si = answer_in({}, scene, options);
  for (const Units& units : {millimetre_gram_millisecond, kilometre_tonne_hour})
    expect_same(si, answer_in(units, scene, options), what + ", " + units.name);
}

struct Case {
  const char* name;
  Scene scene;
};

std::vector<Case> cases(Mass mass) {
  return {{"pulled", off_grid_beam(mass)},
          {"ramped", ramped(mass)},
          {"smooth motion", moved(mass, Profile::smooth)},
          {"linear motion", moved(mass, Profile::linear)},
          {"hermite motion", moved(mass, Profile::hermite)},
          {"motion by Baumgarte", baumgarte(moved(mass, Profile::smooth))},
          {"tied", tied(mass)},
          {"pulled together", pulled_together(mass)},
          {"roller", roller(mass)},
          {"caught", caught(mass)}};
}

class UnitsOf : public testing::TestWithParam<IntegratorKind> {};

TEST_P(UnitsOf, LoadsMotionsAndConstraintsDoNotMatter) {
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    for (Case& each : cases(mass)) {
      Scene& scene = each.scene;
      const bool columns =
          !scene.constraints.empty() || scene.time.constraints == ConstraintMethod::baumgarte;
      if (columns && GetParam() == IntegratorKind::exponential) continue;  // refused
      scene.time.integrator = GetParam();
      scene.body_acceleration = {0.3, -1.0};
      expect_no_units(scene, each.name);
    }
  }
}

TEST_P(UnitsOf, MaterialsDoNotMatter) {
  std::mt19937 random(7);
  for (int k = 0; k < 6; ++k) {
    Scene scene = k % 2 == 0 ? ramped(Mass::lumped) : moved(Mass::consistent, Profile::smooth);
    const Mass mass = scene.material.mass;
    scene.mesh = rectangle({2.0, 1.0}, 4, 3, Diagonal::alternating);
    scene.fixes[0].nodes = nodes_of(scene.mesh.edge_groups.at("left"));
    for (Traction& traction : scene.tractions) traction.edges = scene.mesh.edge_groups.at("right");
    for (Move& move : scene.moves) move.nodes = right_nodes(scene);
    scene.material = random_material(random, 0.2, 5.0, 30.0);
    scene.material.mass = mass;
    if (k >= 3) {
      scene.regions = {{"other", random_material(random, 0.3, 20.0, 10.0), {}, "other"}};
      scene.regions[0].material.mass = mass;
      for (int t = 0; t < scene.mesh.triangle_count(); ++t) scene.region_of_triangle.push_back(t % 2);
    }
    scene.time.integrator = GetParam();
    scene.time.duration = 0.5;
    if (GetParam() == IntegratorKind::euler) {
      const Simulation probe(scene, {.allow_unstable = true});
      if (probe.stable_step() == 0.0) continue;
    }
    expect_no_units(scene, "material " + std::to_string(k));
  }
}

TEST_P(UnitsOf, RestDoesNotMatter) {
  Scene scene = off_grid_beam(Mass::lumped);
  scene.tractions[0].window = {0.0, 0.3};
  scene.time.duration = 60.0;  // at rest after some 40 s
  scene.time.frame_rate = 0.5;
  scene.time.integrator = GetParam();
  if (GetParam() == IntegratorKind::euler) scene.time.step = 2e-3;
  expect_no_units(scene, "rest");
}

INSTANTIATE_TEST_SUITE_P(All, UnitsOf,
                         testing::Values(IntegratorKind::rk4, IntegratorKind::euler,
                                         IntegratorKind::exponential, IntegratorKind::implicit),
                         [](const auto& i) {
                           switch (i.param) {
                             case IntegratorKind::rk4:
                               return "Rk4";
                             case IntegratorKind::euler:
                               return "Euler";
                             case IntegratorKind::exponential:
                               return "Exponential";
                             default:
                               return "Implicit";
                           }
                         });

TEST(UnitsOfKernels, DoNotMatter) {
  for (const Kernel kernel : {Kernel::csr, Kernel::edge, Kernel::element}) {
    Scene scene = ramped(Mass::lumped);
    scene.mesh = rectangle({2.0, 1.0}, 13, 9, Diagonal::alternating);
    scene.fixes[0].nodes = nodes_of(scene.mesh.edge_groups.at("left"));
    scene.tractions[0].edges = scene.mesh.edge_groups.at("right");
    expect_no_units(scene, "kernel", {.kernel = kernel});
  }
}

// What is chosen for an accuracy, and what it comes to.
TEST(UnitsOfAccuracy, DoNotMatter) {
  for (const IntegratorKind integrator :
       {IntegratorKind::rk4, IntegratorKind::exponential, IntegratorKind::implicit}) {
    Scene scene = ramped(Mass::lumped);
    scene.time.integrator = integrator;
    scene.time.accuracy = 1e-4;
    const AccuracyPlan si = plan_accuracy(scene, {});
    for (const Units& units : {millimetre_gram_millisecond, kilometre_tonne_hour}) {
      const AccuracyPlan other = plan_accuracy(in_units(units, scene), {});
      EXPECT_EQ(other.integrator, si.integrator) << units.name;
      EXPECT_NEAR(other.refinement, si.refinement, promised * si.refinement) << units.name;
      EXPECT_NEAR(other.step / units.time, si.step, promised * si.step) << units.name;
      EXPECT_NEAR(other.tolerance, si.tolerance, 1e-6 * si.tolerance) << units.name;
      EXPECT_EQ(other.evaluations, si.evaluations) << units.name;
    }
  }
}

// A run beyond the limit is noticed at the same step, with the same energy.
TEST(UnitsOfDivergence, DoNotMatter) {
  Scene scene = off_grid_beam(Mass::lumped);
  scene.time.frame_rate = 1e-3;
  scene.time.duration = 1000.0;
  scene.time.step = 1.2 * Simulation(scene).stable_step();
  const auto divergence = [&](const Units& units) {
    Simulation simulation(in_units(units, scene), {.allow_unstable = true});
    return simulation.advance(1000.0 * units.time);
  };
  const auto si = divergence({});
  ASSERT_TRUE(si);
  for (const Units& units : {millimetre_gram_millisecond, kilometre_tonne_hour}) {
    const auto other = divergence(units);
    ASSERT_TRUE(other) << units.name;
    EXPECT_EQ(other->node, si->node);
    EXPECT_NEAR(other->t / units.time, si->t, promised * si->t);
    // (Rounding grows like all else.)
    EXPECT_NEAR(other->energy / units.energy(), si->energy, 1e-6 * si->energy);
  }
}

TEST(UnitsOfHands, DoNotMatter) {
  const auto session = [](const Units& units) {
    const Scene scene = in_units(units, live_block(Mass::lumped));
    LiveSettings settings = live_settings(scene);
    settings.rate /= units.time;
    settings.grab_time *= units.time;
    Live live(scene, settings);
    Answer answer;
    const auto push = [&](int handle, Vec2 p) { live.push(handle, times(units.stress(), p)); };
    for (int k = 0; k < 60; ++k) {
      if (k == 3) push(push_handle, {5.0, -20.0});
      if (k == 20) push(push_handle, {});
      if (k == 15) live.grab(grab_handle);
      if (k > 15 && k < 35) live.drag(grab_handle, times(units.length, {1e-4 * (k - 15), -2e-4}));
      if (k == 36)
        live.drag(grab_handle, times(units.length, {1e-3, 0.0}), times(units.velocity(), {0.02, 0}));
      if (k == 40) live.release(grab_handle);
      EXPECT_FALSE(live.tick());
      const HandReading hand = live.read(grab_handle);
      answer.u.add(live.simulation().u(), units.length);
      answer.v.add(live.simulation().v(), units.velocity());
      answer.w.add(live.simulation().w_mu(), units.residual_force());
      answer.reactions.add(hand.force.x, units.force());
      answer.reactions.add(hand.force.y, units.force());
      answer.energies.add(live.simulation().energies().work, units.energy());
    }
    answer.steps = live.simulation().counters().steps;
    return answer;
  };
  const Answer si = session({});
  for (const Units& units : {millimetre_gram_millisecond, kilometre_tonne_hour})
    expect_same(si, session(units), units.name);
}

}  // namespace
}  // namespace rheo::test
