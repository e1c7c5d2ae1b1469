#include "rheo/relaxation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace rheo {
namespace {

Material rich() {
  Material m{.lambda_ela = 7.0, .mu_ela = 5.0, .lambda_vis = 4.0, .mu_vis = 2.0, .density = 1.0};
  m.more_branches = {{3.0, 0.0, 60.0, 1.0}, {0.0, 2.0, INFINITY, INFINITY}};
  m.elastic = {1.5, 0.25};
  m.viscous = {0.1, 0.0};
  return m;
}

TEST(Relaxation, IsTheSumOfDecayingBranchesAndTheElasticPart) {
  const Material m = rich();
  for (const double t : {0.0, 0.3, 5.0, 100.0}) {
    const Moduli r = relaxation(m, t);
    EXPECT_DOUBLE_EQ(r.lambda, 7.0 * std::exp(-7.0 / 4.0 * t) + 3.0 * std::exp(-t / 20.0) + 1.5);
    EXPECT_DOUBLE_EQ(r.mu, 5.0 * std::exp(-5.0 / 2.0 * t) + 2.0 + 0.25);
  }
}

// G*(omega) = i omega times the Laplace transform of r at i omega: sum ela i omega / (i omega + rate).
TEST(Relaxation, ComplexModuliAreItsTransform) {
  const Material m = rich();
  for (const double omega : {1e-3, 0.2, 1.0, 40.0, 1e6}) {
    const std::complex<double> s(0.0, omega);
    const std::complex<double> lambda =
        7.0 * s / (s + 7.0 / 4.0) + 3.0 * s / (s + 1.0 / 20.0) + 1.5 + 0.1 * s;
    const std::complex<double> mu = 5.0 * s / (s + 5.0 / 2.0) + 2.0 + 0.25;
    const ComplexModuli g = complex_moduli(m, omega);
    const double rounding = 1e-14;
    EXPECT_NEAR(g.storage.lambda, lambda.real(), rounding * std::abs(lambda));
    EXPECT_NEAR(g.loss.lambda, lambda.imag(), rounding * std::abs(lambda));
    EXPECT_NEAR(g.storage.mu, mu.real(), rounding * std::abs(mu));
    EXPECT_NEAR(g.loss.mu, mu.imag(), rounding * std::abs(mu));
  }
}

TEST(Relaxation, ComplexModuliAreNumbersAtAllFrequencies) {
  const Material m = rich();
  for (const double omega : {0.0, 1e-200, 1e200}) {
    const ComplexModuli g = complex_moduli(m, omega);
    for (const double value : {g.storage.lambda, g.storage.mu, g.loss.lambda, g.loss.mu})
      EXPECT_TRUE(std::isfinite(value) && value >= 0.0) << value << " at " << omega;
  }
  EXPECT_DOUBLE_EQ(complex_moduli(m, 0.0).storage.mu, 2.25);
  EXPECT_DOUBLE_EQ(complex_moduli(m, 1e200).storage.lambda, 11.5);
}

TEST(Relaxation, TimesSpanTheBranchesThatRelax) {
  const auto span = relaxation_times(rich());
  ASSERT_TRUE(span);
  EXPECT_DOUBLE_EQ(span->shortest, 2.0 / 5.0);
  EXPECT_DOUBLE_EQ(span->longest, 20.0);
  EXPECT_FALSE(relaxation_times(Material{.lambda_ela = 1.0, .mu_ela = 1.0, .density = 1.0}));
}

}  // namespace
}  // namespace rheo
