// The rheological force by the edge form alone: F = J_lambda w_lambda + J_mu w_mu.
//
// Shapes   p: n x row (edge_form.hpp) in the kernel's order, force: n x 2 likewise; stiffness: 2n, mesh's
// order
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kernels/edge_form.hpp"
#include "kernels/edge_forms.hpp"
#include "kernels/edge_sweep.hpp"

namespace rheo {

class EdgeForce {
 public:
  EdgeForce(std::shared_ptr<const EdgeForm> form, SimdLevel level);

  const EdgeForm& form() const { return *form_; }
  SweepFunction sweep() const { return sweep_; }
  const EdgeFormsFunctions& forms() const { return forms_; }

  void apply(const double* p, double* force) const;

  // (lambda J_lambda + mu J_mu) x; where the branches are combined, for multiples of their moduli only
  void stiffness(double lambda, double mu, std::span<const double> x, std::span<double> out) const;

  // scale (x, y) times the boundary's part of F subtracted from out, for some of the corners; scale: n x 2.
  void subtract_boundary(double h, const double* scale, const double* p, double* out, std::size_t first,
                         std::size_t last) const;

 private:
  std::shared_ptr<const EdgeForm> form_;
  SweepFunction sweep_;
  EdgeFormsFunctions forms_;
  std::vector<double> zeros_, ones_;
  mutable std::vector<double> unused_, packed_, force_;
};

}  // namespace rheo
