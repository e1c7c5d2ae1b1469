// The implicit integrator on whole scenes: against the exact solution at fine steps, and where stiffness
// makes every explicit step tiny.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "rheo/error.hpp"
#include "rheo/simulation.hpp"
#include "shifted_system.hpp"
#include "support/event_scenes.hpp"
#include "support/exact.hpp"
#include "support/sanitized.hpp"
#include "support/slivers.hpp"

namespace rheo::test {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

Scene implicit(Scene scene, double step) {
  scene.time.integrator = IntegratorKind::implicit;
  scene.time.step = step;
  return scene;
}

Scene in_free_flight(Mass mass) {
  Scene scene = off_grid_beam(mass);
  scene.fixes.clear();
  scene.body_acceleration = {0.5, -9.81};
  return scene;
}

struct FineCase {
  std::string name;
  std::function<Scene()> scene;
  friend void PrintTo(const FineCase& c, std::ostream* out) { *out << c.name; }
};

std::vector<FineCase> fine_cases() {
  std::vector<FineCase> all;
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
    add("MoveHermite", [=] { return moved(mass, Profile::hermite); });
    add("General", [=] { return tied(mass); });
    add("GeneralViolated", [=] { return pulled_together(mass); });
    add("BaumgarteMove", [=] { return baumgarte(moved(mass, Profile::smooth)); });
    add("FreeFlight", [=] { return in_free_flight(mass); });
    add("Elastic", [=] { return with_material(roller(mass), 7, 5, inf, inf); });
    add("OneRelaxes", [=] { return with_material(moved(mass, Profile::smooth), 7, 5, inf, 2); });
    add("NoLambda", [=] { return with_material(caught(mass), 0, 5, 4, 2); });
    add("NoMu", [=] { return with_material(off_grid_beam(mass), 7, 0, 4, 2); });
    add("NoStiffness", [=] { return with_material(in_free_flight(mass), 0, 0, 4, 2); });
    add("RelaxesFast", [=] { return with_material(ramped(mass), 7, 5, 0.01, 0.02); });
  }
  return all;
}

class ImplicitScene : public testing::TestWithParam<FineCase> {};

TEST_P(ImplicitScene, AtFineStepsIsExactToRounding) {
  const std::vector<double> times{0.02, 0.25, 0.5, 0.75, 1.0};
  const Scene scene = GetParam().scene();
  const double error = run_error(ExactSolution(scene).at(times), simulate(implicit(scene, 1e-3), times));
  // Twelve digits of both, the exact solution's own rounding included (squared matrices).
  EXPECT_LE(error, 3e-12);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ImplicitScene, testing::ValuesIn(fine_cases()),
                         [](const auto& c) { return c.param.name; });

TEST(Implicit, ShortestStepsLoseNothing) {
  // From the first instants on, steps of 1e-9 of a vibration: increments are small against nothing but
  // themselves.
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    Scene scene = off_grid_beam(mass);
    scene.tractions[0].window = {};
    scene.time.duration = 1e-6;
    const std::vector<double> times{1e-8, 1e-7, 1e-6};
    EXPECT_LE(run_error(ExactSolution(scene).at(times), simulate(implicit(scene, 1e-9), times)), 1e-11);
  }
}

TEST(Implicit, ResolvesSlivers) {
  // A hundredth of a degree: frequencies of 2,000 /s and more beside those of 26 /s. The exact solution
  // itself has ten digits there.
  const std::vector<double> times{0.5};
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    Scene scene = with_slivers(off_grid_beam(mass), 0.01);
    scene.time.duration = 0.5;
    EXPECT_LE(run_error(ExactSolution(scene).at(times), simulate(implicit(scene, 1e-4), times)), 5e-10);
  }
}

TEST(Implicit, PassesOverSliversThatItDoesNotResolve) {
  // Steps of 70 times RK4's limit and more. What is left of the error is the ringing of the slivers, which
  // the sudden pull excites to a thousandth of the whole.
  const std::vector<double> times{0.5, 1.0};
  for (double degrees : {0.1, 0.01}) {
    const Scene scene = with_slivers(off_grid_beam(Mass::lumped), degrees);
    const auto exact = ExactSolution(scene).at(times);
    Simulation simulation(implicit(scene, 0.1));
    EXPECT_GT(0.1, 20 * stable_step(simulation.spectrum(), IntegratorKind::rk4));
    EXPECT_LE(run_error(exact, simulate(implicit(scene, 0.1), times)), 1e-2) << degrees;
  }
}

