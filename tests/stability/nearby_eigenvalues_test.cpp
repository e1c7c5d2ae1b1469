// Euler's limit on bodies too large for all their eigenvalues, by those that it hangs on: against all of them
// on bodies small enough for that.

#include "nearby_eigenvalues.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "range_step.hpp"
#include "rheo/error.hpp"
#include "rheo/live.hpp"
#include "rheo/simulation.hpp"
#include "stability/random_bodies.hpp"
#include "stability/runs/by_discs.hpp"
#include "stability/runs/stress_scene.hpp"
#include "stability/runs/true_limit.hpp"
#include "stability/scene_parts.hpp"
#include "support/sanitized.hpp"

namespace rheo::test {
namespace {

using Complex = std::complex<double>;

NearbyEigenvalues eigenvalues_of(const Scene& scene, const Parts& parts) {
  return {scene.mesh, parts.model, *parts.solver};
}

// Ties of two nodes, of one, of many.
void add_ties(Scene& scene) {
  std::vector<int> free;
  const std::vector<int> left = nodes_of(scene.mesh.edge_groups.at("left"));
  for (int node = 0; node < scene.mesh.node_count(); ++node)
    if (!std::ranges::binary_search(left, node)) free.push_back(node);
  scene.constraints.push_back({{{free[0], Axis::x, 1.0}, {free[1], Axis::x, -0.7}}, 0.0, "first"});
  scene.constraints.push_back({{{free[2], Axis::y, 2.0}}, 0.0, "second"});
  Constraint sum{{}, 0.0, "third"};
  for (std::size_t i = 3; i < free.size(); ++i)
    sum.terms.push_back({free[i], Axis::y, 1.0 + 0.1 * static_cast<double>(i)});
  scene.constraints.push_back(sum);
}

std::vector<double> rates_of(const Model& model) {
  std::vector<double> rates;
  for (const Patch& patch : model.patches)
    for (const Relaxation& each : relaxations_of(patch.material)) rates.push_back(each.rate);
  return rates;
}

double distance(Complex s, const std::vector<Complex>& all) {
  double least = std::numeric_limits<double>::infinity();
  for (const Complex each : all) least = std::min(least, std::abs(s - each));
  return least;
}

TEST(NearbyEigenvalues, DiscsHaveAllEigenvaluesAndNoOthers) {
  std::mt19937 random(61);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int found = 0;
  for (int k = 0; k < (is_sanitized ? 6 : 36); ++k) {
    Scene scene = random_body(random, k, 3 + k % 2, 3);
    set_mass(scene, k % 2 == 0 ? Mass::lumped : Mass::consistent);
    if (k % 5 == 0) add_ties(scene);
    const Parts parts(scene);
    auto all = TrueSpectrum(scene).values();
    const std::vector<double> rates = rates_of(parts.model);
    // What pulls at nothing is in there more often than in a body.
    std::erase_if(all, [&](Complex s) {
      return std::ranges::any_of(rates, [&](double rate) { return std::abs(s + rate) <= 1e-9 * rate; });
    });
    NearbyEigenvalues eigenvalues = eigenvalues_of(scene, parts);
    double largest = 0.0;
    for (const Complex s : all) largest = std::max(largest, std::abs(s));
    std::vector<Complex> known = all;
    for (const double rate : rates) known.emplace_back(-rate);
    for (int i = 0; i < 8; ++i) {
      const Complex near = all[static_cast<std::size_t>(unit(random) * static_cast<double>(all.size()))];
      const Complex centre = near + 0.1 * std::abs(near) * Complex(unit(random) - 0.5, unit(random));
      const Disc disc = eigenvalues.around(centre, centre);
      std::vector<Complex> inside;
      for (const NearbyEigenvalue& each : disc.eigenvalues) {
        inside.push_back(each.value);
        EXPECT_TRUE(disc.contains(each.value));
        EXPECT_LE(distance(each.value, known), each.error + 1e-14 * largest) << k << ": " << each.value;
      }
      for (const Complex s : all) {
        if (std::abs(s - centre) >= (1.0 - 1e-9) * disc.radius) continue;
        EXPECT_LE(distance(s, inside), 1e-5 * std::abs(s)) << k << ": " << s << " about " << centre;
        ++found;
      }
    }
  }
  EXPECT_GT(found, is_sanitized ? 300 : 2000);
}

TEST(NearbyEigenvalues, NothingVibratesWhereThatIsSaid) {
  std::mt19937 random(62);
  double lowest = 1.0;
  for (int k = 0; k < (is_sanitized ? 6 : 36); ++k) {
    Scene scene = random_body(random, k, 3, 3);
    set_mass(scene, k % 2 == 0 ? Mass::lumped : Mass::consistent);
    if (k % 5 == 0) add_ties(scene);
    const Parts parts(scene);
    const NearbyEigenvalues eigenvalues = eigenvalues_of(scene, parts);
    double slowest = std::numeric_limits<double>::infinity();
    for (const Complex s : TrueSpectrum(scene).values())
      if (std::abs(s.imag()) > 1e-7 * std::abs(s)) slowest = std::min(slowest, std::abs(s));
    ASSERT_TRUE(std::isfinite(slowest));
    double said = 10.0 * slowest;
    while (said > 1e-3 * slowest && !eigenvalues.nothing_vibrates_below(said)) said *= 0.95;
    EXPECT_LE(said, slowest) << k;
    lowest = std::min(lowest, said / slowest);
  }
  EXPECT_GT(lowest, 1e-3);
  std::printf("slowest vibration: said over true at the lowest %.3f\n", lowest);
}

// What a tie lets turn or shift only by 1 + 1e-7 is held, if softly, and vibrates: it is no rigid motion.
TEST(NearbyEigenvalues, WhatIsHardlyHeldIsNoRigidMotion) {
  for (const double eps : {1e-3, 1e-5, 1e-7, 1e-9}) {
    Scene scene;
    scene.mesh = rectangle({1.0, 1.0}, 3, 2, Diagonal::rising);
    prepare(scene.mesh);
    scene.fixes.push_back({{0, 1, 2, 3, 4, 5}, Axis::y, {}, "rail"});
    scene.constraints.push_back({{{0, Axis::x, 1.0}, {2, Axis::x, -1.0 - eps}}, 0.0, "tie"});
    scene.material.density = 1.0;
    scene.material.elastic = {1.0, 1.0};
    const Parts parts(scene);
    const NearbyEigenvalues eigenvalues = eigenvalues_of(scene, parts);
    // All shifted by as much strains by eps: a frequency of about eps.
    EXPECT_FALSE(eigenvalues.nothing_vibrates_below(10.0 * eps)) << eps;
  }
}

// Of two pieces the stiff one relaxes and the soft one never does: no step is stable, however much slower its
// vibrations are.
TEST(NearbyEigenvalues, NoStepIsFoundWhereSlowVibrationsAreNotDamped) {
  for (const double soft : {1e-4, 1e-8, 1e-11}) {
    for (const double rate : {1e-8, 1e-10}) {
      Scene scene;
      scene.mesh = rectangle({1.0, 1.0}, 4, 4, Diagonal::alternating);
      const int nodes = scene.mesh.node_count(), triangles = scene.mesh.triangle_count();
      for (const Vec2 p : {Vec2{3.0, 0.0}, Vec2{3.2, 0.0}, Vec2{3.1, 0.2}}) scene.mesh.points.push_back(p);
      scene.mesh.triangles.push_back({nodes, nodes + 1, nodes + 2});
      scene.mesh.edge_groups.clear();
      prepare(scene.mesh);
      scene.material.density = 1.0;
      scene.material.lambda_ela = scene.material.mu_ela = 1.0;
      scene.material.lambda_vis = scene.material.mu_vis = 1.0 / (8.0 * rate);
      Material never;
      never.density = 1.0;
      never.elastic = {soft, soft};
      scene.regions = {{"soft", never, {}, "soft"}};
      scene.region_of_triangle.assign(static_cast<std::size_t>(triangles), 1);
      scene.region_of_triangle.push_back(0);
      const Parts parts(scene);
      const DiscSearch discs{.eigenvalues = [&] { return eigenvalues_of(scene, parts); }};
      const RangeStep found =
          range_step(parts.model, *parts.solver, parts.spectrum, IntegratorKind::euler, 0.0, &discs);
      EXPECT_EQ(std::max(found.step, found.near_step), 0.0) << soft << ", " << rate;
    }
  }
}

class Tally {
 public:
  void add(const Scene& scene, const std::string& name) {
    const ByDiscs found = euler_by_discs(scene);
    if (!found.counts) return;
    ++tried_;
    near_ += found.is_near ? 1 : 0;
    without_a_bound_ += found.safe > 0.0 ? 0 : 1;
    EXPECT_FALSE(found.is_beyond()) << name << ": " << found.predicted << ", true " << found.truth.high;
    if (!found.is_near) return;
    EXPECT_FALSE(found.is_far()) << name << ": " << found.predicted << ", true " << found.truth.high;
    lowest_ = std::min(lowest_, found.predicted / found.truth.high);
  }

