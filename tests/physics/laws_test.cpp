// Laws that hold whatever the numbers: patch test, rigid motion, momentum, closed forms of relaxation and
// creep, convergence in space, reactions.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "model.hpp"
#include "rheo/deformation.hpp"
#include "rheo/simulation.hpp"
#include "support/exact.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

Mesh jittered(Vec2 size, int nx, int ny, unsigned seed) {
  Mesh mesh = rectangle(size, nx, ny, Diagonal::alternating);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int row = 1; row + 1 < ny; ++row) {
    for (int column = 1; column + 1 < nx; ++column) {
      mesh.points[row * nx + column].x += 0.25 * size.x / (nx - 1) * unit(random);
      mesh.points[row * nx + column].y += 0.25 * size.y / (ny - 1) * unit(random);
    }
  }
  prepare(mesh);
  return mesh;
}

TEST(ConnectionMatrices, AreThoseOfTheTextbook) {
  const Mesh mesh = [] {
    Mesh m = jittered({3.0, 2.0}, 5, 4, 1);
    m.thickness = 0.37;
    return m;
  }();
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    const Material material{7, 5, 4, 2, 0.2, mass};
    const Model model(mesh, material);
    const DenseMatrices dense = dense_matrices(mesh, material);
    // Two ways to the same few products: a few roundings of the largest entry.
    EXPECT_LT((Eigen::MatrixXd(model.j(Modulus::lambda)) - dense.j_lambda).norm(),
              1e-14 * dense.j_lambda.norm());
    EXPECT_LT((Eigen::MatrixXd(model.j(Modulus::mu)) - dense.j_mu).norm(), 1e-14 * dense.j_mu.norm());
    Eigen::MatrixXd m(2 * mesh.node_count(), 2 * mesh.node_count());
    for (Eigen::Index k = 0; k < m.cols(); ++k) {
      const Vector unit = Vector::Unit(m.cols(), k);
      model.multiply_mass(unit.data(), m.col(k).data());
    }
    EXPECT_LT((m - dense.mass).norm(), 1e-14 * dense.mass.norm());
  }
}

TEST(ConnectionMatrices, RigidMotionGivesNoForce) {
  const Mesh mesh = jittered({3.0, 2.0}, 6, 5, 2);
  const Model model(mesh, {7, 5, 4, 2, 0.2, Mass::lumped});
  for (int kind = 0; kind < 3; ++kind) {
    Vector w(2 * mesh.node_count());
    for (int i = 0; i < mesh.node_count(); ++i) {
      const Vec2& p = mesh.points[i];
      w.segment<2>(2 * i) << (kind == 0   ? 1.0
                              : kind == 1 ? 0.0
                                          : -p.y),
          (kind == 0   ? 0.0
           : kind == 1 ? 1.0
                       : p.x);
    }
    EXPECT_LT((model.j(Modulus::lambda) * w).norm(), 1e-14 * model.j(Modulus::lambda).norm() * w.norm());
    EXPECT_LT((model.j(Modulus::mu) * w).norm(), 1e-14 * model.j(Modulus::mu).norm() * w.norm());
  }
}

TEST(ConnectionMatrices, ScaleWithThicknessAndNotWithSize) {
  const Mesh mesh = jittered({3.0, 2.0}, 4, 4, 3);
  Mesh large = mesh;
  for (Vec2& p : large.points) p = {p.x * 1e8, p.y * 1e8};
  large.thickness = 0.5;
  const Material material{7, 5, 4, 2, 0.2, Mass::lumped};
  const Model a(mesh, material), b(large, material);
  // The 2-D stiffness of similar triangles is the same; thickness is a factor.
  EXPECT_LT((0.5 * a.j(Modulus::mu) - b.j(Modulus::mu)).norm(), 1e-13 * b.j(Modulus::mu).norm());
  EXPECT_LT((0.5 * a.j(Modulus::lambda) - b.j(Modulus::lambda)).norm(), 1e-13 * b.j(Modulus::lambda).norm());
}

