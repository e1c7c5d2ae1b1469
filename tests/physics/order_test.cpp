// Convergence order of the integrators on whole scenes against the exact solution: both masses, every kind of
// constraint, events off the step grid.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "rheo/simulation.hpp"
#include "support/exact.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

struct OrderCase {
  std::string name;
  std::function<Scene()> scene;
  friend void PrintTo(const OrderCase& c, std::ostream* out) { *out << c.name; }
};

// A short beam of large triangles (so that many steps are quick), with a pull that begins and ends at times
// no output or round step meets.
Scene off_grid_beam(Mass mass) {
  Scene scene = paper_beam(mass);
  scene.mesh = rectangle({2.0, 1.0}, 3, 2);
  scene.fixes[0].nodes = nodes_of(scene.mesh.edge_groups.at("left"));
  scene.tractions[0].edges = scene.mesh.edge_groups.at("right");
  scene.tractions[0].window = {0.1234567, 0.7654321};
  scene.time.duration = 1.0;
  return scene;
}

std::vector<int> right_nodes(const Scene& scene) {
  return nodes_of(scene.mesh.edge_groups.at("right"));
}

Scene ramped(Mass mass) {
  Scene scene = off_grid_beam(mass);
  scene.tractions[0].keys = {{0.2, {0, 0}}, {0.4567, {10, -3}}, {0.7, {-5, 2}}};
  return scene;
}

Scene moved(Mass mass, Profile profile) {
  Scene scene = off_grid_beam(mass);
  scene.tractions.clear();
  scene.moves.push_back(
      {right_nodes(scene),
       Axis::both,
       {0.05, 0.6180339},
       {{0.0, {0, 0}, {0, 0}}, {0.3217, {0.1, 0.02}, {0.3, -0.1}}, {0.55, {0.05, 0}, {0, 0}}},
       profile,
       "grip"});
  return scene;
}

Scene baumgarte(Scene scene) {
  scene.time.constraints = ConstraintMethod::baumgarte;
  return scene;
}

Scene tied(Mass mass) {  // the two right corners move alike in x: one general constraint
  Scene scene = off_grid_beam(mass);
  scene.constraints.push_back({{{5, Axis::x, 1.0}, {2, Axis::x, -1.0}}, 0.0, "tie"});
  return scene;
}

Scene pulled_together(Mass mass) {  // begins violated: Baumgarte's own dynamics is part of the solution
  Scene scene = tied(mass);
  scene.constraints[0].value = 0.02;
  return scene;
}

Scene roller(Mass mass) {  // different free sets in x and y, a roller that lets go
  Scene scene = off_grid_beam(mass);
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("bottom")), Axis::y, {0.0, 0.54321}, "bottom"});
  return scene;
}

Scene caught(Mass mass) {  // a fix that begins while its nodes move: an impulse
  Scene scene = off_grid_beam(mass);
  scene.fixes.push_back({right_nodes(scene), Axis::both, {0.4321, 0.8}, "catch"});
  return scene;
}

std::vector<OrderCase> cases() {
  std::vector<OrderCase> all;
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    const std::string m = mass == Mass::lumped ? "Lumped" : "Consistent";
    all.push_back({m + "Pull", [=] { return off_grid_beam(mass); }});
    all.push_back({m + "Ramp", [=] { return ramped(mass); }});
    all.push_back({m + "Roller", [=] { return roller(mass); }});
    all.push_back({m + "Caught", [=] { return caught(mass); }});
    all.push_back({m + "MoveSmooth", [=] { return moved(mass, Profile::smooth); }});
    all.push_back({m + "MoveLinear", [=] { return moved(mass, Profile::linear); }});
    all.push_back({m + "MoveHermite", [=] { return moved(mass, Profile::hermite); }});
    all.push_back({m + "General", [=] { return tied(mass); }});
    all.push_back({m + "GeneralViolated", [=] { return pulled_together(mass); }});
    all.push_back({m + "BaumgartePull", [=] { return baumgarte(off_grid_beam(mass)); }});
    all.push_back({m + "BaumgarteMove", [=] { return baumgarte(moved(mass, Profile::smooth)); }});
  }
  return all;
}

class Order : public testing::TestWithParam<OrderCase> {};

// Least-squares slope of log2(error) over log2(step).
double slope(const std::vector<double>& errors) {
  const auto n = static_cast<double>(errors.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double x = -static_cast<double>(i);
    const double y = std::log2(errors[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

double measured_order(const Scene& scene, IntegratorKind kind, double first_step) {
  const std::vector<double> times{0.25, 0.5, 0.75, 1.0};
  const auto exact = ExactSolution(scene).at(times);
  std::vector<double> errors;
  for (int halving = 0; halving <= 5; ++halving) {
    Scene s = scene;
    s.time.integrator = kind;
    s.time.step = first_step / std::exp2(halving);
    errors.push_back(run_error(exact, simulate(s, times)));
  }
  std::string all;
  for (double error : errors) all += std::to_string(std::log10(error)) + " ";
  testing::Test::RecordProperty("log10_errors", all);
  return slope(errors);
}

// Steps from far enough below the stable limit that the leading term rules, to where rounding is still far
// below it.
TEST_P(Order, Rk4IsFour) {
  EXPECT_NEAR(measured_order(GetParam().scene(), IntegratorKind::rk4, 4e-3), 4.0, 0.1);
}

TEST_P(Order, EulerIsOne) {
  EXPECT_NEAR(measured_order(GetParam().scene(), IntegratorKind::euler, 2e-4), 1.0, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Order, testing::ValuesIn(cases()),
                         [](const auto& c) { return c.param.name; });

}  // namespace
}  // namespace rheo::test
