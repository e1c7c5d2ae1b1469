#include "kernels/nodal_terms.hpp"

#include <algorithm>

namespace rheo {
namespace {

// Where each block's items begin in a list sorted by slot, and the list's end.
template <class Item>
void find_blocks(const std::vector<std::int32_t>& ends, const std::vector<Item>& items,
                 std::vector<std::size_t>& begins) {
  begins.assign(1, 0);
  std::size_t k = 0;
  for (const std::int32_t end : ends) {
    while (k < items.size() && items[k].slot < 2 * static_cast<std::size_t>(end)) ++k;
    begins.push_back(k);
  }
}

}  // namespace

NodalTerms::NodalTerms(std::span<const double> mass, std::span<const std::int32_t> kernel_node,
                       std::vector<std::int32_t> block_ends)
    : mass_(mass),
      kernel_node_(kernel_node),
      block_ends_(std::move(block_ends)),
      inverse_mass_(mass.size()) {}

void NodalTerms::enter(const Interval& interval) {
  interval_ = &interval;
  const auto slot = [&](int dof) {
    return 2 * static_cast<std::size_t>(kernel_node_[static_cast<std::size_t>(dof / 2)]) +
           static_cast<std::size_t>(dof % 2);
  };
  const auto slope_at = [&](int dof) {
    return interval.force_rate.size() > 0 ? interval.force_rate[dof] : 0.0;
  };
  const auto by_slot = [](const auto& a, const auto& b) { return a.slot < b.slot; };
  std::transform(mass_.begin(), mass_.end(), inverse_mass_.begin(), [](double m) { return 1.0 / m; });
  held_.clear();
  for (const HeldDof& h : interval.eliminated) {
    held_.push_back({slot(h.dof), h, interval.force[h.dof], slope_at(h.dof)});
    inverse_mass_[held_.back().slot] = 0.0;
  }
  std::sort(held_.begin(), held_.end(), by_slot);
  find_blocks(block_ends_, held_, held_begin_);
  loads_.clear();
  for (int dof = 0; dof < static_cast<int>(mass_.size()); ++dof) {
    const double force = interval.force[dof];
    const double slope = slope_at(dof);
    if (force == 0.0 && slope == 0.0) continue;
    const std::size_t s = slot(dof);
    loads_.push_back({s, force, slope, inverse_mass_[s] * force, inverse_mass_[s] * slope});
  }
  std::sort(loads_.begin(), loads_.end(), by_slot);
  find_blocks(block_ends_, loads_, load_begin_);
}

void NodalTerms::add(const Body& body, double h, const Forcing& forcing, double* out_v,
                     std::size_t block) const {
  const double constant = forcing.weight[0];
  const double linear = forcing.weight[0] * (forcing.t - interval_->begin) + forcing.weight[1];
  for (std::size_t k = load_begin_[block]; k < load_begin_[block + 1]; ++k) {
    out_v[loads_[k].slot] += h * (constant * loads_[k].acceleration + linear * loads_[k].acceleration_slope);
  }
  if (!interval_->moving) return;
  for (std::size_t k = held_begin_[block]; k < held_begin_[block + 1]; ++k) {
    double a = 0.0;
    for (int d = 0; d < 4; ++d) {
      if (forcing.weight[d] != 0.0) a += forcing.weight[d] * body.prescribed(held_[k].dof, forcing.t, 2 + d);
    }
    out_v[held_[k].slot] += h * a;
  }
}

void NodalTerms::impose(const Body& body, double t, double* u, double* v) const {
  if (!interval_->moving) return;  // held where they were: their velocity and acceleration are exactly zero
  for (const Held& h : held_) {
    u[h.slot] = body.prescribed(h.dof, t, 0);
    v[h.slot] = body.prescribed(h.dof, t, 1);
  }
}

void NodalTerms::sample_loads(double t, const double* u, const double* v, EnergySample& e) const {
  const double s = t - interval_->begin;
  for (const Load& load : loads_) {
    e.load += (load.force + s * load.slope) * u[load.slot];
    e.load_power += (load.force + s * load.slope) * v[load.slot];
    e.load_slope += load.slope * u[load.slot];
    e.load_slope_rate += load.slope * v[load.slot];
  }
}

// R = m b'' + F - f and its slope with F(w') for F(w).
void NodalTerms::sample_constraints(const Body& body, double t, const double* force, const double* force_rate,
                                    const double* v, EnergySample& e) const {
  if (!interval_->moving) return;
  const double s = t - interval_->begin;
  for (const Held& h : held_) {
    const double a = body.prescribed(h.dof, t, 2);
    const double r = mass_[h.slot] * a + force[h.slot] - (h.force + s * h.slope);
    const double r_rate = mass_[h.slot] * body.prescribed(h.dof, t, 3) + force_rate[h.slot] - h.slope;
    e.constraints += r * v[h.slot];
    e.constraints_rate += r_rate * v[h.slot] + r * a;
  }
}

void NodalTerms::reaction(const Body& body, double t, const double* force, Vector& out) const {
  const double s = t - interval_->begin;
  out.setZero(static_cast<Eigen::Index>(mass_.size()));
  for (const Held& h : held_) {
    const double a = interval_->moving ? body.prescribed(h.dof, t, 2) : 0.0;
    out[h.dof.dof] = mass_[h.slot] * a + force[h.slot] - (h.force + s * h.slope);
  }
}

}  // namespace rheo
