// Stable steps of bodies too large for all their eigenvalues, by the numerical range of the operator: against
// all eigenvalues on small bodies, and against the outermost ones, by Arnoldi, on larger.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <limits>
#include <random>

#include "lanczos.hpp"
#include "range_step.hpp"
#include "rheo/simulation.hpp"
#include "stability/random_bodies.hpp"
#include "stability/runs/outer_limit.hpp"
#include "stability/runs/true_limit.hpp"
#include "stability/scene_parts.hpp"
#include "support/exact.hpp"
#include "support/sanitized.hpp"
#include "support/scenes.hpp"
#include "support/whole_materials.hpp"

namespace rheo::test {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// Eigenvalues of M^-1 (lambda J_lambda + mu J_mu) on the nodes that no fix holds, rising.
Eigen::VectorXd quotients_of(const Scene& scene, const Moduli& moduli) {
  const DenseMatrices dense = dense_matrices(scene.mesh, scene.material);
  std::vector<char> held(static_cast<std::size_t>(scene.mesh.node_count()), 0);
  for (const Fix& fix : scene.fixes)
    for (const int node : fix.nodes) held[static_cast<std::size_t>(node)] = 1;
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < dense.mass.rows(); ++i)
    if (!held[static_cast<std::size_t>(i / 2)]) free.push_back(i);
  const Eigen::MatrixXd j = moduli.lambda * dense.j_lambda + moduli.mu * dense.j_mu;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solved(
      j(free, free), dense.mass(free, free), Eigen::EigenvaluesOnly);
  return solved.eigenvalues();
}

TEST(NumericalRange, LowestEigenvalueIsBetweenItsBoundAndTheRitzValue) {
  std::mt19937 random(41);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int k = 0; k < 20; ++k) {
    Scene scene = random_body(random, 2, 5, 4);
    scene.material = paper_beam(Mass::lumped).material;  // one that needs both matrices
    set_mass(scene, k % 2 == 0 ? Mass::lumped : Mass::consistent);
    const Parts parts(scene);
    const std::vector<Moduli> moduli{{unit(random), unit(random)}};
    const Eigen::VectorXd exact = quotients_of(scene, moduli[0]);
    const double lowest = exact[0], spread = exact.maxCoeff() - lowest;
    for (const double shift : {0.0, -0.5 * lowest, -1.01 * lowest, -2.0 * lowest}) {
      const LowestValue found = lowest_value(parts.model, *parts.solver, moduli, shift, 200);
      EXPECT_LE(found.bound, lowest + 1e-12 * spread) << k;
      EXPECT_GE(found.ritz, lowest - 1e-11 * spread) << k;
      if (lowest + shift < -1e-6 * spread) {
        EXPECT_LT(found.ritz + shift, 0.0) << k;
      }
      if (lowest + shift > 0.1 * spread) {
        EXPECT_GT(found.bound + shift, 0.0) << k;
      }
      const Vector x = lowest_vector(parts.model, *parts.solver, moduli, found);
      Vector mass_times(x.size());
      parts.model.multiply_mass(x.data(), mass_times.data());
      EXPECT_NEAR(x.dot(parts.model.stiffness(moduli, x)) / x.dot(mass_times), found.ritz, 1e-6 * spread);
    }
  }
}

TEST(NumericalRange, LargestFrequencyIsNeverBelowTheTruthAndNear) {
  std::mt19937 random(40);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < (is_sanitized ? 8 : 80); ++k) {
    Scene scene = random_body(random, 2 + k % 2, 4 + k % 12, 3 + k % 7);
    // Single modes on single triangles, of all depths below the rest.
    const auto moved = static_cast<std::size_t>(unit(random) * scene.mesh.node_count());
    scene.mesh.points[moved].x += 0.3 * unit(random) / (3 + k % 12);
    prepare(scene.mesh);
    scene.material = paper_beam(Mass::lumped).material;
    set_mass(scene, k % 3 == 0 ? Mass::consistent : Mass::lumped);
    const Parts parts(scene);
    const double exact = std::sqrt(quotients_of(scene, scene.material.instantaneous()).maxCoeff());
    EXPECT_GE(parts.spectrum.omega_max, exact * (1.0 - 1e-12)) << k;
    EXPECT_LE(parts.spectrum.omega_max, 1.0075 * exact) << k;
  }
}

