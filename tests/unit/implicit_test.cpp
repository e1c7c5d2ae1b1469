// The implicit integrator on scalar and small dense equations: its order, its stability, its stiff behaviour.

#include "implicit.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "rheo/stability.hpp"

namespace rheo {
namespace {

using Complex = std::complex<double>;

// R(z) from the integrator's own weights, for a shift of `gamma` times the step.
Complex growth(Complex z, double gamma) {
  const auto d = Implicit::weights(1.0 / gamma);
  const Complex increment = gamma * z / (1.0 - gamma * z);
  Complex sum = 0.0;
  for (int k = Implicit::stages; k-- > 0;) sum = increment * (d[k] + sum);
  return 1.0 + sum;
}

// y' = A y + sum over k of q_k t^k.
class Dense final : public LinearOperator {
 public:
  Dense(Eigen::MatrixXd a, Eigen::MatrixXd q) : a_(std::move(a)), q_(std::move(q)) {}
  std::size_t size() const override { return static_cast<std::size_t>(a_.rows()); }
  void fma(double, std::span<const double>, std::span<const double>, const Forcing&, std::span<double>,
           Result) override {
    ADD_FAILURE() << "no products with A alone";
  }
  bool solves_shifted() const override { return true; }
  bool prepare_shifted(double s) override {
    if (refuses) return false;
    ++prepared;
    prepared_for = s;
    return true;
  }
  void solve_shifted(double s, std::span<const double> x, const Forcing& f, std::span<double> out) override {
    EXPECT_EQ(s, prepared_for);
    Eigen::VectorXd right = a_ * Eigen::Map<const Eigen::VectorXd>(x.data(), a_.rows());
    for (int order = 0; order < 6; ++order) right += f.weight[order] * derivative(f.t, order);
    const Eigen::MatrixXd shifted = Eigen::MatrixXd::Identity(a_.rows(), a_.rows()) - s * a_;
    Eigen::Map<Eigen::VectorXd>(out.data(), a_.rows()) = shifted.partialPivLu().solve(s * right);
    ++solves;
  }
  int prepared = 0, solves = 0;
  double prepared_for = 0.0;
  bool refuses = false;

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

std::vector<double> run(Dense& op, double end, int steps, std::vector<double> y) {
  const auto integrator = make_integrator(IntegratorKind::implicit, op.size());
  for (int k = 0; k < steps; ++k) {
    integrator->step(op, end * k / steps, end / steps, y, {});
    EXPECT_TRUE(integrator->converged());
  }
  EXPECT_EQ(op.solves, steps * integrator->evaluations_per_step());
  return y;
}

TEST(Implicit, GammaIsAZeroOfLaguerresPolynomialOfDegreeEight) {
  // L_8(x) = sum over k of C(8, k) (-x)^k / k!, the terms up to 35.
  const long double x = 1.0L / Implicit::gamma;
  long double sum = 0.0L, term = 1.0L;
  for (int k = 0; k <= 8; ++k) {
    sum += term;
    term *= -x * (8 - k) / ((k + 1.0L) * (k + 1.0L));
  }
  EXPECT_NEAR(static_cast<double>(sum), 0.0, 1e-14);
}

TEST(Implicit, AgreesWithTheExponentialToTheEighthPowerAndNoFurther) {
  // Taylor's coefficients by Cauchy's integral on the unit circle; the pole lies at 4 and beyond.
  constexpr int points = 64;
  for (const double gamma : {Implicit::gamma, 0.22, 0.25}) {
    double factorial = 1.0;
    for (int k = 0; k <= 9; ++k) {
      Complex sum = 0.0;
      for (int m = 0; m < points; ++m) {
        const double angle = 2 * std::numbers::pi * m / points;
        sum += growth(std::polar(1.0, angle), gamma) * std::polar(1.0, -k * angle);
      }
      const double difference = std::abs(sum / double{points} - 1.0 / factorial);
      if (k <= 8) {
        EXPECT_LE(difference, 2e-15) << gamma << " " << k;
      } else {
        EXPECT_GE(difference, 1e-8) << gamma;
      }
      factorial *= k + 1;
    }
  }
}

TEST(Implicit, IsStableOnTheWholeLeftHalfPlane) {
  // By the maximum principle the imaginary axis decides. Near 0 the damping is less than rounding.
  for (const double gamma : {Implicit::gamma, Implicit::gamma * (1 + 1e-7), Implicit::gamma * (1 - 1e-7)}) {
    for (int k = 0; k <= 20000; ++k) {
      const double y = std::pow(10.0, -3.0 + 12.0 * k / 20000);
      ASSERT_LE(std::abs(growth({0.0, y}, gamma)), 1.0 + 4e-15) << y;
    }
  }
  EXPECT_EQ(stable_step_of({-3.0, 400.0}, IntegratorKind::implicit), std::numeric_limits<double>::infinity());
}

TEST(Implicit, ForgetsWhatIsInfinitelyStiff) {
  for (const double z : {1e4, 1e8, 1e15}) {
    EXPECT_LE(std::abs(growth({-z, 0.0}, Implicit::gamma)), 200.0 / z + 1e-14) << z;
    EXPECT_LE(std::abs(growth({0.0, z}, Implicit::gamma)), 200.0 / z + 1e-14) << z;
  }
}

TEST(Implicit, HasOrderEightWithForcing) {
  // A damped oscillator under a force of degree 5, whose polynomial solution is added to a free swing.
  Eigen::MatrixXd a(2, 2);
  a << -0.3, 5.0, -5.0, -0.3;
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(2, 6);
  q.row(0) << 1, -2, 0.5, 3, -1, 0.25;
  // The particular solution p' = A p + q, p of degree 5: p_k = A^-1 ((k + 1) p_{k+1} - q_k).
  Eigen::MatrixXd p = Eigen::MatrixXd::Zero(2, 7);
  for (int k = 5; k >= 0; --k) p.col(k) = a.inverse() * ((k + 1) * p.col(k + 1) - q.col(k));
  const auto exact = [&](double t) {
    Eigen::Vector2d y = Eigen::Vector2d::Zero();
    for (int k = 5; k >= 0; --k) y = y * t + p.col(k);
    const double decay = std::exp(-0.3 * t);
    return Eigen::Vector2d(y + decay * Eigen::Vector2d(std::cos(5 * t), -std::sin(5 * t)));
  };
  const auto error_at = [&](int steps) {
    Dense op(a, q);
    const Eigen::Vector2d start = exact(0.0);
    const auto y = run(op, 2.0, steps, {start[0], start[1]});
    return (Eigen::Vector2d(y[0], y[1]) - exact(2.0)).norm();
  };
  // Two halvings: above the leading term does not rule yet, below rounding (1e-15) does.
  EXPECT_NEAR(std::log2(error_at(24) / error_at(96)) / 2, 8.0, 0.1) << error_at(24) << " " << error_at(96);
}

TEST(Implicit, FollowsAPolynomialExactlyHoweverStiffTheEquation) {
  // y' = s (y - p(t)) + p'(t), y(0) = p(0), p of degree 5: y = p. No loss of order.
  for (const double s : {-1.0, -1e5, -1e9, -1e14}) {
    const std::vector<double> p{0.5, -1, 2, 0.25, -3, 1};
    Eigen::MatrixXd q(1, 6);
    for (int k = 0; k < 6; ++k) q(0, k) = -s * p[k] + (k < 5 ? (k + 1) * p[k + 1] : 0.0);
    Dense op(Eigen::MatrixXd::Constant(1, 1, s), q);
    const auto y = run(op, 1.5, 6, {p[0]});
    double value = 0.0;
    for (int k = 5; k >= 0; --k) value = value * 1.5 + p[k];
    // Terms of p up to 20 that cancel.
    EXPECT_NEAR(y[0], value, 1e-13) << s;
  }
}

TEST(Implicit, LosesNoDigitsInShortSteps) {
  // 20,000 steps of a slow oscillator: the error is that of the roundings of the additions, sqrt(steps) of
  // them.
  Eigen::MatrixXd a(2, 2);
  a << 0, 1, -1, 0;
  const double turn = std::numbers::pi / 2;
  Dense op(a, Eigen::MatrixXd::Zero(2, 1));
  const int steps = 20000;
  const auto y = run(op, turn, steps, {1.0, 0.0});
  EXPECT_NEAR(y[0], 0.0, 1e-13);
  EXPECT_NEAR(y[1], -1.0, 1e-13);
}

TEST(Implicit, StepsThatDifferByRoundingShareAShift) {
  for (const double h : {1.0 / 60, 3e-7, 1e5, 1e-29, 0.1234}) {
    for (const double time : {1.0, 1.0 / 60, 1e3}) {
      const double s = Implicit::shift_of(h, time);
      EXPECT_EQ(s, Implicit::shift_of(h * (1 + 1e-13), time));
      EXPECT_NEAR(s / (Implicit::gamma * h), 1.0, 1.2e-7);
      // In other units of time it is the same.
      EXPECT_NEAR(Implicit::shift_of(h / 3600, time / 3600) * 3600, s, 1e-14 * s);
    }
  }
}

TEST(Implicit, LeavesTheStateAloneWhereNothingCanBeSolved) {
  Dense op(Eigen::MatrixXd::Constant(1, 1, -1.0), Eigen::MatrixXd::Zero(1, 1));
  op.refuses = true;
  const auto integrator = make_integrator(IntegratorKind::implicit, 1);
  std::vector<double> y{1.0};
  integrator->step(op, 0.0, 0.1, y, {});
  EXPECT_FALSE(integrator->converged());
  EXPECT_EQ(y[0], 1.0);
  op.refuses = false;
  integrator->step(op, 0.0, 0.1, y, {});
  EXPECT_TRUE(integrator->converged());
  EXPECT_NEAR(y[0], std::exp(-0.1), 1e-14);  // the error of the method: 2e-15
}

}  // namespace
}  // namespace rheo
