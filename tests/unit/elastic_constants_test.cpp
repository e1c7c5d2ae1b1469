#include "rheo/elastic_constants.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

namespace rheo {
namespace {

constexpr double rounding = 1e-13;  // a handful of operations

// Hooke's law in space: strains from stresses.
Eigen::Vector3d strains(double young, double nu, const Eigen::Vector3d& stress) {
  Eigen::Matrix3d compliance;
  compliance << 1, -nu, -nu, -nu, 1, -nu, -nu, -nu, 1;
  return compliance * stress / young;
}

TEST(ElasticConstants, PlaneStrainKeepsTheStrainAcrossThePlaneAtZero) {
  for (const double nu : {0.0, 0.1, 0.3, 0.45, 0.4999}) {
    const double young = 1234.0, sx = 7.0, sy = -3.0;
    const double sz = nu * (sx + sy);
    const Eigen::Vector3d e = strains(young, nu, {sx, sy, sz});
    ASSERT_NEAR(e[2], 0.0, 1e-17);
    const Moduli m = moduli_of({young, nu}, Plane::strain);
    // The difference of the strains loses digits as lambda grows against mu: condition 1 / (1 - 2 nu).
    const double tolerance = 1e-14 / (1.0 - 2.0 * nu);
    EXPECT_NEAR(m.lambda * (e[0] + e[1]) + 2.0 * m.mu * e[0], sx, 10 * tolerance);
    EXPECT_NEAR(m.lambda * (e[0] + e[1]) + 2.0 * m.mu * e[1], sy, 10 * tolerance);
  }
}

TEST(ElasticConstants, PlaneStressKeepsTheStressAcrossThePlaneAtZero) {
  for (const double nu : {0.0, 0.1, 0.3, 0.45, 0.5}) {
    const double young = 1234.0, sx = 7.0, sy = -3.0;
    const Eigen::Vector3d e = strains(young, nu, {sx, sy, 0.0});
    const Moduli m = moduli_of({young, nu}, Plane::stress);
    EXPECT_NEAR(m.lambda * (e[0] + e[1]) + 2.0 * m.mu * e[0], sx, 7.0 * rounding);
    EXPECT_NEAR(m.lambda * (e[0] + e[1]) + 2.0 * m.mu * e[1], sy, 7.0 * rounding);
  }
}

TEST(ElasticConstants, PlaneStressIsPlaneStrainWithTheStrainAcrossEliminated) {
  const Moduli strain = moduli_of({500.0, 0.37}, Plane::strain),
               stress = moduli_of({500.0, 0.37}, Plane::stress);
  EXPECT_DOUBLE_EQ(stress.mu, strain.mu);
  EXPECT_NEAR(stress.lambda, 2.0 * strain.lambda * strain.mu / (strain.lambda + 2.0 * strain.mu),
              rounding * strain.lambda);
}

TEST(ElasticConstants, GoThereAndBack) {
  for (const Plane plane : {Plane::strain, Plane::stress}) {
    for (const double nu : {0.0, 0.2, 0.49}) {
      const ElasticConstants back = elastic_constants_of(moduli_of({42.0, nu}, plane), plane);
      EXPECT_NEAR(back.young, 42.0, 42.0 * rounding);
      EXPECT_NEAR(back.poisson, nu, rounding);
    }
    const Moduli given{7.0, 5.0};
    const Moduli back = moduli_of(elastic_constants_of(given, plane), plane);
    EXPECT_NEAR(back.lambda, given.lambda, 100 * rounding);
    EXPECT_NEAR(back.mu, given.mu, 100 * rounding);
  }
}

TEST(ElasticConstants, AnInfiniteViscosityHasNoLambdaWherePoissonsRatioIsZero) {
  const Moduli m = moduli_of({INFINITY, 0.0}, Plane::strain);
  EXPECT_EQ(m.lambda, 0.0);
  EXPECT_EQ(m.mu, INFINITY);
}

}  // namespace
}  // namespace rheo
