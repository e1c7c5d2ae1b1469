// Convergence order of the integrators on whole scenes against the exact solution: both masses, every kind of
// constraint, events off the step grid.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "rheo/simulation.hpp"
#include "support/event_scenes.hpp"
#include "support/exact.hpp"
#include "support/sanitized.hpp"

namespace rheo::test {
namespace {

struct OrderCase {
  std::string name;
  std::function<Scene()> scene;
  friend void PrintTo(const OrderCase& c, std::ostream* out) { *out << c.name; }
};

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

// The element kernel's states; the others' by simulate().
std::vector<ExactState> simulate_by_elements(const Scene& scene, const std::vector<double>& times) {
  Simulation run(scene, {.kernel = Kernel::element});
  const auto copy = [](std::span<const double> x) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  std::vector<ExactState> states;
  for (const double t : times) {
    EXPECT_FALSE(run.advance(t));
    states.push_back({t, copy(run.u()), copy(run.v()), copy(run.w_lambda()), copy(run.w_mu())});
  }
  return states;
}

double measured_order(const Scene& scene, IntegratorKind kind, double first_step, int halvings) {
  const std::vector<double> times{0.25, 0.5, 0.75, 1.0};
  const auto exact = ExactSolution(scene).at(times);
  std::vector<double> errors;
  for (int halving = 0; halving <= halvings; ++halving) {
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
  EXPECT_NEAR(measured_order(GetParam().scene(), IntegratorKind::rk4, 4e-3, 5), 4.0, 0.1);
}

TEST_P(Order, EulerIsOne) {
  EXPECT_NEAR(measured_order(GetParam().scene(), IntegratorKind::euler, 2e-4, is_sanitized ? 3 : 5), 1.0,
              0.1);
}

TEST(ElementKernel, HasRk4sOrderFour) {
  const std::vector<double> times{0.25, 0.5, 0.75, 1.0};
  for (const Scene& scene : {ramped(Mass::lumped), moved(Mass::lumped, Profile::smooth)}) {
    const auto exact = ExactSolution(scene).at(times);
    std::vector<double> errors;
    for (int halving = 0; halving <= 5; ++halving) {
      Scene s = scene;
      s.time.step = 4e-3 / std::exp2(halving);
      errors.push_back(run_error(exact, simulate_by_elements(s, times)));
    }
    EXPECT_NEAR(slope(errors), 4.0, 0.1);
  }
}

// One halving only: eight orders leave little room between steps that are too long for the leading term to
// rule, as modes of several frequencies make it, and rounding, some 1e-14. The order itself is held to 0.1 in
// tests/unit.
TEST_P(Order, ImplicitIsEight) {
  const Scene scene = GetParam().scene();
  const double step = scene.material.mass == Mass::lumped ? 1e-2 : 5e-3;
  EXPECT_NEAR(measured_order(scene, IntegratorKind::implicit, step, 1), 8.0, 0.6);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Order, testing::ValuesIn(cases()),
                         [](const auto& c) { return c.param.name; });

}  // namespace
}  // namespace rheo::test
