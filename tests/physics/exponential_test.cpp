// The exponential integrator on whole scenes against the exact solution: the error asked for is the error
// met.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

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

Scene with_material(Scene scene, double lambda_ela, double mu_ela, double lambda_vis, double mu_vis) {
  scene.material = {lambda_ela, mu_ela, lambda_vis, mu_vis, 0.2, scene.material.mass};
  return scene;
}

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

std::vector<ExactState> simulate_with(const Scene& scene, const std::vector<double>& times, Kernel kernel) {
  Simulation simulation(scene, {.kernel = kernel});
  std::vector<ExactState> states;
  for (double t : times) {
    if (simulation.advance(t)) throw std::runtime_error("diverged");
    const auto vector = [](std::span<const double> x) {
      return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())).eval();
    };
    states.push_back({t, vector(simulation.u()), vector(simulation.v()), vector(simulation.w_lambda()),
                      vector(simulation.w_mu())});
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
    for (Kernel kernel : {Kernel::csr, Kernel::edge}) {
      if (kernel == Kernel::edge && scene.material.mass == Mass::consistent) continue;
      const double error = run_error(exact, simulate_with(scene, times, kernel));
      EXPECT_LE(error, 10 * tolerance) << tolerance << (kernel == Kernel::csr ? " csr" : " edge");
      RecordProperty((kernel == Kernel::csr ? "csr" : "edge") + std::to_string(std::log10(tolerance)),
                     std::to_string(std::log10(error)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExponentialScene, testing::ValuesIn(scenarios()),
                         [](const auto& c) { return c.param.name; });

}  // namespace
}  // namespace rheo::test
