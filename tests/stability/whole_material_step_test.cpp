// The predicted stable step of whole materials against the true one, from the eigenvalues of the full
// operator.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "rheo/shapes.hpp"
#include "rheo/simulation.hpp"
#include "stability/runs/true_limit.hpp"
#include "support/whole_materials.hpp"

namespace rheo::test {
namespace {

// Long double eigenvalues under sanitizers are slow, and nobody's memory is at stake in them.
#if defined(RHEO_SANITIZE_ADDRESS) || defined(RHEO_SANITIZE_THREAD)
constexpr int scenes = 24, several_materials = 8;
#else
constexpr int scenes = 120, several_materials = 40;
#endif

TEST(WholeMaterialStep, IsNeverAboveTheTruthAndNearIt) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double lowest = 1.0, sum = 0.0;
  for (int k = 0; k < scenes; ++k) {
    Scene scene;
    scene.mesh = rectangle({1.0, 0.2 + unit(random)}, 2 + k % 3, 2 + k % 2, Diagonal::alternating);
    for (Vec2& p : scene.mesh.points) p.x += 0.1 * unit(random), p.y += 0.05 * unit(random);
    prepare(scene.mesh);
    if (k % 3 != 0)
      scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, "left"});
    // About the fastest vibration of these meshes.
    scene.material = random_material(random, 0.2, 4.0, 30.0);
    scene.material.mass = k % 2 == 0 ? Mass::lumped : Mass::consistent;
    scene.time.duration = 1e-11;
    scene.time.step = 1e-12;
    const Simulation probe(scene, {.allow_unstable = true});
    const TrueSpectrum true_spectrum(scene);
    const TrueLimit truth = true_spectrum.limit(IntegratorKind::rk4);
    const double predicted = stable_step(probe.spectrum(), IntegratorKind::rk4);
    EXPECT_TRUE(truth.determined()) << k;
    EXPECT_LE(predicted, truth.high * (1 + 1e-9)) << k;
    EXPECT_GE(predicted, 0.95 * truth.low) << k;
    lowest = std::min(lowest, predicted / truth.high);
    sum += predicted / truth.high;
    scene.time.integrator = IntegratorKind::euler;
    const Simulation euler(scene, {.allow_unstable = true});
    const TrueLimit limit = true_spectrum.limit(IntegratorKind::euler);
    EXPECT_TRUE(limit.determined()) << k;
    EXPECT_LE(stable_step(euler.spectrum(), IntegratorKind::euler), limit.high * (1 + 1e-9)) << k;
    EXPECT_GE(stable_step(euler.spectrum(), IntegratorKind::euler), 0.95 * limit.low)
        << k << " by eigenvalues";
  }
  std::printf("RK4, predicted over true: lowest %.4f, mean %.4f\n", lowest, sum / scenes);
}

bool relaxes_in_shear(const Material& material) {
  const std::vector<Relaxation> all = relaxations_of(material);
  return material.viscous.mu > 0.0 ||
         std::ranges::any_of(all, [](const Relaxation& r) { return r.rate > 0.0 && r.moduli.mu > 0.0; });
}

// By the bound alone, as on large scenes, and with the eigenvalues, as on these.
TEST(WholeMaterialStep, OfSeveralMaterialsIsNeverAboveTheTruth) {
  std::mt19937 random(22);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double lowest = 1.0, lowest_bound = 1.0, lowest_euler = 1.0;
  int relaxing = 0;
  for (int k = 0; k < several_materials; ++k) {
    Scene scene;
    scene.mesh = rectangle({1.0, 0.2 + unit(random)}, 2 + k % 2, 2 + k % 2, Diagonal::alternating);
    for (Vec2& p : scene.mesh.points) p.x += 0.1 * unit(random), p.y += 0.05 * unit(random);
    prepare(scene.mesh);
    if (k % 3 != 0)
      scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, "left"});
    const Mass mass = k % 2 == 0 ? Mass::lumped : Mass::consistent;
    scene.material = random_material(random, 0.2, 4.0, 30.0);
    const double contrast = std::pow(10.0, 2 * unit(random) - 1);
    scene.regions = {{"other", random_material(random, 0.3, 4.0 * contrast, 30.0), {}, "other"}};
    scene.material.mass = scene.regions[0].material.mass = mass;
    for (int e = 0; e < scene.mesh.triangle_count(); ++e) scene.region_of_triangle.push_back(e % 2);
    scene.time.duration = 1e-11;
    scene.time.step = 1e-12;
    const Simulation probe(scene, {.allow_unstable = true});
    const TrueSpectrum true_spectrum(scene);
    const TrueLimit limit = true_spectrum.limit(IntegratorKind::rk4);
    EXPECT_TRUE(limit.determined()) << k;
    const double truth = limit.high;
    const double predicted = stable_step(probe.spectrum(), IntegratorKind::rk4);
    Spectrum large = probe.spectrum();
    large.eigenvalues.clear();
    const double bound = stable_step(large, IntegratorKind::rk4);
    EXPECT_LE(predicted, truth * (1 + 1e-9)) << k;
    EXPECT_LE(bound, truth * (1 + 1e-9)) << k;
    EXPECT_GE(bound, 0.6 * truth) << k;
    if (!probe.spectrum().eigenvalues.empty()) {
      EXPECT_GE(predicted, 0.95 * truth) << k;
    }
    lowest = std::min(lowest, predicted / truth);
    lowest_bound = std::min(lowest_bound, bound / truth);
    const TrueLimit euler_truth = true_spectrum.limit(IntegratorKind::euler);
    if (!euler_truth.determined()) continue;
    const double euler_bound = stable_step(large, IntegratorKind::euler);
    EXPECT_LE(euler_bound, euler_truth.high * (1 + 1e-9)) << k;
    if (!relaxes_in_shear(scene.material) || !relaxes_in_shear(scene.regions[0].material)) continue;
    ++relaxing;
    EXPECT_GT(euler_bound, 0.02 * euler_truth.high) << k;
    lowest_euler = std::min(lowest_euler, euler_bound / euler_truth.high);
  }
  std::printf("lowest over true: RK4 predicted %.4f, bound %.4f; Euler's bound %.4f\n", lowest, lowest_bound,
              lowest_euler);
  EXPECT_GE(relaxing, several_materials / 4);
}

}  // namespace
}  // namespace rheo::test
