// The exponential integrator on whole scenes against the exact solution: the error asked for is the error
// met.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "rheo/error.hpp"
#include "rheo/simulation.hpp"
#include "support/event_scenes.hpp"
#include "support/exact.hpp"

namespace rheo::test {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

struct ScenarioCase {
  std::string name;
  std::function<Scene()> scene;
  friend void PrintTo(const ScenarioCase& c, std::ostream* out) { *out << c.name; }
};

Scene falling(Mass mass) {
  Scene scene = off_grid_beam(mass);
  scene.body_acceleration = {0.5, -9.81};
  return scene;
}

Scene let_go(Mass mass) {  // free flight after the only fix has gone
  Scene scene = falling(mass);
  scene.fixes[0].window.until = 0.41421;
  return scene;
}

std::vector<ScenarioCase> scenarios() {
  std::vector<ScenarioCase> all;
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    const std::string m = mass == Mass::lumped ? "Lumped" : "Consistent";
    const auto add = [&](const std::string& name, std::function<Scene()> scene) {
      all.push_back({m + name, std::move(scene)});
    };
    add("Pull", [=] { return off_grid_beam(mass); });
    add("Ramp", [=] { return ramped(mass); });
    add("Roller", [=] { return roller(mass); });
    add("Caught", [=] { return caught(mass); });
    add("MoveSmooth", [=] { return moved(mass, Profile::smooth); });
    add("MoveLinear", [=] { return moved(mass, Profile::linear); });
    add("MoveHermite", [=] { return moved(mass, Profile::hermite); });
    add("BodyForce", [=] { return falling(mass); });
    add("LetGo", [=] { return let_go(mass); });
    add("Elastic", [=] { return with_material(roller(mass), 7, 5, inf, inf); });
    add("OneRelaxes", [=] { return with_material(moved(mass, Profile::smooth), 7, 5, inf, 2); });
    add("NoLambda", [=] { return with_material(caught(mass), 0, 5, 4, 2); });
    add("NoMu", [=] { return with_material(off_grid_beam(mass), 7, 0, 4, 2); });
    add("SoftMu", [=] { return with_material(ramped(mass), 7, 0.007, 4, 2); });
    // Fastest frequency about 30 /s: rates of 70, 700 and 35000 /s.
    add("RelaxesFast", [=] { return with_material(ramped(mass), 7, 5, 0.1, 0.5); });
    add("RelaxesFaster", [=] { return with_material(moved(mass, Profile::hermite), 7, 5, 0.01, 0.02); });
    add("RelaxesInstantly", [=] { return with_material(off_grid_beam(mass), 7, 5, 0.0002, 0.001); });
  }
  return all;
}

// The states after every `stride`th of the calls of advance to `times`.
std::vector<ExactState> run_through(Simulation& simulation, const std::vector<double>& times,
                                    std::size_t stride) {
  std::vector<ExactState> states;
  for (std::size_t k = 1; k <= times.size(); ++k) {
    if (simulation.advance(times[k - 1])) throw std::runtime_error("diverged");
    if (k % stride != 0) continue;
    const auto vector = [](std::span<const double> x) {
      return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())).eval();
    };
    states.push_back({times[k - 1], vector(simulation.u()), vector(simulation.v()),
                      vector(simulation.w_lambda()), vector(simulation.w_mu())});
  }
  return states;
}

class ExponentialScene : public testing::TestWithParam<ScenarioCase> {};