// The patch test: a linear displacement prescribed on the boundary of an irregular patch is taken up by all
// of it, with one stress everywhere.
TEST(PatchTest, LinearDisplacementGivesOneStress) {
  Scene scene;
  scene.mesh = jittered({2.0, 1.5}, 6, 5, 4);
  scene.material = {7,   5,   4e9,
                    2e9, 0.2, Mass::consistent};  // relaxation times of 1e9 s: elastic over this run
  const double duration = 200.0;
  for (int node : nodes_of(scene.mesh.edge_groups.at("boundary"))) {
    const Vec2 p = scene.mesh.points[node];
    const Vec2 u{0.01 * p.x + 0.02 * p.y, -0.005 * p.x + 0.015 * p.y};
    scene.moves.push_back(
        {{node}, Axis::both, {}, {{0, {0, 0}, {}}, {duration, u, {}}}, Profile::smooth, ""});
  }
  scene.time.duration = duration;
  scene.time.frame_rate = 1.0;
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(duration));
  // The motion is slow (200 s against periods below 1 s): quasi-static to (omega T)^-2.
  const double tolerance = 1e-5;
  for (int i = 0; i < scene.mesh.node_count(); ++i) {
    const Vec2 p = scene.mesh.points[i];
    EXPECT_NEAR(simulation.u()[2 * i], 0.01 * p.x + 0.02 * p.y, 0.02 * tolerance);
    EXPECT_NEAR(simulation.u()[2 * i + 1], -0.005 * p.x + 0.015 * p.y, 0.02 * tolerance);
  }
  std::vector<double> sigma(3 * scene.mesh.triangles.size());
  stress(scene.mesh, simulation.w_lambda(), simulation.w_mu(), sigma);
  const double trace = 0.01 + 0.015;
  const std::array<double, 3> expected{7 * trace + 10 * 0.01, 7 * trace + 10 * 0.015, 5 * (0.02 - 0.005)};
  for (std::size_t e = 0; e < scene.mesh.triangles.size(); ++e) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(sigma[3 * e + k], expected[k], tolerance) << "triangle " << e;
  }
}

TEST(FreeBody, MomentumFollowsTheForceAndTheCentreFalls) {
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    Scene scene = paper_beam(mass);
    scene.fixes.clear();
    scene.body_acceleration = {0.0, -9.81};
    scene.time.duration = 2.0;
    Simulation simulation(scene);
    const Model model(scene.mesh, scene.material);
    for (double t : {0.5, 1.0, 2.0}) {
      ASSERT_FALSE(simulation.advance(t));
      Vector p(2 * scene.mesh.node_count());
      model.multiply_mass(simulation.v().data(), p.data());
      double px = 0.0, py = 0.0, centre = 0.0;
      for (int i = 0; i < scene.mesh.node_count(); ++i) {
        px += p[2 * i];
        py += p[2 * i + 1];
        centre += model.node_mass[i] * simulation.u()[2 * i + 1];
      }
      const double m = 0.2 * 0.25;
      // Polynomials of degree 1 and 2 in time, which RK4 follows exactly: rounding over about 1000 steps.
      EXPECT_NEAR(px, 2.5 * std::min(t, 1.0), 1e-12);
      EXPECT_NEAR(py, -9.81 * m * t, 1e-12);
      EXPECT_NEAR(centre / m, -0.5 * 9.81 * t * t, 1e-11);
    }
  }
}

// A block held by rollers on two sides and pulled in x: homogeneous strain, so the paper's law in closed
// form.
Scene uniaxial(double lambda_vis, double mu_vis) {
  Scene scene;
  scene.mesh = jittered({1.0, 1.0}, 3, 3, 5);
  scene.material = {7, 5, lambda_vis, mu_vis, 1e-3, Mass::lumped};  // light: vibrations die out at once
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::x, {}, "left"});
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("bottom")), Axis::y, {}, "bottom"});
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("top")), Axis::y, {}, "top"});
  scene.probes.push_back({"grip", nodes_of(scene.mesh.edge_groups.at("right")), {}, "grip"});
  return scene;
}