// M v' = f - (lambda_vis J_lambda + mu_vis J_mu) v from rest on the degrees of freedom that are free, by
// modes: v = sum of phi (1 - exp(-k t)) / k phi^T f.
ExactState viscous_beam(const Scene& scene, double since) {
  const DenseMatrices m = dense_matrices(scene.mesh, scene.material);
  std::vector<Eigen::Index> free;
  for (int node = 0; node < scene.mesh.node_count(); ++node) {
    const auto& held = scene.fixes[0].nodes;
    if (std::find(held.begin(), held.end(), node) != held.end()) continue;
    free.insert(free.end(), {2 * node, 2 * node + 1});
  }
  Eigen::VectorXd force = Eigen::VectorXd::Zero(m.mass.rows());
  for (int node : right_nodes(scene)) force[2 * node] = 0.5 * 10.0;  // an edge of 1 m, 10 Pa
  const Eigen::MatrixXd damping = scene.material.lambda_vis * m.j_lambda + scene.material.mu_vis * m.j_mu;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(damping(free, free),
                                                                        m.mass(free, free));
  Eigen::VectorXd speed(modes.eigenvalues().size()), way(modes.eigenvalues().size());
  for (Eigen::Index i = 0; i < speed.size(); ++i) {
    const double k = modes.eigenvalues()[i];
    speed[i] = -std::expm1(-k * since) / k;
    way[i] = (since - speed[i]) / k;
  }
  const Eigen::MatrixXd& phi = modes.eigenvectors();
  const Eigen::VectorXd pull = phi.transpose() * force(free);
  ExactState state;
  state.u = state.v = Eigen::VectorXd::Zero(force.size());
  state.u(free) = phi * way.cwiseProduct(pull);
  state.v(free) = phi * speed.cwiseProduct(pull);
  state.w_lambda = scene.material.lambda_vis * state.v;
  state.w_mu = scene.material.mu_vis * state.v;
  return state;
}

TEST(Implicit, InstantRelaxationIsViscosity) {
  // At rates of 1e9 /s and 1e12 /s, w = vis v but for terms of v' / rate, v' / v being some 1e2 /s.
  const std::vector<double> times{0.25, 0.5, 0.75};
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    for (double rate : {1e9, 1e12}) {
      const Scene scene = with_material(off_grid_beam(mass), 0.7 * rate, 0.5 * rate, 0.7, 0.5);
      std::vector<ExactState> exact;
      for (double t : times) {
        exact.push_back(viscous_beam(scene, t - 0.1234567));
        exact.back().t = t;
      }
      // Longer steps are inexact as for any viscous body, but no stiffness is felt.
      EXPECT_LE(run_error(exact, simulate(implicit(scene, 0.1), times)), 1e-3) << rate;
      EXPECT_LE(run_error(exact, simulate(implicit(scene, 1e-3), times)), 1e-10 + 1e3 / rate) << rate;
    }
  }
}

TEST(Implicit, AHardConstraintCostsNoDigits) {
  // A motion that is held identically does not see omega: with 1e6 /s it is that of elimination.
  const std::vector<double> times{0.25, 0.5, 0.75, 1.0};
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    const Scene eliminated = implicit(moved(mass, Profile::smooth), 1e-2);
    Scene held = baumgarte(eliminated);
    held.time.baumgarte = 1e6;
    EXPECT_LE(run_error(simulate(eliminated, times), simulate(held, times)), 1e-9);
  }
}

TEST(Implicit, HasNoStableLimitAndStepsFromEventToEvent) {
  const Scene scene = implicit(off_grid_beam(Mass::lumped), 0.0);
  Simulation simulation(scene);
  EXPECT_EQ(simulation.stable_step(), inf);
  EXPECT_EQ(simulation.step_bound(), inf);
  EXPECT_EQ(simulation.planned_steps(), 62);  // 60 outputs and 2 events between them
  EXPECT_EQ(simulation.kernel(), "csr");
}

