// What the paper says of its beam (section 4, Figures 3 and 4).

#include <gtest/gtest.h>

#include <cmath>

#include "rheo/simulation.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

double norm(std::span<const double> w) {
  double sum = 0.0;
  for (double x : w) sum += x * x;
  return std::sqrt(sum);
}

class Beam : public testing::TestWithParam<Mass> {};

double tip(Simulation& simulation) {
  return simulation.read({"tip", nodes_of(simulation.scene().mesh.edge_groups.at("right")), {}, ""})
      .displacement.x;
}

TEST_P(Beam, ExtendsForTheFirstSecondThenShrinks) {
  Simulation simulation(paper_beam(GetParam()));
  double longest = 0.0, when = 0.0;
  std::vector<double> means;  // over thirds of a second: the beam also vibrates along its length
  for (int k = 1; k <= 300; ++k) {
    ASSERT_FALSE(simulation.advance(k / 60.0));
    const double x = tip(simulation);
    if (x > longest) longest = x, when = simulation.time();
    if (k % 20 == 1) means.push_back(0.0);
    means.back() += x / 20;
  }
  EXPECT_NEAR(when, 1.0, 0.1);  // its own inertia may carry it on for a moment
  EXPECT_LT(means[0], means[1]);
  EXPECT_LT(means[1], means[2]);
  for (std::size_t third = 4; third < means.size(); ++third) EXPECT_LT(means[third], means[2]) << third;
  EXPECT_LT(tip(simulation), 0.8 * longest);
}

TEST_P(Beam, KeepsAResidualDeformation) {
  Simulation simulation(paper_beam(GetParam()));
  ASSERT_FALSE(simulation.advance(5.0));
  const double at5 = tip(simulation);
  ASSERT_FALSE(simulation.advance(20.0));
  EXPECT_GT(tip(simulation), 1.0);                // longer than at rest by more than its own length
  EXPECT_NEAR(tip(simulation), at5, 0.05 * at5);  // and stays so
}

TEST_P(Beam, ResidualForcesDecay) {
  Simulation simulation(paper_beam(GetParam()));
  ASSERT_FALSE(simulation.advance(1.0));
  const double lambda = norm(simulation.w_lambda()), mu = norm(simulation.w_mu());
  EXPECT_GT(lambda, mu);
  ASSERT_FALSE(simulation.advance(5.0));
  EXPECT_LT(norm(simulation.w_lambda()), 0.02 * lambda);
  EXPECT_LT(norm(simulation.w_mu()), 0.02 * mu);
  ASSERT_FALSE(simulation.advance(30.0));
  EXPECT_LT(norm(simulation.w_lambda()), 1e-8 * lambda);
  EXPECT_LT(norm(simulation.w_mu()), 1e-8 * mu);
}

TEST_P(Beam, BendsBecauseItsTrianglesAreArrangedUnevenly) {
  Simulation simulation(paper_beam(GetParam()));
  ASSERT_FALSE(simulation.advance(1.0));
  double asymmetry = 0.0;
  for (int i = 0; i < 5; ++i)
    asymmetry += std::abs(simulation.u()[2 * i + 1] + simulation.u()[2 * (i + 5) + 1]);
  EXPECT_GT(asymmetry, 0.5);
}

TEST_P(Beam, OnAMirrorSymmetricMeshStaysSymmetric) {
  Scene scene = paper_beam(GetParam());
  // Three rows; the lower cells rise where the upper ones fall.
  Mesh mesh = rectangle({1.0, 0.25}, 5, 3, Diagonal::falling);
  const int columns = 4;
  for (int c = 0; c < columns; ++c) {
    const int bl = c, br = c + 1, tl = c + 5, tr = c + 6;
    mesh.triangles[2 * c] = {bl, br, tr};
    mesh.triangles[2 * c + 1] = {bl, tr, tl};
  }
  prepare(mesh);
  scene.mesh = mesh;
  scene.fixes[0].nodes = nodes_of(mesh.edge_groups.at("left"));
  scene.tractions[0].edges = mesh.edge_groups.at("right");
  scene.time.step = 2e-3;
  Simulation simulation(scene);
  for (double t : {0.5, 1.0, 5.0}) {
    ASSERT_FALSE(simulation.advance(t));
    for (int i = 0; i < 5; ++i) {
      // Zero but for rounding, which stays far below the displacements of order 1.
      EXPECT_NEAR(simulation.u()[2 * (i + 5) + 1], 0.0, 1e-12);
      EXPECT_NEAR(simulation.u()[2 * i + 1] + simulation.u()[2 * (i + 10) + 1], 0.0, 1e-12);
      EXPECT_NEAR(simulation.u()[2 * i] - simulation.u()[2 * (i + 10)], 0.0, 1e-12);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Masses, Beam, testing::Values(Mass::lumped, Mass::consistent),
                         [](const auto& c) { return c.param == Mass::lumped ? "Lumped" : "Consistent"; });

}  // namespace
}  // namespace rheo::test
