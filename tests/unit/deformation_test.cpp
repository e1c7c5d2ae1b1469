// Strain, stress and the linearity report against fields with known gradients.
#include "rheo/deformation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "rheo/shapes.hpp"

namespace rheo {
namespace {

// The linear field G x, node by node.
std::vector<double> linear_field(const Mesh& mesh, double xx, double xy, double yx, double yy) {
  std::vector<double> field;
  for (const Vec2 p : mesh.points) field.insert(field.end(), {xx * p.x + xy * p.y, yx * p.x + yy * p.y});
  return field;
}

// Rounding of coordinates and differences: a few units in the last place of numbers of size 1.
constexpr double rounding = 1e-13;

TEST(Strain, OfALinearFieldIsItsGradientAtAnyScale) {
  for (const double scale : {1e-8, 1.0, 1e8}) {
    const Mesh mesh = disk(scale, 4);
    std::vector<double> e(3 * mesh.triangles.size());
    strain(mesh, linear_field(mesh, 0.3, 0.1, -0.4, -0.2), e);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      EXPECT_NEAR(e[3 * i], 0.3, rounding);
      EXPECT_NEAR(e[3 * i + 1], -0.2, rounding);
      EXPECT_NEAR(e[3 * i + 2], -0.3, rounding);
    }
  }
}

TEST(Stress, FollowsTheTwoIsotropicTensors) {
  const Mesh mesh = rectangle({2.0, 1.0}, 4, 3, Diagonal::alternating);
  std::vector<double> s(3 * mesh.triangles.size());
  stress(mesh, linear_field(mesh, 1.0, 5.0, 0.0, 2.0), linear_field(mesh, 10.0, 3.0, 4.0, 20.0), s);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    EXPECT_NEAR(s[3 * i], 1.0 + 2.0 + 2.0 * 10.0, 1e2 * rounding);
    EXPECT_NEAR(s[3 * i + 1], 1.0 + 2.0 + 2.0 * 20.0, 1e2 * rounding);
    EXPECT_NEAR(s[3 * i + 2], 3.0 + 4.0, 1e2 * rounding);
  }
}

TEST(Linearity, RestIsFine) {
  const Mesh mesh = rectangle({1.0, 1.0}, 3, 3);
  const LinearityReport report = check_linearity(mesh, std::vector<double>(18, 0.0));
  EXPECT_EQ(report.inverted, 0);
  EXPECT_EQ(report.first_inverted, -1);
  EXPECT_EQ(report.strain, 0.0);
  EXPECT_EQ(report.rotation, 0.0);
}

TEST(Linearity, ReportsTheAngleOfARotation) {
  const Mesh mesh = disk(1.0, 2);
  const double angle = 0.3;
  const auto u =
      linear_field(mesh, std::cos(angle) - 1.0, -std::sin(angle), std::sin(angle), std::cos(angle) - 1.0);
  EXPECT_NEAR(check_linearity(mesh, u).rotation, angle, rounding);
  EXPECT_NEAR(check_linearity(mesh, u).strain, 1.0 - std::cos(angle), rounding);
}

TEST(Linearity, PrincipalStrainIsFoundInAnyDirection) {
  const Mesh mesh = disk(1.0, 2);
  const double c = std::cos(0.7), s = std::sin(0.7);
  // Stretch of -0.25 along one direction, 0.1 across.
  const auto u = linear_field(mesh, -0.25 * c * c + 0.1 * s * s, -0.35 * c * s, -0.35 * c * s,
                              -0.25 * s * s + 0.1 * c * c);
  EXPECT_NEAR(check_linearity(mesh, u).strain, 0.25, rounding);
  EXPECT_NEAR(check_linearity(mesh, u).rotation, 0.0, rounding);
}

TEST(Linearity, NamesTheWorstTriangles) {
  const Mesh mesh = rectangle({4.0, 1.0}, 5, 2);
  std::vector<double> u(20, 0.0);
  u[2 * 9] = -2.0;  // the right upper corner passes through triangle 7: (9, 8, 4)
  const LinearityReport report = check_linearity(mesh, u);
  EXPECT_EQ(report.inverted, 1);
  EXPECT_EQ(report.first_inverted, 7);
  EXPECT_EQ(report.most_strained, 7);
  EXPECT_EQ(report.most_rotated, 7);
}

TEST(Linearity, CountsATriangleWithoutAreaAsInverted) {
  const Mesh mesh = rectangle({1.0, 1.0}, 2, 2);
  EXPECT_EQ(check_linearity(mesh, linear_field(mesh, 0.0, 0.0, 0.0, -1.0)).inverted, 2);
}

}  // namespace
}  // namespace rheo