// After looks all around the eigenvalues it excludes much, and none of them.
TEST(NumericalRange, ExcludesNoEigenvalue) {
  std::mt19937 random(42);
  int excluded = 0, tried = 0;
  for (int k = 0; k < (is_sanitized ? 4 : 16); ++k) {
    Scene scene = random_body(random, k, 3, 3);
    set_mass(scene, k % 2 == 0 ? Mass::lumped : Mass::consistent);
    const Parts parts(scene);
    const auto all = TrueSpectrum(scene).values();
    NumericalRange range(parts.model, *parts.solver);
    for (std::size_t i = 0; i < all.size(); i += 3) {
      for (const double factor : {0.8, 1.1}) {
        const std::complex<double> z = factor / all[i];
        range.look_at(z, i % 2 == 0 ? NumericalRange::Clearest::part : NumericalRange::Clearest::distance);
      }
    }
    for (const std::complex<double> s : all) {
      const std::complex<double> z = 1.0 / s;
      const std::complex<double> near[] = {z, z * std::complex<double>(1.0, 1e-3), z * 1.001,
                                           z * std::complex<double>(0.999, -1e-3)};
      EXPECT_FALSE(range.excludes({near, 1})) << k << ": " << s;
      EXPECT_FALSE(range.excludes(near)) << k << ": " << s;
      // As large as the search's: 6 % and 5 % or 1 degree.
      const std::complex<double> cell[] = {
          z * std::complex<double>(0.97, -0.02), z * std::complex<double>(1.03, -0.02),
          z * std::complex<double>(0.97, 0.03), z * std::complex<double>(1.03, 0.03)};
      EXPECT_FALSE(range.excludes(cell)) << k << ": " << s;
      for (const double factor : {0.5, 0.7, 1.5, 3.0}) {
        const std::complex<double> other = factor * z;
        ++tried;
        excluded += range.excludes({&other, 1}) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(excluded, tried / 2);
  std::printf("excluded %d of %d points beside eigenvalues\n", excluded, tried);
}

TEST(NumericalRange, StepIsNeverAboveTheTruthAndRk4sIsNear) {
  std::mt19937 random(43);
  double lowest[2] = {1.0, 1.0}, sum[2] = {0.0, 0.0}, sum_before[2] = {0.0, 0.0};
  int count[2] = {0, 0};
  for (int k = 0; k < (is_sanitized ? 6 : 48); ++k) {
    Scene scene = random_body(random, k, 3 + k % 2, 3);
    set_mass(scene, k % 2 == 0 ? Mass::lumped : Mass::consistent);
    const Parts parts(scene);
    const TrueSpectrum truth(scene);
    for (const IntegratorKind integrator : {IntegratorKind::rk4, IntegratorKind::euler}) {
      const double safe = stable_step(parts.spectrum, integrator);
      const TrueLimit limit = truth.limit(integrator);
      if (!limit.determined() || !(safe > 0.0) || std::isinf(safe)) continue;
      const double found = range_step(parts.model, *parts.solver, parts.spectrum, integrator, safe).step;
      const double best = std::max(found, safe);
      EXPECT_LE(best, limit.high * (1.0 + 1e-9)) << k;
      const bool is_rk4 = integrator == IntegratorKind::rk4;
      if (is_rk4) {
        EXPECT_GE(best, 0.95 * limit.low) << k;
      }
      const int i = is_rk4 ? 0 : 1;
      lowest[i] = std::min(lowest[i], best / limit.high);
      sum[i] += best / limit.high;
      sum_before[i] += safe / limit.high;
      ++count[i];
    }
  }
  EXPECT_EQ(count[0], is_sanitized ? 6 : 48);
  EXPECT_GT(count[1], is_sanitized ? 2 : 30);
  for (const int i : {0, 1})
    std::printf("%s over true: lowest %.3f, mean %.3f; without the range mean %.3f; %d scenes\n",
                i == 0 ? "RK4" : "Euler", lowest[i], sum[i] / count[i], sum_before[i] / count[i], count[i]);
  // The range is wider than its eigenvalues where rates far apart share a mode, but half as far as before.
  EXPECT_GT(1.0 - sum_before[1] / count[1], 1.3 * (1.0 - sum[1] / count[1]));
}

// A dashpot whose rate in the fastest mode is nearly that of a weak branch: eigenvalues right beside the pole
// s = -r, where the operator changes over less than a cell of the search. (From half a safe step on, so that
// all of it is searched.)
TEST(NumericalRange, StepIsNotAboveTheTruthBesideAPole) {
  std::mt19937 random(48);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto decades = [&](double low, double high) { return low * std::pow(high / low, unit(random)); };
  int found = 0, tried = 0;
  for (int k = 0; k < (is_sanitized ? 8 : 80); ++k) {
    Scene scene = random_body(random, 2 + k % 2, 2 + k % 2, 2);
    const double ratio = decades(0.1, 10.0);
    scene.material = {};
    scene.material.density = 0.2;
    scene.material.elastic = {ratio, 1.0};
    const double omega = Parts(scene).spectrum.omega_max;
    const double weak = decades(3e-3, 0.3);  // branch and dashpot: s^2 + (d + r) s + r d (1 + weak^2) = 0
    const double dashpot = (1.0 + (1.2 * unit(random) - 0.2) * 2.0 * weak) / (omega * omega);
    Material& m = scene.material;
    m.mu_ela = m.mu_vis = weak * weak * dashpot;  // of rate 1
    m.lambda_ela = m.lambda_vis = ratio * m.mu_ela;
    m.viscous = {ratio * dashpot, dashpot};
    m.elastic =
        k % 5 == 4 ? Moduli{ratio * m.mu_ela * decades(1e-3, 1.0), m.mu_ela * decades(1e-3, 1.0)} : Moduli{};
    const Parts parts(scene);
    const TrueSpectrum truth(scene);
    for (const IntegratorKind integrator : {IntegratorKind::rk4, IntegratorKind::euler}) {
      const double safe = stable_step(parts.spectrum, integrator);
      const TrueLimit limit = truth.limit(integrator);
      if (!limit.determined()) continue;
      const double step = range_step(parts.model, *parts.solver, parts.spectrum, integrator, 0.5 * safe).step;
      EXPECT_LE(step, limit.high * (1.0 + 1e-9)) << k;
      ++tried;
      found += step > 0.9 * limit.high ? 1 : 0;
    }
  }
  EXPECT_GT(found, 9 * tried / 10);
}

// Springs e and a branch e1 of a rate R far above all vibrations: a dashpot e1 / R, and Euler's limit is
// e1 / (e R) however slow the vibration.
TEST(NumericalRange, VibrationsFarSlowerThanTheFastestRateCount) {
  std::mt19937 random(49);
  Scene scene = random_body(random, 2, 14, 9);
  scene.material = {};
  scene.material.density = 0.2;
  scene.material.elastic = {60.0, 30.0};
  scene.material.lambda_ela = 6.0;
  scene.material.mu_ela = 3.0;
  scene.time.integrator = IntegratorKind::euler;
  scene.time.step = 0.0;
  for (const double rate : {1e4, 1e7, 1e10, 1e13}) {
    scene.material.lambda_vis = 6.0 / rate;
    scene.material.mu_vis = 3.0 / rate;
    const Spectrum spectrum = Simulation(scene, {.allow_unstable = true}).spectrum();
    ASSERT_TRUE(spectrum.eigenvalues.empty());
    EXPECT_LE(stable_step(spectrum, IntegratorKind::euler), 0.1 / rate * (1.0 + 1e-3)) << rate;
    EXPECT_GE(stable_step(spectrum, IntegratorKind::euler), 0.095 / rate) << rate;
  }
}

// Rates of lambda and mu alike, as of one relaxation of Young's modulus with one Poisson ratio: the
// operator's parts share their eigenvectors, and the range is as near as the search.
TEST(NumericalRange, EulersStepIsNearWhereModuliRelaxAlike) {
  std::mt19937 random(44);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < (is_sanitized ? 2 : 10); ++k) {
    Scene scene = random_body(random, 2 + k, 14, 9);
    scene.regions.clear();
    scene.region_of_triangle.clear();
    const double frequency = 4.0 * 13;
    const double ratio = 0.2 + 5.0 * unit(random);
    Response mu{{{20.0, frequency * std::pow(10.0, 2.0 * unit(random) - 1.5)},
                 {10.0 * unit(random), frequency * std::pow(10.0, 2.0 * unit(random) - 2.5)}},
                10.0 * unit(random),
                0.0};
    scene.material = material_of(mu.scaled(ratio), mu, 0.2);
    scene.time.integrator = IntegratorKind::euler;
    scene.time.step = 0.0;
    const Simulation simulation(scene, {.allow_unstable = true});
    ASSERT_TRUE(simulation.spectrum().eigenvalues.empty()) << "more than are taken";
    // By the vibrations alone: s + omega^2 sum of e / (s + r) = 0 with e the springs' shares.
    const Eigen::VectorXd quotients = quotients_of(scene, {ratio, 1.0});
    const std::vector<Relaxation> springs = relaxations_of(scene.material);
    const auto n = static_cast<Eigen::Index>(springs.size());
    double truth = infinite;
    for (const Relaxation& each : springs)
      if (each.rate > 0.0) truth = std::min(truth, 2.0 / each.rate);
    for (const double q : quotients) {
      if (q < 1e-9 * quotients.maxCoeff()) continue;
      Eigen::MatrixXd mode = Eigen::MatrixXd::Zero(1 + n, 1 + n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const Relaxation& each = springs[static_cast<std::size_t>(i)];
        mode(0, 1 + i) = -std::sqrt(each.moduli.mu * q);
        mode(1 + i, 0) = -mode(0, 1 + i);
        mode(1 + i, 1 + i) = -each.rate;
      }
      const Eigen::EigenSolver<Eigen::MatrixXd> solved(mode, false);
      for (const std::complex<double> s : solved.eigenvalues())
        truth = std::min(truth, stable_step_of({std::min(s.real(), 0.0), s.imag()}, IntegratorKind::euler));
    }
    const double predicted = stable_step(simulation.spectrum(), IntegratorKind::euler);
    EXPECT_LE(predicted, truth * (1.0 + 1e-9)) << k;
    EXPECT_GE(predicted, 0.95 * truth) << k;
  }
}

TEST(NumericalRange, EulersStepIsNearWhereRatesAreNotFarApart) {
  struct Case {
    double apart;
    bool two;
    double least;
  };
  for (const Case& c : {Case{3.0, false, 0.95}, Case{10.0, false, 0.88}, Case{3.0, true, 0.85}}) {
    std::mt19937 random(5);
    double lowest = 1.0, sum = 0.0;
    int count = 0;
    for (int k = 0; k < (is_sanitized ? 4 : 30); ++k) {
      Scene scene = random_body(random, 2 + k % 2, 4 + k % 2, 3);
      set_rates_apart(scene, random, k, c.apart, c.two ? 2 : 1);
      scene.time.integrator = IntegratorKind::euler;
      const Parts parts(scene);
      const TrueLimit limit = TrueSpectrum(scene).limit(IntegratorKind::euler);
      ASSERT_TRUE(limit.determined()) << k;
      const double safe = stable_step(parts.spectrum, IntegratorKind::euler);
      const double found = std::max(
          safe, range_step(parts.model, *parts.solver, parts.spectrum, IntegratorKind::euler, safe).step);
      EXPECT_LE(found, limit.high * (1.0 + 1e-9)) << k;
      EXPECT_GE(found, c.least * limit.low) << k;
      lowest = std::min(lowest, found / limit.high);
      sum += found / limit.high;
      ++count;
    }
    std::printf("Euler, %s, rates within %g: lowest over true %.3f, mean %.3f\n",
                c.two ? "two materials" : "one material", c.apart, lowest, sum / count);
  }
}

TEST(NumericalRange, Rk4sStepIsNearTheOutermostEigenvaluesOfALargerBody) {
  constexpr int scenes = is_sanitized ? 3 : 16;
  std::mt19937 random(45);
  double lowest = 1.0;
  int told = 0;
  for (int k = 0; k < scenes; ++k) {
    Scene scene = random_body(random, k, is_sanitized ? 12 : 26, is_sanitized ? 7 : 13);
    scene.time.step = 0.0;
    const Simulation simulation(scene, {.allow_unstable = true});
    ASSERT_TRUE(simulation.spectrum().eigenvalues.empty()) << "more than are taken";
    const double predicted = stable_step(simulation.spectrum(), IntegratorKind::rk4);
    const OuterLimit truth = outer_rk4_limit(scene);
    if (!truth.complete) continue;  // all springs of the fastest rate
    ++told;
    EXPECT_LE(predicted, truth.step * (1.0 + 1e-6)) << k;
    EXPECT_GE(predicted, 0.95 * truth.step) << k;
    lowest = std::min(lowest, predicted / truth.step);
  }
  EXPECT_GE(told, scenes / 3);
  std::printf("RK4, lowest over true: %.4f, of %d scenes\n", lowest, told);
}

// The Arnoldi process above against all eigenvalues.
TEST(NumericalRange, OutermostEigenvaluesAreThoseOfTheWholeOperator) {
  std::mt19937 random(46);
  for (int k = 0; k < (is_sanitized ? 2 : 8); ++k) {
    const Scene scene = random_body(random, k, 4, 3);
    const TrueLimit truth = TrueSpectrum(scene).limit(IntegratorKind::rk4);
    const OuterLimit outer = outer_rk4_limit(scene);
    if (!outer.complete) continue;
    EXPECT_NEAR(outer.step, truth.high, 1e-6 * truth.high) << k;
  }
}

// A scene that gives a step which is surely stable is not searched for more.
TEST(NumericalRange, IsNotAskedForWhereTheGivenStepIsSurelyStable) {
  std::mt19937 random(47);
  Scene scene = random_body(random, 2, 14, 9);
  scene.material = paper_beam(Mass::lumped).material;
  scene.material.lambda_vis = 10.0 * scene.material.mu_vis;
  scene.time.integrator = IntegratorKind::euler;
  const auto spectrum_at = [&](double step, Nearness nearness) {
    scene.time.step = step;
    return Simulation(scene, {.allow_unstable = true, .nearness = nearness}).spectrum();
  };
  const Spectrum searched = spectrum_at(0.0, Nearness::near), safe = spectrum_at(0.0, Nearness::safe);
  EXPECT_GT(searched.euler_step, 0.0);
  EXPECT_EQ(safe.euler_step, 0.0);
  const double near = stable_step(searched, IntegratorKind::euler);
  EXPECT_LT(stable_step(safe, IntegratorKind::euler), near);
  EXPECT_EQ(spectrum_at(0.5 * near, Nearness::near).euler_step, 0.0);
  EXPECT_EQ(spectrum_at(2.0 * near, Nearness::near).euler_step, searched.euler_step);
}

}  // namespace
}  // namespace rheo::test
