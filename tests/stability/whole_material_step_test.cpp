// The predicted stable step of whole materials against the true one, from the eigenvalues of the full
// operator.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "rheo/shapes.hpp"
#include "rheo/simulation.hpp"
#include "support/exact.hpp"
#include "support/whole_materials.hpp"

namespace rheo::test {
namespace {

// u counts here: the elastic part hangs on it.
double true_limit(const Scene& scene, IntegratorKind integrator) {
  const std::vector<DenseMatrices> matrices = matrices_by_region(scene);
  const Eigen::Index d = matrices.front().mass.rows();
  std::vector<int> held;
  for (const Fix& fix : scene.fixes)
    for (const int node : fix.nodes) held.insert(held.end(), {2 * node, 2 * node + 1});
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(d, static_cast<Eigen::Index>(held.size()));
  for (std::size_t k = 0; k < held.size(); ++k) a(held[k], static_cast<Eigen::Index>(k)) = 1.0;
  Eigen::MatrixXd op = full_operator(matrices, materials_of(scene), a, 0.0);
  // Blocks on both sides of the diagonal in one size: the eigenvalues stay, their rounding shrinks.
  for (Eigen::Index part = 0; part < op.rows() / d; ++part) {
    if (part == 1) continue;
    const double up = op.block(d, part * d, d, d).norm(), down = op.block(part * d, d, d, d).norm();
    if (up == 0.0 || down == 0.0) continue;
    const double unit = std::sqrt(down / up);
    op.block(d, part * d, d, d) *= unit;
    op.block(part * d, d, d, d) /= unit;
  }
  const auto s = Eigen::EigenSolver<Eigen::MatrixXd>(op, false).eigenvalues();
  const double largest = s.cwiseAbs().maxCoeff();
  double limit = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    if (std::abs(s[i]) < 1e-6 * largest) continue;
    const double re = std::abs(s[i].real()) < 1e-10 * largest ? 0.0 : s[i].real();
    limit = std::min(limit, stable_step_of({std::min(re, 0.0), s[i].imag()}, integrator));
  }
  return limit;
}

TEST(WholeMaterialStep, IsNeverAboveTheTruthAndNearIt) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double lowest = 1.0, sum = 0.0;
  constexpr int scenes = 120;
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
    const double truth = true_limit(scene, IntegratorKind::rk4);
    const double predicted = stable_step(probe.spectrum(), IntegratorKind::rk4);
    EXPECT_LE(predicted, truth * (1 + 1e-6)) << k;
    EXPECT_GE(predicted, 0.95 * truth) << k;
    lowest = std::min(lowest, predicted / truth);
    sum += predicted / truth;
    scene.time.integrator = IntegratorKind::euler;
    const Simulation euler(scene, {.allow_unstable = true});
    const double limit = true_limit(scene, IntegratorKind::euler);
    EXPECT_LE(stable_step(euler.spectrum(), IntegratorKind::euler), limit * (1 + 1e-6)) << k;
    EXPECT_GE(stable_step(euler.spectrum(), IntegratorKind::euler), 0.95 * limit) << k << " by eigenvalues";
  }
  std::printf("RK4, predicted over true: lowest %.4f, mean %.4f\n", lowest, sum / scenes);
}

// By the bound alone, as on large scenes, and with the eigenvalues, as on these.
TEST(WholeMaterialStep, OfSeveralMaterialsIsNeverAboveTheTruth) {
  std::mt19937 random(22);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double lowest = 1.0, lowest_bound = 1.0;
  for (int k = 0; k < 40; ++k) {
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
    const double truth = true_limit(scene, IntegratorKind::rk4);
    const double predicted = stable_step(probe.spectrum(), IntegratorKind::rk4);
    Spectrum large = probe.spectrum();
    large.eigenvalues.clear();
    const double bound = stable_step(large, IntegratorKind::rk4);
    EXPECT_LE(predicted, truth * (1 + 1e-6)) << k;
    EXPECT_LE(bound, truth * (1 + 1e-6)) << k;
    EXPECT_GE(bound, 0.6 * truth) << k;
    if (!probe.spectrum().eigenvalues.empty()) {
      EXPECT_GE(predicted, 0.95 * truth) << k;
    }
    lowest = std::min(lowest, predicted / truth);
    lowest_bound = std::min(lowest_bound, bound / truth);
  }
  std::printf("RK4, lowest over true: predicted %.4f, bound %.4f\n", lowest, lowest_bound);
}

}  // namespace
}  // namespace rheo::test