TEST(Relaxation, ConfinedForceIsTheHereditaryIntegral) {
  // Stretched (laterally confined) by a hermite ramp of constant rate r over T, then held: with e' = r on [0,
  // T], sigma_xx(t) = sum over lambda, 2 mu of r vis exp(-(t - T) ela / vis) (1 - exp(-T ela / vis)).
  Scene scene = uniaxial(4.0, 2.0);
  const double rate = 0.05, ramp = 1.0;
  scene.moves.push_back({nodes_of(scene.mesh.edge_groups.at("right")),
                         Axis::x,
                         {},
                         {{0, {0, 0}, {}}, {ramp, {rate * ramp, 0}, {}}},
                         Profile::linear,
                         "grip"});
  scene.time.duration = 3.0;
  Simulation simulation(scene);
  const auto law = [&](double t, double ela, double vis) {
    return rate * vis * std::exp(-(t - ramp) * ela / vis) * (1 - std::exp(-ramp * ela / vis));
  };
  for (double t : {1.5, 2.0, 3.0}) {
    ASSERT_FALSE(simulation.advance(t));
    const double expected = law(t, 7.0, 4.0) + 2 * law(t, 5.0, 2.0);
    // The jump of velocity leaves waves that the material damps with rate ~2/s: e^-2t of a small amplitude
    // (they carry the stress rho c v ~ 7e-3 of 0.26), so only their mean is compared, over a period far below
    // t.
    double mean = 0.0;
    const int samples = 400;
    const double period =
        4.0 / std::sqrt(17.0 / 1e-3);  // quarter-wave of a bar of 1 m held at one end, both pressed
    for (int k = 0; k < samples; ++k) {
      ASSERT_FALSE(simulation.advance(t + period * (k + 1) / samples));
      mean += simulation.read(scene.probes[0]).force.x / samples;
    }
    EXPECT_NEAR(mean, expected, 0.05 * expected) << t;
  }
}

TEST(Relaxation, StressAfterASlowStretchIsExact) {
  // Without inertia's waves: smooth stretch, then e^{-t ela/vis} for both parts. Ratios over time need no
  // history.
  Scene scene = uniaxial(70.0, forever);  // lambda relaxes in 10 s, mu never
  scene.moves.push_back({nodes_of(scene.mesh.edge_groups.at("right")),
                         Axis::x,
                         {},
                         {{0, {0, 0}, {}}, {2.0, {0.1, 0}, {}}},
                         Profile::smooth,
                         "grip"});
  scene.material.density = 1e-4;
  scene.time.duration = 12.0;
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(4.0));
  const double first = simulation.read(scene.probes[0]).force.x - 2 * 5 * 0.1;
  ASSERT_FALSE(simulation.advance(12.0));
  const double second = simulation.read(scene.probes[0]).force.x - 2 * 5 * 0.1;
  EXPECT_GT(first, 0.4);
  EXPECT_NEAR(second / first, std::exp(-8.0 / 10.0), 1e-6);
}

TEST(Creep, ConfinedStrainUnderConstantLoadIsAMaxwellBody) {
  // With lambda / lambda_vis = mu / mu_vis the confined block is one Maxwell element of modulus lambda + 2
  // mu: under a constant stress s its strain is s / E (1 + t / tau), once vibrations are gone.
  const double tau = 0.5;  // vibrations decay as exp(-t / (2 tau))
  Scene scene = uniaxial(7.0 * tau, 5.0 * tau);
  scene.material.density = 1e-3;
  scene.tractions.push_back(
      {scene.mesh.edge_groups.at("right"), {{0.0, {0, 0}}, {3.0, {0.34, 0}}}, {}, "pull"});
  scene.time.duration = 20.0;
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(16.0));
  const double a = simulation.read(scene.probes[0]).displacement.x;
  ASSERT_FALSE(simulation.advance(20.0));
  const double b = simulation.read(scene.probes[0]).displacement.x;
  const double rate = 0.34 / 17.0 / tau;
  EXPECT_NEAR((b - a) / 4.0, rate, 1e-5 * rate);
  // u = s/E + (integral of s) / (E tau); the ramp of 3 s counts half.
  EXPECT_NEAR(b, 0.34 / 17.0 * (1 + (20.0 - 1.5) / tau), 1e-5 * b);
}

