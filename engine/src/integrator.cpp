#include "rheo/integrator.hpp"

#include <algorithm>
#include <cassert>

#include "aligned_vector.hpp"
#include "exponential.hpp"
#include "implicit.hpp"

namespace rheo {
namespace {

// Explicit Euler: y + h (A y + g).
class Euler final : public Integrator {
 public:
  void step(LinearOperator& op, double t, double h, std::span<double> y,
            std::span<const double> rate) override {
    if (!rate.empty()) {
      for (std::size_t i = 0; i < y.size(); ++i) y[i] += h * rate[i];
      return;
    }
    op.fma(h, y, y, {t, {1.0, 0.0, 0.0, 0.0}}, next_, Result::step);
    std::copy(next_.begin(), next_.end(), y.begin());
  }
  std::string_view name() const override { return "euler"; }
  int order() const override { return 1; }
  int evaluations_per_step() const override { return 1; }

  explicit Euler(std::size_t size) : next_(size) {}

 private:
  std::vector<double> next_;
};

// The classical Runge-Kutta method
//
//    0  |
//   1/2 | 1/2
//   1/2 |  0  1/2
//    1  |  0   0   1
//   ----+----------------
//       | 1/6 1/3 1/3 1/6
//
// on a linear system is the Taylor polynomial of the flow, here in Horner form: two buffers, no k1..k4,
//
//   y + h (A . + G1) (y + h/2 (A . + G2) (y + h/3 (A . + G3) (y + h/4 (A y + G4))))
//   G4 = g, G3 = g + h g'/4, G2 = g + h g'/3 + h^2 g''/12, G1 = g + h g'/2 + h^2 g''/6 + h^3 g'''/24
//
// (g at shifted times, as in the tableau, would lose the order in this form.)
class Rk4 final : public Integrator {
 public:
  void step(LinearOperator& op, double t, double h, std::span<double> y,
            std::span<const double> rate) override {
    assert(y.size() == a_.size());
    const std::array<LinearOperator::Sweep, 4> sweeps{{
        {h / 4, y, y, {t, {1.0, 0.0, 0.0, 0.0}}, a_, Result::intermediate},
        {h / 3, a_, y, {t, {1.0, h / 4, 0.0, 0.0}}, b_, Result::intermediate},
        {h / 2, b_, y, {t, {1.0, h / 3, h * h / 12, 0.0}}, a_, Result::intermediate},
        {h, a_, y, {t, {1.0, h / 2, h * h / 6, h * h * h / 24}}, y, Result::step},
    }};
    if (rate.empty()) {
      op.chain(sweeps);
    } else {
      for (std::size_t i = 0; i < y.size(); ++i) a_[i] = y[i] + h / 4 * rate[i];
      op.chain(std::span(sweeps).subspan(1));
    }
  }
  std::string_view name() const override { return "rk4"; }
  int order() const override { return 4; }
  int evaluations_per_step() const override { return 4; }

  explicit Rk4(std::size_t size) : a_(size), b_(size) {}

 private:
  AlignedVector a_, b_;
};

}  // namespace

std::unique_ptr<Integrator> make_integrator(IntegratorKind kind, std::size_t size,
                                            const IntegratorSettings& settings) {
  switch (kind) {
    case IntegratorKind::euler:
      return std::make_unique<Euler>(size);
    case IntegratorKind::exponential:
      return std::make_unique<Exponential>(size, settings);
    case IntegratorKind::implicit:
      return std::make_unique<Implicit>(size, settings.time);
    case IntegratorKind::automatic:
    case IntegratorKind::rk4:
      break;
  }
  return std::make_unique<Rk4>(size);
}

}  // namespace rheo
