// y(t + H) = exp(H A) y + forcing by a Chebyshev expansion, to a tolerance instead of an order.
//
//   exp(H A) y = exp(-H s) exp(H B) y,   B = A + s,
//   imaginary interval:  exp(H B) = J_0(z) V_0 + 2 sum J_k(z) V_k,         V_{k+1} =  (2 / R) B V_k + V_{k-1}
//   real interval:       exp(H B) = I_0(z) V_0 + 2 sum +- I_k(z) V_k,      V_{k+1} = +-(2 / R) B V_k +
//   V_{k-1} z = R H,  V_0 = y,  V_1 = B V_0 / R
//
// The spectrum of A lies in the box -rate <= Re <= 0, |Im| <= frequency (integrator.hpp). Imaginary: R >=
// frequency, s = rate / 2, or 0 where rate H is small; about R H evaluations and some twenty more. Real: R >=
// rate / 2 = s, where rates dominate; about sqrt(2 R H ln(1 / tolerance)). The box's other half width
// times H stays below 2 so that terms do not grow beyond the sum: longer steps are taken in equal parts.
//
// Forcing that is a cubic in time between events joins the state: c_0' = 0, c_k' = c_{k-1}, c_k(0) = [k = 0],
// y' = A y + sum c_k g^(k)(t).
//
// How many terms: from what the remaining coefficients can add at most, given the size of the last two V_k,
// part by part of the state (LinearOperator::parts), relative to that part's largest size so far. Where the
// terms outgrow the sum (the box was too small) the part of the step is done again with a wider box and a
// shorter step.
//
// Source   Tal-Ezer, 1989 (imaginary and real intervals); Bergamaschi and Vianello, 2000 (real)
// Shapes   scale_, peak_, rest_, ... sum_scale_: one a part of the state
// Errors   converged() is false where that does not help: y stays at the last part of the step that was well
// Not here constraints by Baumgarte (their forcing is not a cubic)
#pragma once

#include <array>
#include <vector>

#include "aligned_vector.hpp"
#include "rheo/integrator.hpp"

namespace rheo {

class Exponential final : public Integrator {
 public:
  Exponential(std::size_t size, const IntegratorSettings& settings);

  void step(LinearOperator& op, double t, double h, std::span<double> y,
            std::span<const double> rate) override;
  bool converged() const override { return converged_; }
  // The box as wide as it has become, the shortening, the sizes so far: plans follow from these.
  std::vector<double> memory() const override;
  void remember(std::span<const double> memory) override;
  std::string_view name() const override { return "exponential"; }

  // Evaluations that a step of h takes where its terms do not grow.
  double forecast(double h);

 private:
  enum class Axis { imaginary, real };

  // How a step of a given length is done: in equal parts, each by one sum.
  struct Plan {
    int parts = 1;
    Axis axis = Axis::imaginary;
    double radius = 0.0;         // R
    double shift = 0.0;          // s
    double growth = 1.0;         // of |V_k| from k to k + 1 at most, in the box's middle
    double tolerance = 0.0;      // of one part
    std::size_t first_look = 1;  // k from which the remainder may be small enough
    std::size_t last_look = 1;   // k at which it is, if all terms grow as they may
  };

  // The cheaper axis for a step of h, its coefficients and remainders; nothing where it is that of the step
  // before.
  void make_plan(double h);
  Plan plan_along(Axis axis, double h, int parts);
  // y -> y(t + h) in sum_; false where the terms do not settle.
  bool expand(LinearOperator& op, double t, double h, std::span<const double> y,
              std::span<const double> rate);
  // V_{k+1} into `before`, which holds V_{k-1}.
  void advance(LinearOperator& op, double t, double h, std::size_t k, std::span<const double> v,
               std::span<double> before);
  enum class Outcome { more, done, lost };
  // Of the sum up to V_k, given the sizes of V_k and V_{k-1}.
  Outcome judge(std::span<const StatePart> parts, std::size_t k);
  // From which k on the remainder may be small enough, given the sizes of V_1 and V_0.
  std::size_t first_look(std::span<const StatePart> parts) const;
  static void measure(std::span<const StatePart> parts, std::span<const double> x,
                      std::vector<double>& sizes);
  static void include(double factor, const std::vector<double>& sizes, std::vector<double>& largest);

  IntegratorSettings settings_;
  Plan plan_;
  double planned_for_ = 0.0;
  double shortening_ = 1.0;                 // of the longest part, after a failure
  std::vector<double> coefficients_;        // of V_k, signs and exp(-H s) included
  std::vector<double> remainders_;          // sum over j >= k of |coefficient_j| growth^(j - k)
  AlignedVector a_, b_, sum_;               // V_k for odd and even k, the sum so far
  std::array<double, 4> c_{}, c_before_{};  // of V_k and V_{k-1}: c_j / H^j
  std::vector<double> scale_;               // size of y so far
  std::vector<double> peak_;                // of the terms of this sum
  std::vector<double> rest_;                // of what is left out
  std::vector<double> size_, size_before_;  // of V_k, V_{k-1}
  std::vector<double> sum_size_, sum_scale_;
  bool converged_ = true;
};

}  // namespace rheo
