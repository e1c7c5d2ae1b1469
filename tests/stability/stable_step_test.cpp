// The predicted stable step against the true one, from the eigenvalues of the full operator.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>

#include "rheo/error.hpp"
#include "rheo/simulation.hpp"
#include "rheo/stability.hpp"
#include "stability/runs/true_limit.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

double predicted(const Scene& scene, IntegratorKind integrator) {
  Scene s = scene;
  s.time.step = 1e-12;  // never run
  s.time.duration = 1e-11;
  s.time.integrator = integrator;
  return stable_step(Simulation(s, {.allow_unstable = true}).spectrum(), integrator);
}

TEST(StableStep, IsExactForKnownEigenvalues) {
  // On the negative real axis RK4 ends at 2.785293563405282, on the imaginary one at sqrt(8), Euler at 2 and
  // 0.
  EXPECT_NEAR(stable_step_of({-1.0, 0.0}, IntegratorKind::rk4), 2.785293563405282, 1e-9);
  EXPECT_NEAR(stable_step_of({0.0, 4.0}, IntegratorKind::rk4), std::sqrt(8.0) / 4, 1e-12);
  EXPECT_DOUBLE_EQ(stable_step_of({-4.0, 0.0}, IntegratorKind::euler), 0.5);
  EXPECT_DOUBLE_EQ(stable_step_of({0.0, 4.0}, IntegratorKind::euler), 0.0);
  EXPECT_DOUBLE_EQ(stable_step_of({-1.0, 1.0}, IntegratorKind::euler), 1.0);  // 2 |Re| / |s|^2
  EXPECT_EQ(stable_step_of({0.0, 0.0}, IntegratorKind::rk4), infinite);
  EXPECT_EQ(stable_step_of({1e-3, 0.0}, IntegratorKind::rk4), 0.0);
}

// What is stable with a step is so with every shorter one: the limit need not be searched for where a step
// is.
TEST(StableStep, Rk4RegionIsWholeAlongEveryRayOfTheLeftHalfPlane) {
  constexpr int rays = 1000;
  for (int i = 1; i <= rays; ++i) {
    const std::complex<double> d = std::polar(1.0, M_PI / 2 * (1.0 + static_cast<double>(i) / rays));
    const double limit = stable_step_of(d, IntegratorKind::rk4);
    for (double h = 0.02; h < 4.0; h += 0.02) {
      if (std::abs(h - limit) < 1e-6) continue;
      const std::complex<double> z = h * d;
      const double size = std::abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0))));
      ASSERT_EQ(size <= 1.0, h < limit) << "ray " << i << ", " << h << " of " << limit;
    }
  }
}

TEST(StableStep, Rk4RegionIsNarrowestBetweenTheAxes) {
  double narrowest = infinite;
  for (double angle = 90.1; angle <= 180; angle += 0.1) {
    narrowest = std::min(narrowest, stable_step_of(std::polar(1.0, angle * M_PI / 180), IntegratorKind::rk4));
  }
  EXPECT_NEAR(narrowest, 2.616, 1e-3);
}

struct Family {
  std::string name;
  double lambda_relaxation, mu_relaxation;  // relaxation time times a typical frequency; infinite: elastic
  friend void PrintTo(const Family& f, std::ostream* out) { *out << f.name; }
};

Scene random_scene(std::mt19937& random, const Family& family) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto decades = [&](double lo, double hi) { return lo * std::pow(hi / lo, unit(random)); };
  Scene scene;
  const double size = decades(1e-4, 1e4);
  const int nx = 2 + static_cast<int>(unit(random) * 4);
  const int ny = 2 + static_cast<int>(unit(random) * 2);
  scene.mesh = rectangle({size, size * decades(0.2, 2)}, nx, ny,
                         unit(random) < 0.5 ? Diagonal::rising : Diagonal::alternating);
  scene.mesh.thickness = decades(1e-3, 10);
  const double jitter = 0.25 * unit(random) * size / nx;
  for (Vec2& p : scene.mesh.points) {
    p.x += jitter * (2 * unit(random) - 1);
    p.y += jitter * (2 * unit(random) - 1) * 0.5;
  }
  prepare(scene.mesh);
  Material& m = scene.material;
  m.density = decades(1e-3, 1e4);
  m.mu_ela = decades(1e-2, 1e7);
  m.lambda_ela = unit(random) < 0.1 ? 0.0 : m.mu_ela * decades(0.1, 30);
  m.mass = unit(random) < 0.5 ? Mass::lumped : Mass::consistent;
  const double frequency = std::sqrt((m.lambda_ela + 2 * m.mu_ela) / m.density) / size;
  if (m.lambda_ela > 0) m.lambda_vis = m.lambda_ela * family.lambda_relaxation / frequency;
  m.mu_vis = m.mu_ela * family.mu_relaxation / frequency;
  const double choice = unit(random);
  if (choice < 0.6)
    scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, "left"});
  if (choice < 0.3)
    scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("bottom")), Axis::y, {}, "bottom"});
  if (unit(random) < 0.3) {
    scene.constraints.push_back({{{nx - 1, Axis::x, 1.0}, {nx * ny - 1, Axis::x, -1.0}}, 0.0, "tie"});
    scene.time.baumgarte = frequency * decades(0.1, 100);
  }
  scene.time.duration = 1.0;
  return scene;
}

