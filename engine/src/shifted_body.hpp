// The assembled body with the solves that an implicit integrator needs.
//
//   (1 - s A) d = s (A x + g): with, for either modulus,
//   p = sum over the branches of (w + s ela v) / (1 + s rate) + elastic (u + s v) + viscous v
//   S d_v = s (f - J_lambda p_lambda - J_mu p_mu)          S: shifted_system.hpp
//   d_u = s (v + d_v),   d_w = s (ela (v + d_v) - rate w) / (1 + s rate)
//   d_v = s b'' where a degree of freedom is eliminated, its part of p and of M d_v on the right side
//   A^T d_v = s (b'' + 2 omega b' + omega^2 b - (2 omega + omega^2 s) A^T v - omega^2 A^T u) / (1 + omega
//   s)^2
//
// Source   Hirai and Tomokuni, eq. (4); elimination of u, w_lambda and w_mu: design
// Shapes   x, d: Layout
// Errors   prepare_shifted: false where the factor has not enough correct digits
#pragma once

#include "assembled_body.hpp"
#include "shifted_system.hpp"

namespace rheo {

class ShiftedBody final : public AssembledBody {
 public:
  ShiftedBody(const Model& model, double omega);

  std::size_t factor_bytes() const override { return system_.factor_bytes(); }
  bool solves_shifted() const override { return true; }
  bool prepare_shifted(double s) override;
  void solve_shifted(double s, std::span<const double> x, const Forcing& forcing,
                     std::span<double> out) override;

 private:
  // Of a constraint, from x alone: A^T d_v.
  double column_increment(double s, std::size_t column, std::span<const double> x,
                          const Forcing& forcing) const;

  // p of the increments that are told, by region.
  void find_pull(double s, std::span<const double> x);

  ShiftedSystem system_;
  Vector increment_, right_, product_, target_;
  std::vector<std::vector<double>> pull_;  // p, by region, 4 a node
};

}  // namespace rheo
