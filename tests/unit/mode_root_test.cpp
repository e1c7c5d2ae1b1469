#include "mode_root.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

namespace rheo::test {
namespace {

using Complex = std::complex<double>;

// One spring k of rate r: s^2 + r s + k = 0.
Complex of_one_spring(double k, double r) {
  return {-0.5 * r, std::sqrt(k - 0.25 * r * r)};
}

TEST(ModeRoot, KeepsTheDampingThatAGeneralSolverLoses) {
  for (const double r : {1e-13, 1e-10, 1e-5, 0.1}) {
    const double k = 2.0;
    const Complex exact = of_one_spring(k, r);
    // Off by what rounding does to all that is as large as the frequency.
    const Complex found =
        sharpened_root(exact + Complex(3e-16, -2e-16), std::vector<ModeSpring>{{k, r}}, 0.0);
    EXPECT_NEAR(found.real(), exact.real(), 1e-9 * r) << r;
    EXPECT_NEAR(found.imag(), exact.imag(), 1e-14) << r;
  }
}

TEST(ModeRoot, SharesAndDashpotsAddUp) {
  // Springs of one rate count as their sum; an elastic spring with a dashpot d: s^2 + d s + k = 0.
  const std::vector<ModeSpring> split{{0.5, 1e-9}, {1.5, 1e-9}};
  EXPECT_NEAR(sharpened_root(of_one_spring(2.0, 1e-9) + Complex(1e-15, 0.0), split, 0.0).real(), -0.5e-9,
              1e-17);
  const std::vector<ModeSpring> elastic{{2.0, 0.0}};
  EXPECT_NEAR(sharpened_root(Complex(1e-15, std::sqrt(2.0)), elastic, 1e-8).real(), -0.5e-8, 1e-16);
}

TEST(ModeRoot, RealRootsAndOnesThatAreNoRootStayAsTheyAre) {
  const std::vector<ModeSpring> overdamped{{1.0, 4.0}};
  const double exact = -2.0 + std::sqrt(3.0);
  EXPECT_EQ(sharpened_root({exact, 0.0}, overdamped, 0.0), Complex(exact, 0.0));
  const Complex far(-0.3, 70.0);
  EXPECT_EQ(sharpened_root(far, {}, 0.0), far);
  EXPECT_EQ(sharpened_root({1e-17, 0.0}, overdamped, 0.0).real(), 0.0) << "never a growing one";
}

}  // namespace
}  // namespace rheo::test
