// Bessel functions against published values and identities, and the exponential integrator on small operators
// whose exponentials are known.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numeric>
#include <vector>

#include "chebyshev.hpp"
#include "rheo/integrator.hpp"

namespace rheo {
namespace {

std::vector<double> j(double z, std::size_t count) {
  std::vector<double> values(count);
  bessel_j(z, values);
  return values;
}

std::vector<double> i_scaled(double z, std::size_t count) {
  std::vector<double> values(count);
  bessel_i_scaled(z, values);
  return values;
}

TEST(Bessel, HasThePublishedValues) {
  // Abramowitz and Stegun, tables 9.1 and 9.4; a few roundings each.
  EXPECT_NEAR(j(1, 40)[0], 0.7651976865579666, 4e-16);
  EXPECT_NEAR(j(1, 40)[1], 0.4400505857449335, 4e-16);
  EXPECT_NEAR(j(10, 40)[0], -0.2459357644513483, 4e-16);
  EXPECT_NEAR(j(10, 40)[2], 0.2546303136851206, 4e-16);
  EXPECT_NEAR(j(100, 512)[0], 0.01998585030422312, 4e-16);
  EXPECT_NEAR(j(100, 512)[100], 0.09636667329586156, 4e-16);
  // Far beyond z relative accuracy stays: leading term of the series, (z/2)^k / k!.
  EXPECT_NEAR(j(1, 40)[30] / 3.482869794251483e-42, 1.0, 1e-13);
  EXPECT_NEAR(i_scaled(1, 40)[0], 1.266065877752008 * std::exp(-1.0), 4e-16);
  EXPECT_NEAR(i_scaled(1, 40)[1], 0.5651591039924850 * std::exp(-1.0), 4e-16);
  EXPECT_NEAR(i_scaled(10, 40)[0], 2815.716628466254 * std::exp(-10.0), 4e-16);
}

TEST(Bessel, AgreesWithTheStandardLibraryWhereThatIsAccurate) {
  for (double z : {1e-8, 0.3, 1.0, 2.5, 17.0, 60.0, 256.0}) {
    const std::vector<double> a = j(z, 300), b = i_scaled(z, 300);
    for (std::size_t k = 0; k < a.size(); k += 7) {
      // The library loses digits with z: about 1e-13 here, all of them from z = 1000 on.
      EXPECT_NEAR(a[k], std::cyl_bessel_j(static_cast<double>(k), z), 2e-13) << "J " << k << " at " << z;
      EXPECT_NEAR(b[k], std::cyl_bessel_i(static_cast<double>(k), z) * std::exp(-z), 1e-13) << k << ' ' << z;
    }
  }
}

TEST(Bessel, SquaresAddUpToOne) {
  for (double z : {0.0, 1e-3, 1.0, 30.0, 256.0}) {
    double sum = 0.0;
    const std::vector<double> values = j(z, 512);
    for (std::size_t k = 0; k < values.size(); ++k) sum += (k == 0 ? 1 : 2) * values[k] * values[k];
    EXPECT_NEAR(sum, 1.0, 1e-14);
  }
}

TEST(Bessel, OfZeroIsOneAndNothingElse) {
  EXPECT_EQ(j(0, 3), (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(i_scaled(0, 3), (std::vector<double>{1, 0, 0}));
}

// y' = A y + q(t), q a cubic with vector coefficients.
class Dense final : public LinearOperator {
 public:
  Dense(Eigen::MatrixXd a, Eigen::MatrixXd q) : a_(std::move(a)), q_(std::move(q)) {}
  std::size_t size() const override { return static_cast<std::size_t>(a_.rows()); }
  void fma(double h, std::span<const double> x, std::span<const double> base, const Forcing& f,
           std::span<double> out, Result) override {
    Eigen::VectorXd value = a_ * Eigen::Map<const Eigen::VectorXd>(x.data(), a_.rows());
    for (int order = 0; order < 4; ++order) value += f.weight[order] * derivative(f.t, order);
    for (std::size_t i = 0; i < size(); ++i) out[i] = base[i] + h * value[static_cast<Eigen::Index>(i)];
    ++evaluations;
  }
  int evaluations = 0;

 private:
  Eigen::VectorXd derivative(double t, int order) const {
    Eigen::VectorXd value = Eigen::VectorXd::Zero(a_.rows());
    for (int k = order; k < q_.cols(); ++k) {
      double factor = std::pow(t, k - order);
      for (int m = 0; m < order; ++m) factor *= k - m;
      value += factor * q_.col(k);
    }
    return value;
  }
  Eigen::MatrixXd a_, q_;
};

struct Box {
  double frequency, rate;
};

std::vector<double> run(Dense& op, Box box, double tolerance, double h, int steps, std::vector<double> y) {
  const auto integrator =
      make_integrator(IntegratorKind::exponential, op.size(), {box.frequency, box.rate, tolerance});
  for (int k = 0; k < steps; ++k) {
    integrator->step(op, k * h, h, y, {});
    EXPECT_TRUE(integrator->converged());
  }
  return y;
}

Eigen::MatrixXd oscillator(double omega, double decay) {  // exp(t A) = exp(-decay t) rotation(omega t)
  Eigen::Matrix2d a;
  a << -decay, omega, -omega, -decay;
  return a;
}

const Eigen::MatrixXd none(2, 0);

TEST(Exponential, TurnsAnUndampedOscillatorExactly) {
  for (double tolerance : {1e-6, 1e-9, 1e-12}) {
    for (double h : {1e-3, 0.1, 1.0, 50.0}) {
      Dense op(oscillator(7.0, 0.0), none);
      const auto y = run(op, {7.0, 0.0}, tolerance, h, 3, {1.0, 0.0});
      // Rounding: that of the angle, and of the sums.
      const double allowed = 3 * tolerance + 1e-15 * (1 + 21 * h);
      EXPECT_NEAR(y[0], std::cos(21 * h), allowed);
      EXPECT_NEAR(y[1], -std::sin(21 * h), allowed);
    }
  }
}

TEST(Exponential, HoldsADampedOscillatorAnywhereInTheBox) {
  for (double decay : {0.0, 0.4, 3.0, 40.0, 2000.0}) {
    for (double omega : {0.0, 1.0, 30.0}) {
      Dense op(oscillator(omega, decay), none);
      const auto y = run(op, {30.0, 2000.0}, 1e-12, 0.05, 4, {1.0, 0.5});
      const double e = std::exp(-decay * 0.2), c = std::cos(omega * 0.2), s = std::sin(omega * 0.2);
      EXPECT_NEAR(y[0], e * (c + 0.5 * s), 1e-11) << decay << ' ' << omega;
      EXPECT_NEAR(y[1], e * (0.5 * c - s), 1e-11) << decay << ' ' << omega;
    }
  }
}

TEST(Exponential, CostsAboutTheAngleAndAFewTens) {
  Dense op(oscillator(100.0, 0.0), none);
  run(op, {100.0, 0.0}, 1e-10, 1.0, 1, {1.0, 0.0});
  EXPECT_GE(op.evaluations, 100);
  EXPECT_LE(op.evaluations, 145);
}

TEST(Exponential, TakesTheRealAxisWhereRatesDominate) {
  // 1 s at rate 1e4: RK4's limit alone asks for 4 / 2.785e-4 evaluations.
  Dense op(oscillator(0.5, 1e4), none);
  const auto y = run(op, {0.5, 1e4}, 1e-10, 1.0, 1, {1.0, 0.0});
  EXPECT_NEAR(y[0], 0.0, 1e-10);
  EXPECT_LE(op.evaluations, 4 / 2.785e-4 / 8);
}

TEST(Exponential, IsExactForCubicForcing) {
  Eigen::Matrix<double, 2, 4> q;
  q << 1, -2, 0.5, 3, 0, 1, 4, -1;
  for (Box box : {Box{7.0, 0.0}, Box{7.0, 0.8}, Box{7.0, 900.0}}) {
    const double decay = 0.5 * std::min(box.rate, 0.8);
    Dense op(oscillator(7.0, decay), q);
    const auto y = run(op, box, 1e-12, 0.7, 3, {0.3, -0.2});
    // Particular solution: a cubic, from the highest power down.
    const Eigen::Matrix2d a = oscillator(7.0, decay);
    Eigen::Matrix<double, 2, 5> p = Eigen::Matrix<double, 2, 5>::Zero();
    for (int k = 3; k >= 0; --k) p.col(k) = a.inverse() * ((k + 1) * p.col(k + 1) - q.col(k));
    const double t = 2.1;
    const Eigen::Vector2d z0 = Eigen::Vector2d(0.3, -0.2) - p.col(0);
    Eigen::Matrix2d turn;
    turn << std::cos(7 * t), std::sin(7 * t), -std::sin(7 * t), std::cos(7 * t);
    Eigen::Vector2d expected = std::exp(-decay * t) * turn * z0;
    for (int k = 0; k < 4; ++k) expected += std::pow(t, k) * p.col(k);
    EXPECT_NEAR(y[0], expected[0], 1e-11 * expected.norm());
    EXPECT_NEAR(y[1], expected[1], 1e-11 * expected.norm());
  }
}

TEST(Exponential, NeedsNoFrequencyAtAll) {
  // u' = v, v' = 3 t^2: a box of zero size, nothing to scale by.
  Eigen::MatrixXd q(2, 3);
  q << 0, 0, 0, 0, 0, 3;
  Eigen::Matrix2d a;
  a << 0, 1, 0, 0;
  Dense op(a, q);
  const auto y = run(op, {0.0, 0.0}, 1e-13, 2.0, 1, {0.5, 1.0});
  EXPECT_NEAR(y[0], 0.5 + 2.0 + 4.0, 1e-12);
  EXPECT_NEAR(y[1], 1.0 + 8.0, 1e-12);
}

TEST(Exponential, FindsOutThatItsBoxIsTooSmall) {
  for (double understated : {0.99, 0.9, 0.5, 0.1}) {
    Dense op(oscillator(80.0, 0.0), none);
    const auto y = run(op, {80.0 * understated, 0.0}, 1e-12, 1.0, 4, {1.0, 0.0});
    EXPECT_NEAR(y[0], std::cos(320.0), 1e-10) << understated;
    EXPECT_NEAR(y[1], -std::sin(320.0), 1e-10) << understated;
  }
}

TEST(Exponential, SaysSoWhenNothingHelps) {
  Dense op(Eigen::MatrixXd::Constant(2, 2, std::nan("")), none);
  const auto integrator = make_integrator(IntegratorKind::exponential, 2, {1.0, 0.0, 1e-10});
  std::vector<double> y{1.0, 2.0};
  integrator->step(op, 0.0, 1.0, y, {});
  EXPECT_FALSE(integrator->converged());
  EXPECT_EQ(y, (std::vector<double>{1.0, 2.0}));
}

TEST(Exponential, UsesAKnownRateInsteadOfAnEvaluation) {
  for (double rate_bound : {0.0, 5.0}) {
    Dense op(oscillator(7.0, 0.5 * rate_bound), none);
    const auto integrator = make_integrator(IntegratorKind::exponential, 2, {7.0, rate_bound, 1e-12});
    std::vector<double> y{1.0, 0.25}, z = y;
    const Eigen::Vector2d rate = oscillator(7.0, 0.5 * rate_bound) * Eigen::Vector2d(1.0, 0.25);
    integrator->step(op, 0.0, 0.3, y, {});
    const int without = op.evaluations;
    integrator->step(op, 0.0, 0.3, z, std::span(rate.data(), 2));
    EXPECT_EQ(op.evaluations - without, without - 1);
    EXPECT_NEAR(z[0], y[0], 1e-15);
    EXPECT_NEAR(z[1], y[1], 1e-15);
  }
}

}  // namespace
}  // namespace rheo