TEST(Implicit, FactorsOnceAStepSize) {
  // Outputs at 60 Hz, two events off their grid: the usual step, two shorter ones around either event.
  const Scene scene = implicit(off_grid_beam(Mass::lumped), 0.0);
  Simulation simulation(scene);
  for (std::int64_t k = 1; k < output_count(scene.time); ++k)
    ASSERT_FALSE(simulation.advance(output_time(scene.time, k)));
  const Counters& counters = simulation.counters();
  EXPECT_EQ(counters.steps + counters.steps_at_rest, 62);
  EXPECT_LE(counters.factors, 5);
  EXPECT_EQ(counters.shifted_solves, 8 * counters.steps);
}

TEST(Implicit, DampsWhatItDoesNotResolve) {
  // An elastic body of 26,000 /s under its sudden weight, in steps of 0.1 s: it sags and, no motion being
  // resolved, comes to rest instead of ringing for ever.
  Scene scene = implicit(with_material(off_grid_beam(Mass::lumped), 7e6, 5e6, inf, inf), 0.1);
  scene.tractions.clear();
  scene.body_acceleration = {0.0, -9.81};
  scene.time.duration = 50.0;
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(50.0));
  const Energies energies = simulation.energies();
  EXPECT_LE(energies.kinetic, 1e-20 * energies.stored);
  // At rest the load has done twice the work that is stored.
  EXPECT_NEAR(energies.work, 2.0 * energies.stored, 1e-9 * energies.stored);
}

TEST(Implicit, LeavesOutEnergiesThatAQuadratureOverItsLongStepsWouldGetWrong) {
  Simulation pulled(implicit(off_grid_beam(Mass::lumped), 0.0));
  ASSERT_FALSE(pulled.advance(0.5));
  EXPECT_TRUE(std::isnan(pulled.energies().dissipated));
  EXPECT_GT(pulled.energies().work, 0.0);
  Simulation held(implicit(moved(Mass::lumped, Profile::smooth), 0.0));
  ASSERT_FALSE(held.advance(0.5));
  EXPECT_TRUE(std::isnan(held.energies().work));
}

TEST(Implicit, AFallingBodyFallsWhateverItsStiffness) {
  // Nothing deforms, so v = g t at every node; residual forces of the fall are up to 1e10 times the weight.
  // What rounding leaves of that grows with (omega h)^2, and stays within what the factor is held to.
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    for (const auto& [stiffness, tolerance] : {std::pair{1e4, 1e-11}, {1e6, 1e-9}, {1e10, 1e-6}}) {
      Scene scene =
          with_material(in_free_flight(mass), 7 * stiffness, 5 * stiffness, 4 * stiffness, 2 * stiffness);
      scene.mesh = rectangle({2.0, 1.0}, is_sanitized ? 11 : 21, is_sanitized ? 6 : 11);
      scene.tractions.clear();
      scene.time.duration = 10.0;
      Simulation simulation(implicit(scene, 1.0 / 60));
      ASSERT_FALSE(simulation.advance(10.0)) << stiffness;
      for (int node = 0; node < scene.mesh.node_count(); ++node) {
        EXPECT_NEAR(simulation.v()[2 * node], 5.0, 98.1 * tolerance) << stiffness;
        EXPECT_NEAR(simulation.v()[2 * node + 1], -98.1, 98.1 * tolerance) << stiffness;
      }
    }
  }
}

TEST(Implicit, StopsWhereItsFactorHasNoDigitsLeft) {
  // Volume held a million million times as stiffly as shape: the shape is lost in the rounding of the volume.
  Scene scene = implicit(with_material(off_grid_beam(Mass::lumped), 7e15, 5, 4e15, 2), 1.0);
  Simulation simulation(scene);
  const auto diverged = simulation.advance(1.0);
  ASSERT_TRUE(diverged.has_value());
  EXPECT_EQ(simulation.counters().steps, 0);
  for (double x : simulation.u()) EXPECT_TRUE(std::isfinite(x));
}

TEST(Implicit, RefusesMoreGeneralConstraintsThanTheirFactorMayTake) {
  Scene scene;
  scene.constraints.resize(11'000);
  EXPECT_NO_THROW(require_few_general_constraints(scene));
  scene.constraints.resize(20'000);
  try {
    require_few_general_constraints(scene);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_NE(std::string(error.what()).find("20000 general constraints"), std::string::npos) << error.what();
  }
}

TEST(Implicit, RefusesTheEdgeKernelInOneLine) {
  try {
    Simulation simulation(implicit(off_grid_beam(Mass::lumped), 0.0), {.kernel = Kernel::edge});
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    EXPECT_NE(std::string(error.what()).find("use auto or csr"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace rheo::test
