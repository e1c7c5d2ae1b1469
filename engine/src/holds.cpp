#include "holds.hpp"

#include <algorithm>
#include <cmath>

#include "rheo/io/bytes.hpp"

namespace rheo {

Holds::Holds(const Model& model, std::size_t columns)
    : model_(model), owner_(model.layout.part, -1), next_owner_(owner_), taken_(model.layout.part, 0) {
  const auto part = static_cast<Eigen::Index>(model.layout.part);
  for (Vector* v : {&base_, &jump_, &dv_, &momentum_, &nothing_}) v->setZero(part);
  target_.setZero(static_cast<Eigen::Index>(columns));
  impulse_ = target_;
}

void Holds::put(ByteWriter& out) const {
  out.put_list(std::span(base_.data(), static_cast<std::size_t>(base_.size())));
  out.put_list(owner_);
}

void Holds::get(ByteReader& in) {
  in.get_list(std::span(base_.data(), static_cast<std::size_t>(base_.size())));
  in.get_list(std::span(owner_));
}

bool Holds::change_owners(const Interval& next, const Hands* hands) {
  bool any = false;
  std::fill(next_owner_.begin(), next_owner_.end(), -1);
  for (const HeldDof& h : next.held) {
    next_owner_[h.dof] = h.owner;
    const bool taken =
        owner_[h.dof] != h.owner || (hands != nullptr && hands->takes_now(h.owner, next.begin));
    taken_[h.dof] = taken ? 1 : 0;
    any = any || taken;
  }
  std::swap(owner_, next_owner_);
  return any;
}

bool Holds::find_jumps(const Interval& before, const Interval& next, const double* u, const double* v) {
  bool any = false;
  for (const HeldDof& h : next.held) {
    const Polynomial& course = next.course[h.owner][h.dof % 2];
    const double speed = course.derivative(next.begin, 1);
    double speed_before = 0.0;
    double size = course.derivative_size(next.begin, 1);
    if (taken_[h.dof] != 0) {
      base_[h.dof] = u[h.dof] - course.value(next.begin);
      speed_before = v[h.dof];
      size += std::abs(speed_before);
    } else {
      const Polynomial& course_before = before.course[h.owner][h.dof % 2];
      speed_before = course_before.derivative(next.begin, 1);
      size += course_before.derivative_size(next.begin, 1);
    }
    // The same velocity from two polynomials differs by rounding.
    const bool jumps = std::abs(speed - speed_before) > 1e-12 * size;
    jump_[h.dof] = jumps ? speed - speed_before : 0.0;
    any = any || jumps || taken_[h.dof] != 0;
  }
  return any;
}

std::optional<double> Holds::project(const Interval& interval, General general, VectorMap v) {
  const ConstraintSolver& solver = *interval.solver;
  const std::size_t columns = solver.columns().size();
  bool any = false;
  for (const HeldDof& h : interval.eliminated) {
    dv_[h.dof] = jump_[h.dof];
    any = any || dv_[h.dof] != 0.0;
  }
  target_.resize(static_cast<Eigen::Index>(columns));
  for (std::size_t j = 0; j < columns; ++j) {
    const Column& column = solver.columns()[j];
    if (column.owner >= 0) {
      target_[j] = jump_[column.entries.front().first];
    } else {
      target_[j] = general == General::begin ? -solver.row_times(j, v.data()) : 0.0;
    }
    any = any || target_[j] != 0.0;
  }
  if (!any) return std::nullopt;
  solver.solve(nothing_, dv_, target_, impulse_);
  model_.multiply_mass(dv_.data(), momentum_.data());
  const double work = momentum_.dot(v) + 0.5 * momentum_.dot(dv_);
  v += dv_;
  return work;
}

}  // namespace rheo
