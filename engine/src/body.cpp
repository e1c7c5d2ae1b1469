#include "body.hpp"

namespace rheo {

void Body::enter(const Interval& interval, const Vector& base) {
  interval_ = &interval;
  base_ = &base;
}

double Body::prescribed(const HeldDof& held, double t, int derivative) const {
  const double course = interval_->course[held.owner][held.dof % 2].derivative(t, derivative);
  return derivative == 0 ? (*base_)[held.dof] + course : course;
}

double Body::column_value(const Column& column, double t, int derivative) const {
  if (column.owner >= 0) return prescribed({column.entries.front().first, column.owner}, t, derivative);
  return derivative == 0 ? column.value : 0.0;
}

double Body::column_forcing(const Column& column, const Forcing& forcing) const {
  double b = 0.0;
  for (std::size_t k = 0; k < forcing.weight.size(); ++k) {
    const int order = static_cast<int>(k);
    if (forcing.weight[k] == 0.0) continue;
    b += forcing.weight[k] * (column_value(column, forcing.t, 2 + order) +
                              2 * omega_ * column_value(column, forcing.t, 1 + order) +
                              omega_ * omega_ * column_value(column, forcing.t, order));
  }
  return b;
}

void Body::external_force(const Forcing& forcing, Vector& out) const {
  out = forcing.weight[0] * interval_->force;
  if (interval_->force_rate.size() > 0) {
    out += (forcing.weight[0] * (forcing.t - interval_->begin) + forcing.weight[1]) * interval_->force_rate;
  }
}

}  // namespace rheo
