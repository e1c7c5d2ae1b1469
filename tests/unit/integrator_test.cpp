// The integrators on scalar equations, apart from any physics.

#include <gtest/gtest.h>

#include <cmath>

#include "rheo/integrator.hpp"

namespace rheo {
namespace {

// y' = s y + g(t) with g(t) = exp(a t), for one real s; or as a rotation by two numbers.
class Scalar final : public LinearOperator {
 public:
  Scalar(double s, double a) : s_(s), a_(a) {}
  std::size_t size() const override { return 1; }
  void fma(double h, std::span<const double> x, std::span<const double> base, const Forcing& f,
           std::span<double> out, Result) override {
    double g = 0.0;
    for (int k = 0; k < 4; ++k) g += f.weight[k] * std::pow(a_, k) * std::exp(a_ * f.t);
    out[0] = base[0] + h * (s_ * x[0] + g);
    ++evaluations;
  }
  double exact(double t) const {
    return std::exp(s_ * t) + (std::exp(a_ * t) - std::exp(s_ * t)) / (a_ - s_);
  }
  int evaluations = 0;

 private:
  double s_, a_;
};

double error_at(IntegratorKind kind, int steps) {
  Scalar op(-1.3, 0.7);
  const auto integrator = make_integrator(kind, 1);
  std::vector<double> y{1.0};
  const double h = 2.0 / steps;
  for (int k = 0; k < steps; ++k) integrator->step(op, k * h, h, y, {});
  EXPECT_EQ(op.evaluations, steps * integrator->evaluations_per_step());
  return std::abs(y[0] - op.exact(2.0));
}

// Over five halvings, from where the leading term rules to where rounding is far below it.
void expect_order(IntegratorKind kind, double order) {
  EXPECT_NEAR(std::log2(error_at(kind, 20) / error_at(kind, 640)) / 5, order, 0.1);
}

TEST(Rk4, HasOrderFourWithForcing) {
  expect_order(IntegratorKind::rk4, 4.0);
}
TEST(Euler, HasOrderOneWithForcing) {
  expect_order(IntegratorKind::euler, 1.0);
}

TEST(Rk4, IsTheTaylorPolynomialOfTheFlow) {
  class Pure final : public LinearOperator {
   public:
    std::size_t size() const override { return 1; }
    void fma(double h, std::span<const double> x, std::span<const double> base, const Forcing&,
             std::span<double> out, Result) override {
      out[0] = base[0] + h * x[0];
    }
  } op;
  const auto integrator = make_integrator(IntegratorKind::rk4, 1);
  std::vector<double> y{1.0};
  integrator->step(op, 0.0, 0.5, y, {});
  EXPECT_DOUBLE_EQ(y[0], 1 + 0.5 + 0.25 / 2 + 0.125 / 6 + 0.0625 / 24);
}

TEST(Rk4, IsExactForCubicForcing) {
  // y' = t^3: the Taylor form with g, g', g'', g''' leaves nothing out.
  class Cubic final : public LinearOperator {
   public:
    std::size_t size() const override { return 1; }
    void fma(double h, std::span<const double>, std::span<const double> base, const Forcing& f,
             std::span<double> out, Result) override {
      const double t = f.t;
      out[0] = base[0] + h * (f.weight[0] * t * t * t + f.weight[1] * 3 * t * t + f.weight[2] * 6 * t +
                              f.weight[3] * 6);
    }
  } op;
  const auto integrator = make_integrator(IntegratorKind::rk4, 1);
  std::vector<double> y{0.0};
  for (int k = 0; k < 4; ++k) integrator->step(op, 0.5 * k, 0.5, y, {});
  EXPECT_NEAR(y[0], 4.0, 1e-15 * 4 * 4);  // four roundings
}

TEST(Integrators, UseAKnownRateInsteadOfAnEvaluation) {
  for (IntegratorKind kind : {IntegratorKind::rk4, IntegratorKind::euler}) {
    Scalar op(-1.3, 0.7);
    const auto integrator = make_integrator(kind, 1);
    std::vector<double> y{1.0}, z{1.0};
    const std::vector<double> rate{-1.3 * 1.0 + std::exp(0.7 * 0.25)};
    integrator->step(op, 0.25, 0.1, y, {});
    const int without = op.evaluations;
    integrator->step(op, 0.25, 0.1, z, rate);
    EXPECT_EQ(op.evaluations - without, without - 1);
    EXPECT_NEAR(z[0], y[0], 4e-16);
  }
}

}  // namespace
}  // namespace rheo
