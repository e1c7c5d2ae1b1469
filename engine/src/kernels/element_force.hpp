// The rheological force by triangles alone: F = J_lambda w_lambda + J_mu w_mu.
//
// Shapes   p: s x 4 (l_x, l_y, m_x, m_y) and force: s x 2 in the kernel's order of slots; x, out: 2n, mesh's
//          order
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kernels/element_form.hpp"
#include "kernels/element_sweep.hpp"

namespace rheo {

class ElementForce {
 public:
  ElementForce(std::shared_ptr<const ElementForm> form, SimdLevel level);

  const ElementForm& form() const { return *form_; }
  const ElementSweep& sweep() const { return sweep_; }

  // By slot: the sum over a node's slots is the force on it.
  void apply(const double* p, double* force) const;

  // sum over the regions of (lambda J_lambda + mu J_mu) x; moduli by region.
  void stiffness(std::span<const Moduli> moduli, std::span<const double> x, std::span<double> out) const;

 private:
  std::shared_ptr<const ElementForm> form_;
  ElementSweep sweep_;
  mutable std::vector<double> packed_, force_;
};

}  // namespace rheo