class Prediction : public testing::TestWithParam<Family> {};

TEST_P(Prediction, IsNeverAboveTheTruthAndNear) {
  std::mt19937 random(12345);
  for (int k = 0; k < 40; ++k) {
    const Scene scene = random_scene(random, GetParam());
    const TrueSpectrum true_spectrum(scene);
    for (IntegratorKind integrator : {IntegratorKind::rk4, IntegratorKind::euler}) {
      const TrueLimit truth = true_spectrum.limit(integrator);
      const double bound = predicted(scene, integrator);
      const std::string what =
          "scene " + std::to_string(k) + (integrator == IntegratorKind::rk4 ? " rk4" : " euler");
      // (Where nothing is damped rounding alone tells Euler's limit from 0.)
      const bool damped = std::isfinite(GetParam().mu_relaxation);
      if (damped || integrator == IntegratorKind::rk4) {
        EXPECT_TRUE(truth.determined()) << what;
      }
      EXPECT_LE(bound, truth.high * (1 + 1e-9)) << what;
      EXPECT_GE(bound, 0.95 * truth.low) << what;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Families, Prediction,
                         testing::Values(Family{"Slow", 10, 20}, Family{"Elastic", infinite, infinite},
                                         Family{"HalfElastic", infinite, 5}, Family{"Alike", 0.3, 0.3},
                                         Family{"Fast", 1e-3, 2e-3}, Family{"VeryFast", 1e-6, 1e-6},
                                         Family{"LambdaFast", 1e-2, 10}, Family{"MuFast", 10, 1e-2}),
                         [](const auto& c) { return c.param.name; });

TEST(StableStep, UndampedBodyHasNoStableEulerStep) {
  Scene scene = paper_beam(Mass::lumped);
  scene.material.lambda_vis = scene.material.mu_vis = infinite;
  scene.time.integrator = IntegratorKind::euler;
  scene.time.step = 0.0;
  try {
    Simulation simulation(scene);
    FAIL() << "accepted";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("not damped"), std::string::npos) << e.what();
  }
}

// As many constraints as ways to move: nothing is left that could have eigenvalues, but for what relaxes.
TEST(StableStep, ABodyThatConstraintsHoldWhollyHasTheStepsOfItsRates) {
  Scene scene = paper_beam(Mass::lumped);
  scene.fixes.clear();
  for (int node = 0; node < scene.mesh.node_count(); ++node)
    for (const Axis axis : {Axis::x, Axis::y})
      scene.constraints.push_back({{{node, axis, 1.0}}, 0.0, "grip"});
  scene.time.baumgarte = 0.0;
  const double rate = std::max(scene.material.lambda_rate(), scene.material.mu_rate());
  for (const IntegratorKind kind : {IntegratorKind::rk4, IntegratorKind::euler}) {
    const double step = predicted(scene, kind), truth = stable_step_of(-rate, kind);
    EXPECT_LE(step, truth);
    EXPECT_GE(step, 0.95 * truth);
  }
}

// Too large for all eigenvalues: by those that it hangs on it is the limit, else a bound that is called so.
TEST(StableStep, EulersLimitOnALargerMeshIsKnownOrCalledASafeBound) {
  Scene scene = paper_beam(Mass::lumped);
  scene.mesh = rectangle({1.0, 0.25}, 14, 5);
  scene.fixes[0].nodes = nodes_of(scene.mesh.edge_groups.at("left"));
  scene.tractions[0].edges = scene.mesh.edge_groups.at("right");
  scene.probes.clear();
  scene.time.integrator = IntegratorKind::euler;
  scene.time.step = 1.0;
  const double truth = true_limit(scene, IntegratorKind::euler).low;
  struct Case {
    Nearness nearness;
    double least;  // of the truth: the branches relax at rates 1.4 apart
    const char* text;
  };
  for (const Case& c : {Case{Nearness::near, 0.95, "the largest stable step of euler"},
                        Case{Nearness::range, 0.9, "step that is surely stable"},
                        Case{Nearness::safe, 0.3, "step that is surely stable"}}) {
    const Simulation simulation(scene, {.allow_unstable = true, .nearness = c.nearness});
    EXPECT_EQ(stable_step_is_bound(simulation.spectrum(), IntegratorKind::euler),
              c.nearness != Nearness::near);
    EXPECT_FALSE(stable_step_is_bound(simulation.spectrum(), IntegratorKind::rk4));
    EXPECT_LE(simulation.stable_step(), truth);
    EXPECT_GE(simulation.stable_step(), c.least * truth);
    try {
      Simulation refused(scene, {.nearness = c.nearness});
      FAIL() << "accepted";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(c.text), std::string::npos) << e.what();
    }
  }
}