// A confined elastic bar, its left end moved by a cubic pulse: the wave u(x, t) = g(t - x / c) until it meets
// the other end.
TEST(Bar, ConvergesWithOrderTwoInSpace) {
  const double length = 4.0, density = 17.0;  // lambda + 2 mu = 17 Pa: c = 1 m/s
  const double rise = 2.0;
  const auto pulse = [&](double t) {
    const double s = std::clamp(t / rise, 0.0, 1.0);
    return 0.01 * s * s * s * (10 - 15 * s + 6 * s * s);
  };
  for (Mass mass : {Mass::lumped, Mass::consistent}) {
    std::vector<double> errors;
    for (int cells : {32, 64, 128, 256}) {
      Scene scene;
      const double h = length / cells;
      scene.mesh = rectangle({length, 2 * h}, cells + 1, 3);
      scene.material = {7, 5, forever, forever, density, mass};
      std::vector<int> all(scene.mesh.points.size());
      std::iota(all.begin(), all.end(), 0);
      scene.fixes.push_back({all, Axis::y, {}, "confined"});
      scene.moves.push_back({nodes_of(scene.mesh.edge_groups.at("left")),
                             Axis::x,
                             {},
                             {{0, {0, 0}, {}}, {rise, {0.01, 0}, {}}},
                             Profile::smooth,
                             "pulse"});
      scene.time.duration = 3.0;
      Simulation simulation(scene);
      EXPECT_FALSE(simulation.advance(3.0));
      double sum = 0.0;
      for (int i = 0; i < scene.mesh.node_count(); ++i) {
        const double difference = simulation.u()[2 * i] - pulse(3.0 - scene.mesh.points[i].x);
        sum += difference * difference;
      }
      errors.push_back(std::sqrt(sum / scene.mesh.node_count()));
    }
    for (std::size_t k = 1; k + 1 < errors.size(); ++k) {
      EXPECT_NEAR(std::log2(errors[k] / errors[k + 1]), 2.0, 0.1) << errors[k] << " -> " << errors[k + 1];
    }
  }
}

TEST(Reaction, BalancesTheLoadAtRest) {
  Scene scene = paper_beam(Mass::consistent);
  scene.tractions[0].window = {};
  scene.tractions[0].keys = {{0.0, {0, 0}}, {1.0, {0.05, -0.02}}};
  scene.material.lambda_vis = 1e9, scene.material.mu_vis = 0.05;
  scene.material.lambda_ela = 0.7, scene.material.mu_ela = 5;
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(5.0));
  double x = 0.0, y = 0.0, ax = 0.0, ay = 0.0;
  const auto r = simulation.reaction();
  const Model model(scene.mesh, scene.material);
  for (int i = 0; i < scene.mesh.node_count(); ++i) x += r[2 * i], y += r[2 * i + 1];
  // Newton for the whole: reactions + loads = rate of the momentum, by a difference quotient.
  const auto momentum = [&](Simulation& s) {
    Vector p(2 * scene.mesh.node_count());
    model.multiply_mass(s.v().data(), p.data());
    Vec2 sum;
    for (Eigen::Index i = 0; i < p.size(); i += 2) sum.x += p[i], sum.y += p[i + 1];
    return sum;
  };
  const double dt = 1e-4;
  const Vec2 before = momentum(simulation);
  ASSERT_FALSE(simulation.advance(5.0 + dt));
  const Vec2 after = momentum(simulation);
  ax = (after.x - before.x) / dt;
  ay = (after.y - before.y) / dt;
  EXPECT_NEAR(x + 0.25 * 0.05, ax, 1e-6);
  EXPECT_NEAR(y - 0.25 * 0.02, ay, 1e-6);
}

TEST(Units, DoNotMatter) {
  // Metre-kilogram-second against millimetre-gram-millisecond: the same beam, the same answer.
  Scene si = paper_beam(Mass::lumped);
  Scene other = si;
  // 1 Pa = 1 kg/(m s^2) = 1e3 g / (1e3 mm 1e6 ms^2) = 1e-6 g/(mm ms^2); 1 kg/m^3 = 1e3 g / 1e9 mm^3
  for (Vec2& p : other.mesh.points) p = {p.x * 1e3, p.y * 1e3};
  other.mesh.thickness *= 1e3;
  Material& m = other.material;
  m.lambda_ela *= 1e-6, m.mu_ela *= 1e-6, m.lambda_vis *= 1e-3, m.mu_vis *= 1e-3, m.density *= 1e-6;
  other.tractions[0].keys[0].p.x *= 1e-6;
  other.tractions[0].window.until = 1e3;
  other.time.duration = 5e3;
  other.time.frame_rate = 60e-3;
  Simulation a(si), b(other);
  ASSERT_FALSE(a.advance(2.0));
  ASSERT_FALSE(b.advance(2e3));
  for (std::size_t i = 0; i < a.u().size(); ++i) EXPECT_NEAR(b.u()[i], 1e3 * a.u()[i], 1e3 * 1e-10 * 3.0);
}

}  // namespace
}  // namespace rheo::test