TEST_P(ExponentialScene, KeepsItsTolerance) {
  Scene scene = GetParam().scene();
  scene.time.integrator = IntegratorKind::exponential;
  const std::vector<double> times{0.02, 0.25, 0.5, 0.75, 1.0};
  const auto exact = ExactSolution(scene).at(times);
  for (double tolerance : {1e-6, 1e-9, 1e-12}) {
    scene.time.tolerance = tolerance;
    for (Kernel kernel : {Kernel::csr, Kernel::edge, Kernel::element}) {
      if (kernel != Kernel::csr && scene.material.mass == Mass::consistent) continue;
      Simulation simulation(scene, {.kernel = kernel});
      const double error = run_error(exact, run_through(simulation, times, 1));
      EXPECT_LE(error, tolerance) << tolerance << " " << simulation.kernel();
      RecordProperty(std::string(simulation.kernel()) + std::to_string(std::log10(tolerance)),
                     std::to_string(std::log10(error)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExponentialScene, testing::ValuesIn(scenarios()),
                         [](const auto& c) { return c.param.name; });

Scene exponential(Scene scene, double tolerance) {
  scene.time.integrator = IntegratorKind::exponential;
  scene.time.tolerance = tolerance;
  return scene;
}

std::vector<double> outputs(const Scene& scene) {
  std::vector<double> times;
  for (std::int64_t k = 1; k < output_count(scene.time); ++k) times.push_back(output_time(scene.time, k));
  return times;
}

// Twice a second: matrix exponentials take their time.
constexpr std::size_t compared = 30;

std::vector<ExactState> exact_at_some(const Scene& scene) {
  std::vector<double> times;
  for (std::size_t k = compared; k <= outputs(scene).size(); k += compared)
    times.push_back(outputs(scene)[k - 1]);
  return ExactSolution(scene).at(times);
}

TEST(Exponential, FollowsThePapersBeamToElevenDigitsAtSixtyHertz) {
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    for (double tolerance : {1e-11, 1e-13}) {
      Simulation simulation(exponential(paper_beam(mass), tolerance));
      ASSERT_EQ(outputs(simulation.scene()).size(), 300u);
      const auto run = run_through(simulation, outputs(simulation.scene()), compared);
      const double error = run_error(exact_at_some(simulation.scene()), run);
      RecordProperty("log10_error", std::to_string(std::log10(error)));
      EXPECT_LE(error, 1e-11);
    }
  }
}

TEST(Exponential, IsTheSameHoweverAnIntervalIsDivided) {
  // One step to the end, or steps of at most 1 ms: both within the tolerance of each other.
  Scene scene = exponential(roller(Mass::lumped), 1e-11);
  const auto whole = simulate(scene, {1.0});
  scene.time.step = 1e-3;
  Simulation divided(scene);
  EXPECT_EQ(divided.step_bound(), 1e-3);
  EXPECT_FALSE(divided.advance(1.0));
  EXPECT_GE(divided.counters().steps + divided.counters().steps_at_rest, 1000);
  for (std::size_t i = 0; i < divided.u().size(); ++i) {
    EXPECT_NEAR(divided.u()[i], whole[0].u[static_cast<Eigen::Index>(i)], 1e-10 * whole[0].u.norm());
  }
}

TEST(Exponential, HasNoStableLimitAndStepsFromEventToEvent) {
  const Scene scene = exponential(off_grid_beam(Mass::lumped), 1e-10);
  Simulation simulation(scene);
  EXPECT_EQ(simulation.stable_step(), inf);
  EXPECT_EQ(simulation.step_bound(), inf);
  EXPECT_EQ(simulation.planned_steps(), 62);  // 60 outputs and 2 events between them
  EXPECT_FALSE(simulation.advance(1.0));
  EXPECT_EQ(simulation.counters().steps, 2);          // from the first event to the second and to the end
  EXPECT_EQ(simulation.counters().steps_at_rest, 1);  // to the first: nothing acts before
  EXPECT_EQ(simulation.time(), 1.0);
}

TEST(Exponential, TakesFarFewerEvaluationsThanRk4ForTheSameError) {
  Scene scene = paper_beam(Mass::lumped);
  scene.time.duration = 2.0;
  const auto exact = exact_at_some(scene);
  const auto cost = [&](const Scene& s) {
    Simulation simulation(s, {.energies = false});
    EXPECT_LE(run_error(exact, run_through(simulation, outputs(s), compared)), 2e-9);
    return simulation.counters().force_evaluations;
  };
  Scene rk4 = scene;
  rk4.time.step = 1e-4;
  EXPECT_GE(cost(rk4), 20 * cost(exponential(scene, 2e-9)));
}

TEST(Exponential, KeepsTheEnergyOfAnElasticBody) {
  Scene scene = exponential(with_material(paper_beam(Mass::lumped), 7, 5, inf, inf), 1e-12);
  Simulation simulation(scene);
  for (double t : outputs(scene)) {
    ASSERT_FALSE(simulation.advance(t));
    const Energies e = simulation.energies();
    EXPECT_EQ(e.dissipated, 0.0);
    EXPECT_NEAR(e.kinetic + e.stored, e.work, 1e-11 * (e.work + 1.0)) << t;
  }
}

TEST(Exponential, LeavesOutWhatAQuadratureOverItsLongStepsWouldGetWrong) {
  const auto energies = [](Scene scene) {
    Simulation simulation(exponential(std::move(scene), 1e-9));
    EXPECT_FALSE(simulation.advance(0.5));
    EXPECT_GT(simulation.energies().kinetic, 0.0);
    EXPECT_GT(simulation.energies().stored, 0.0);
    return simulation.energies();
  };
  EXPECT_TRUE(std::isnan(energies(off_grid_beam(Mass::lumped)).dissipated));
  EXPECT_GT(energies(off_grid_beam(Mass::lumped)).work, 0.0);
  EXPECT_TRUE(std::isnan(energies(ramped(Mass::lumped)).work));
  EXPECT_TRUE(std::isnan(energies(moved(Mass::consistent, Profile::smooth)).work));
}

TEST(Exponential, WorkOfConstantLoadsAndImpulsesIsThatOfAFineRk4Run) {
  for (const Scene& scene : {off_grid_beam(Mass::lumped), caught(Mass::consistent), let_go(Mass::lumped)}) {
    Scene fine = scene;
    fine.time.step = 1e-4;
    Simulation reference(fine), simulation(exponential(scene, 1e-11));
    for (double t : {0.3, 0.6, 1.0}) {
      ASSERT_FALSE(reference.advance(t));
      ASSERT_FALSE(simulation.advance(t));
      // RK4's error at this step is below 1e-8.
      EXPECT_NEAR(simulation.energies().work, reference.energies().work,
                  1e-7 * std::abs(reference.energies().work));
    }
  }
}

TEST(Exponential, StaysExactlyAtRestWithoutLoads) {
  Scene scene = exponential(paper_beam(Mass::lumped), 1e-10);
  scene.tractions.clear();
  Simulation simulation(scene);
  EXPECT_FALSE(simulation.advance(5.0));
  for (double x : simulation.u()) EXPECT_EQ(x, 0.0);
}

TEST(Exponential, ReachesItsToleranceWhereOneResidualForceIsAMillionthOfTheOther) {
  const Scene uneven = exponential(with_material(off_grid_beam(Mass::lumped), 4, 0.004, 6, 5e-7), 1e-9);
  const std::vector<double> times{0.2, 0.5, 1.0};
  EXPECT_LE(run_error(ExactSolution(uneven).at(times), simulate(uneven, times)), 1e-8);
}

TEST(Exponential, RefusesWhatNeedsBaumgarte) {
  for (const Scene& scene : {tied(Mass::lumped), baumgarte(off_grid_beam(Mass::lumped))}) {
    try {
      Simulation simulation(exponential(scene, 1e-10));
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::input);
      EXPECT_NE(std::string(error.what()).find("use \"rk4\""), std::string::npos) << error.what();
    }
  }
}

TEST(Exponential, RefusesATolerancePastRounding) {
  for (double tolerance : {0.0, 1e-14, 0.5, std::nan("")}) {
    EXPECT_THROW(Simulation{exponential(off_grid_beam(Mass::lumped), tolerance)}, Error) << tolerance;
  }
}

}  // namespace
}  // namespace rheo::test