  int tried() const { return tried_; }
  int near() const { return near_; }
  int without_a_bound() const { return without_a_bound_; }
  void print() const {
    std::printf("Euler over true: lowest %.3f of %d bodies, told of %d, of them %d without a safe bound\n",
                lowest_, tried_, near_, without_a_bound_);
  }

 private:
  int tried_ = 0, near_ = 0, without_a_bound_ = 0;
  double lowest_ = 1.0;
};

// Over all there is: free and held, by elimination or Baumgarte, with and without ties, both masses, one
// material or two, with rates over four decades or up to three apart from one another, some of what does not
// relax at all.
TEST(NearbyEigenvalues, EulersStepIsWithinFivePercent) {
  Tally tally;
  std::mt19937 random(63);
  for (int k = 0; k < (is_sanitized ? 6 : 60); ++k) {
    Scene scene = random_body(random, k, 3 + k % 2, 3);
    set_mass(scene, k % 2 == 0 ? Mass::lumped : Mass::consistent);
    if (k % 5 == 0) add_ties(scene);
    if (k % 7 == 1) scene.time.constraints = ConstraintMethod::baumgarte;
    tally.add(scene, "wide " + std::to_string(k));
  }
  for (const double apart : {10.0, 1000.0}) {
    for (const int materials : {1, 2}) {
      for (int k = 0; k < (is_sanitized ? 2 : 15); ++k) {
        Scene scene = random_body(random, 2 + k % 2, 4 + k % 2, 3);
        set_rates_apart(scene, random, k, apart, materials);
        if (k % 5 == 0) add_ties(scene);
        tally.add(scene, std::to_string(materials) + " within " + std::to_string(apart));
      }
    }
  }
  tally.print();
  EXPECT_EQ(tally.near(), tally.tried());
  EXPECT_GT(tally.tried(), is_sanitized ? 8 : 90);
  EXPECT_GE(tally.without_a_bound(), is_sanitized ? 0 : 1);
}

// Where damping is rounding beside the vibrations, it may not be known; never is it beyond.
TEST(NearbyEigenvalues, EulersStepOfStressScenesIsNeverBeyondAndMostlyNear) {
  Tally tally;
  for (int k = 0; k < (is_sanitized ? 5 : 150); ++k)
    tally.add(stress_scene(1, k).scene, "stress scene " + std::to_string(k));
  tally.print();
  EXPECT_GE(tally.near(), 9 * tally.tried() / 10);
  EXPECT_GT(tally.tried(), is_sanitized ? 1 : 80);
}

// As scenes say it, beyond the number of eigenvalues that are all taken.
TEST(NearbyEigenvalues, EulersStepOfLargerBodiesIsWithinFivePercent) {
  std::mt19937 random(64);
  double lowest = 1.0;
  int told = 0;
  for (int k = 0; k < (is_sanitized ? 1 : 6); ++k) {
    Scene scene = random_body(random, k, 9, 6);
    if (k % 3 == 2) set_rates_apart(scene, random, k, 1000.0, 1 + k % 2);
    set_mass(scene, k % 2 == 0 ? Mass::lumped : Mass::consistent);
    if (k % 5 == 0) add_ties(scene);
    scene.time.integrator = IntegratorKind::euler;
    scene.time.step = 0.0;
    const TrueLimit limit = TrueSpectrum(scene).limit(IntegratorKind::euler);
    if (!limit.determined() || limit.low <= 0.0) continue;
    const Spectrum spectrum = Simulation(scene, {.allow_unstable = true}).spectrum();
    if (!spectrum.eigenvalues.empty()) continue;
    EXPECT_FALSE(stable_step_is_bound(spectrum, IntegratorKind::euler)) << k;
    const double predicted = stable_step(spectrum, IntegratorKind::euler);
    EXPECT_LE(predicted, limit.high * (1.0 + 1e-9)) << k;
    EXPECT_GE(predicted, 0.95 * limit.high) << k;
    lowest = std::min(lowest, predicted / limit.high);
    ++told;
  }
  EXPECT_GE(told, is_sanitized ? 0 : 4);
  std::printf("Euler over true: lowest %.3f of %d bodies\n", lowest, told);
}

// Eigenvalues of the scene's own constraints say nothing of what hands hold besides.
TEST(NearbyEigenvalues, AreNotUsedUnderHands) {
  std::mt19937 random(66);
  Scene scene;
  Spectrum spectrum;
  for (int k = 0; spectrum.near_euler_step <= 1.1 * spectrum.euler_step; ++k) {
    ASSERT_LT(k, 20) << "none where the range is not as near";
    scene = random_body(random, 2, 14, 9);
    set_rates_apart(scene, random, k, 1000.0, 2);
    scene.time.integrator = IntegratorKind::euler;
    scene.time.step = 0.0;
    spectrum = Simulation(scene).spectrum();
  }
  const double near = spectrum.near_euler_step;
  EXPECT_EQ(Simulation(scene).stable_step(), near);
  LiveSettings settings;
  settings.rate = 1.0 / scene.time.duration;
  settings.handles.push_back({.name = "hand", .nodes = {100}, .edges = {}});
  const Live live(scene, settings);
  EXPECT_EQ(live.simulation().spectrum().near_euler_step, 0.0);
  EXPECT_EQ(live.simulation().stable_step(), spectrum.euler_step);
  scene.time.step = 0.99 * near;
  EXPECT_NO_THROW(Simulation{scene});
  EXPECT_THROW((Simulation{scene, {.nearness = Nearness::range}}), Error);
}

}  // namespace
}  // namespace rheo::test