TEST(StableStep, BeyondTheLimitIsRefusedByName) {
  Scene scene = paper_beam(Mass::lumped);
  scene.time.step = 0.1;
  scene.time.where = "beam.toml:31: [time]";
  try {
    Simulation simulation(scene);
    FAIL() << "accepted";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::input);
    EXPECT_EQ(std::string(e.what()).find("beam.toml:31: [time] step"), 0u) << e.what();
    EXPECT_NE(std::string(e.what()).find("step = 0.1 s: beyond the largest stable step of rk4"),
              std::string::npos)
        << e.what();
  }
  EXPECT_NO_THROW(Simulation(scene, {.allow_unstable = true}));
}

TEST(StableStep, AutoIsAQuarterOfTheLimitAndDividesEveryInterval) {
  Scene scene = paper_beam(Mass::consistent);
  scene.tractions[0].window = {0.1234, 0.5};
  scene.time.duration = 1.0;
  Simulation simulation(scene);
  EXPECT_DOUBLE_EQ(simulation.step_bound(), simulation.stable_step() / 4);
  for (std::int64_t k = 0; k < output_count(scene.time); ++k) {
    ASSERT_FALSE(simulation.advance(output_time(scene.time, k)));
    EXPECT_EQ(simulation.time(), output_time(scene.time, k));
  }
  EXPECT_EQ(simulation.counters().steps + simulation.counters().steps_at_rest, simulation.planned_steps());
}

// At 0.99 of the limit nothing grows; at 1.05 a disturbance does, and the run says so instead of going on.
TEST(StableStep, DividesStableFromDiverging) {
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    Scene scene = paper_beam(mass);
    scene.time.frame_rate = 1e-3;  // steps as long as asked for
    scene.time.duration = 1000.0;
    const double truth = true_limit(scene, IntegratorKind::rk4).high;
    scene.time.step = 0.99 * predicted(scene, IntegratorKind::rk4);
    Simulation stable(scene);
    EXPECT_FALSE(stable.advance(100.0));
    scene.time.step = 1.05 * truth;
    EXPECT_THROW(Simulation{scene}, Error);
    Simulation unstable(scene, {.allow_unstable = true});
    const auto found = unstable.advance(1000.0);
    ASSERT_TRUE(found);
    EXPECT_LT(found->t, 100.0);
    EXPECT_GT(found->energy, found->allowed);
    EXPECT_GE(found->node, 0);
    EXPECT_TRUE(std::isfinite(found->energy));
    EXPECT_NEAR(found->stable_step, truth, 0.05 * truth);
  }
}

TEST(StableStep, BaumgarteBeyondItsLimitIsPredictedAndNoticed) {
  Scene scene = paper_beam(Mass::lumped);
  scene.time.constraints = ConstraintMethod::baumgarte;
  // Violated at first: what is fulfilled exactly does not show the pole.
  scene.constraints.push_back({{{9, Axis::x, 1.0}}, 0.01, "pull"});
  scene.time.frame_rate = 1e-3;
  scene.time.duration = 1000.0;
  scene.time.baumgarte = 1000.0;
  scene.time.step = 0.01;  // 0.01 * 1000 is far beyond 2.785
  EXPECT_THROW(Simulation{scene}, Error);
  Simulation unstable(scene, {.allow_unstable = true});
  const auto found = unstable.advance(10.0);
  ASSERT_TRUE(found);
  EXPECT_LT(found->t, 1.0);
  scene.constraints.clear();
  scene.time.step = 2.7e-3;
  EXPECT_FALSE(Simulation(scene).advance(5.0));
}

}  // namespace
}  // namespace rheo::test
