// An L-stable method of order 8 with a single real pole: eight solves a step with one factor, whatever the
// stiffness.
//
//   y(t + h) = R(h A) y,   R(z) = 1 + sum over k = 1..8 of d_k D(z)^k,   D(z) = gamma z / (1 - gamma z)
//   d_k = (-1)^k L_k^(-1)(1 / gamma)
//
// exp(z) is this series without end (the generating function of Laguerre's polynomials), so eight terms give
// order 8 for any gamma. R(-infinity) = L_8(1 / gamma): gamma = 0.23437... makes it 0, and |R| <= 1 on the
// left half plane. Of the methods with one real pole and order = solves that are L-stable (2 to 6 and 8
// solves exist) this one has the smallest error for the same number of solves at every size of the error.
//
// D y = s A (1 - s A)^-1 y, s = gamma h, is an increment: short steps lose no digits. s is taken to 24 bits,
// as a part of a time that comes with the scene, and the d_k are made for gamma = s / h, so that steps whose
// lengths differ by rounding share a factor; R(-infinity) is then some 1e-6 at most instead of 0.
//
// Forcing that is a polynomial in time of degree 5 at most joins the state: c_0' = 0, c_k' = c_{k-1}, c_k(0)
// = [k = 0], y' = A y + sum c_k g^(k)(t). A motion that is a polynomial in time of degree 8 at most is
// followed exactly, however stiff: there is no loss of order.
//
// Source   Hairer and Wanner, Solving Ordinary Differential Equations II, IV.6 (restricted Pade
// approximations,
//          table 6.4); Norsett, 1974; increments: design
// Errors   converged() is false where the operator has no factor for s; y stays as it was then
// Not here an error estimate: the step is the caller's choice
#pragma once

#include <array>
#include <vector>

#include "rheo/integrator.hpp"

namespace rheo {

class Implicit final : public Integrator {
 public:
  static constexpr int stages = 8;
  static constexpr double gamma = 0.2343731596055835579475589;  // 1 / gamma: a zero of Laguerre's L_8

  // time: [s], of the scene's own; in other units of time all else is the same.
  explicit Implicit(std::size_t size, double time = 1.0) : time_(time), increment_(size), next_(size) {}

  void step(LinearOperator& op, double t, double h, std::span<double> y,
            std::span<const double> rate) override;
  bool converged() const override { return converged_; }
  std::string_view name() const override { return "implicit"; }
  int order() const override { return stages; }
  int evaluations_per_step() const override { return stages; }

  // d_1 .. d_8 for x = 1 / gamma.
  static std::array<double, stages> weights(double x);
  // gamma h to 24 bits of its part of `time`.
  static double shift_of(double h, double time);

 private:
  double time_;
  std::array<double, stages> weights_{};
  double weights_for_ = 0.0;
  std::vector<double> increment_, next_;
  bool converged_ = true;
};

}  // namespace rheo
