#include "kernels/element_force.hpp"

#include <algorithm>

namespace rheo {

ElementForce::ElementForce(std::shared_ptr<const ElementForm> form, SimdLevel level)
    : form_(std::move(form)), sweep_(element_sweep(level)) {
  const auto s = static_cast<std::size_t>(form_->slots);
  packed_.assign(4 * s, 0.0);
  force_.assign(2 * s, 0.0);
}

void ElementForce::apply(const double* p, double* force) const {
  std::fill(force, force + 2 * static_cast<std::size_t>(form_->slots), 0.0);
  sweep_.add_forces(*form_, p, force, 0, static_cast<std::int64_t>(form_->offset.size()));
}

void ElementForce::stiffness(std::span<const Moduli> moduli, std::span<const double> x,
                             std::span<double> out) const {
  const auto s = static_cast<std::size_t>(form_->slots);
  const auto of_slot = [&](std::size_t k) {
    return 2 * static_cast<std::size_t>(form_->mesh_node[form_->slot_node[k]]);
  };
  for (std::size_t k = 0; k < s; ++k) {
    const double* u = x.data() + of_slot(k);
    const auto [lambda, mu] = moduli[static_cast<std::size_t>(form_->slot_region[k])];
    for (std::size_t axis = 0; axis < 2; ++axis) {
      packed_[4 * k + axis] = lambda * u[axis];
      packed_[4 * k + 2 + axis] = mu * u[axis];
    }
  }
  apply(packed_.data(), force_.data());
  std::fill(out.begin(), out.end(), 0.0);
  for (std::size_t k = 0; k < s; ++k) {
    out[of_slot(k)] += force_[2 * k];
    out[of_slot(k) + 1] += force_[2 * k + 1];
  }
}

}  // namespace rheo
