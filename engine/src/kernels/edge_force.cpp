#include "kernels/edge_force.hpp"

#include <array>
#include <cassert>
#include <cmath>

namespace rheo {

EdgeForce::EdgeForce(std::shared_ptr<const EdgeForm> form, SimdLevel level)
    : form_(std::move(form)),
      sweep_(sweep_function(level, *form_)),
      forms_(edge_forms_functions(level, *form_)) {
  const auto n = static_cast<std::size_t>(form_->nodes);
  zeros_.assign(4 * n, 0.0);
  unused_ = zeros_;
  packed_ = zeros_;
  ones_.assign(2 * n, 1.0);
  force_.assign(2 * n, 0.0);
}

void EdgeForce::apply(const double* p, double* force) const {
  // A sweep with unit masses, no material and h = -1 leaves F alone in the velocities.
  const SweepArrays arrays{p,     zeros_.data(), zeros_.data(), zeros_.data(), unused_.data(),
                           force, nullptr,       nullptr};
  sweep_(*form_, ones_.data(), SweepMaterial{}, -1.0, arrays, 0,
         static_cast<std::int32_t>(form_->runs.size()));
  subtract_boundary(-1.0, ones_.data(), p, force, 0, form_->corners.size());
}

void EdgeForce::stiffness(double lambda, double mu, std::span<const double> x, std::span<double> out) const {
  const auto n = static_cast<std::size_t>(form_->nodes);
  const auto row = static_cast<std::size_t>(form_->row);
  std::array<double, 2> factor{lambda, mu};
  if (form_->moduli) {
    const Combined& m = *form_->moduli;
    assert(std::abs(lambda * m.mu - mu * m.lambda) <= 1e-14 * std::abs(lambda * m.mu));
    factor[0] = m.lambda > 0.0 ? lambda / m.lambda : m.mu > 0.0 ? mu / m.mu : 0.0;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const double* u = x.data() + 2 * static_cast<std::size_t>(form_->mesh_node[k]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      for (std::size_t b = 0; b < row / 2; ++b) packed_[row * k + 2 * b + axis] = factor[b] * u[axis];
    }
  }
  apply(packed_.data(), force_.data());
  for (std::size_t k = 0; k < n; ++k) {
    double* f = out.data() + 2 * static_cast<std::size_t>(form_->mesh_node[k]);
    f[0] = force_[2 * k];
    f[1] = force_[2 * k + 1];
  }
}

void EdgeForce::subtract_boundary(double h, const double* scale, const double* p, double* out,
                                  std::size_t first, std::size_t last) const {
  const double factor = h * form_->corner_factor;
  const auto row = static_cast<std::size_t>(form_->row);
  for (std::size_t k = first; k < last; ++k) {
    const EdgeForm::Corner& c = form_->corners[k];
    const double* next = p + row * static_cast<std::size_t>(c.next);
    const double* previous = p + row * static_cast<std::size_t>(c.previous);
    double dx = next[0] - previous[0], dy = next[1] - previous[1];
    if (row == 4) {  // of w_lambda - w_mu
      dx -= next[2] - previous[2];
      dy -= next[3] - previous[3];
    }
    const std::size_t i = 2 * static_cast<std::size_t>(c.node);
    out[i] -= factor * scale[i] * dy;
    out[i + 1] += factor * scale[i + 1] * dx;
  }
}

}  // namespace rheo
