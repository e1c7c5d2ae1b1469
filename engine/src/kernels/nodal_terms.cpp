#include "kernels/nodal_terms.hpp"

#include <algorithm>

#include "kernels/node_blocks.hpp"

namespace rheo {

NodalTerms::NodalTerms(std::span<const double> mass, std::span<const std::int32_t> kernel_node,
                       std::vector<std::int32_t> ends)
    : mass_(mass), kernel_node_(kernel_node), ends_(std::move(ends)), inverse_mass_(mass.size()) {
  // As many as there can be: enter() allocates nothing, and what is not used takes no memory.
  loads_.reserve(mass.size());
  held_.reserve(mass.size());
  load_begin_.reserve(ends_.size() + 1);
  held_begin_.reserve(ends_.size() + 1);
}

void NodalTerms::enter(const Interval& interval) {
  interval_ = &interval;
  imposed_ = false;
  const auto by_slot = [](const auto& a, const auto& b) { return a.slot < b.slot; };
  const auto node_of = [](const auto& item) { return item.slot / 2; };
  std::transform(mass_.begin(), mass_.end(), inverse_mass_.begin(), [](double m) { return 1.0 / m; });
  held_.clear();
  for (const HeldDof& h : interval.eliminated) {
    Polynomial change = interval.course[h.owner][h.dof % 2];
    change.c[0] = 0.0;
    held_.push_back({slot(h.dof), h, !change.is_zero()});
    inverse_mass_[held_.back().slot] = 0.0;
  }
  std::sort(held_.begin(), held_.end(), by_slot);
  find_block_begins(ends_, held_, node_of, held_begin_);
  loads_.clear();
  for (int dof = 0; dof < static_cast<int>(mass_.size()); ++dof) {
    const double force = interval.force[dof];
    const double rate = slope(dof);
    if (force == 0.0 && rate == 0.0) continue;
    const std::size_t s = slot(dof);
    loads_.push_back({s, force, rate, inverse_mass_[s] * force, inverse_mass_[s] * rate});
  }
  std::sort(loads_.begin(), loads_.end(), by_slot);
  find_block_begins(ends_, loads_, node_of, load_begin_);
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
    if (!held_[k].moves) continue;
    double a = 0.0;
    for (int d = 0; d < 4; ++d) {
      if (forcing.weight[d] != 0.0) a += forcing.weight[d] * body.prescribed(held_[k].dof, forcing.t, 2 + d);
    }
    out_v[held_[k].slot] += h * a;
  }
}

void NodalTerms::impose(const Body& body, double t, double* u, double* v) {
  if (!interval_->moving && imposed_) return;
  for (const Held& h : held_) {
    if (!h.moves && imposed_) continue;
    u[h.slot] = body.prescribed(h.dof, t, 0);
    v[h.slot] = body.prescribed(h.dof, t, 1);
  }
  imposed_ = true;
}

void NodalTerms::sample_loads(double t, const double* u, const double* v, EnergySample& e) const {
  const double s = t - interval_->begin;
  e.load = e.load_power = e.load_slope = e.load_slope_rate = 0.0;
  for (const Load& load : loads_) {
    e.load += (load.force + s * load.slope) * u[load.slot];
    e.load_power += (load.force + s * load.slope) * v[load.slot];
    e.load_slope += load.slope * u[load.slot];
    e.load_slope_rate += load.slope * v[load.slot];
  }
}

double NodalTerms::reaction(const Body& body, double t, const HeldDof& h, const NodeForce& at) const {
  const double a = interval_->moving ? body.prescribed(h, t, 2) : 0.0;
  const double external = interval_->force[h.dof] + (t - interval_->begin) * slope(h.dof);
  return mass_[slot(h.dof)] * a + at.force[static_cast<std::size_t>(h.dof % 2)] - external;
}

// R v and its slope: that of R has F(w') for F(w).
void NodalTerms::add_power(const Body& body, double t, const HeldDof& h, const NodeForce& at, const double* v,
                           EnergySample& e) const {
  const std::size_t k = slot(h.dof);
  const double r = reaction(body, t, h, at);
  const double r_rate =
      mass_[k] * body.prescribed(h, t, 3) + at.rate[static_cast<std::size_t>(h.dof % 2)] - slope(h.dof);
  e.constraints += r * v[k];
  e.constraints_rate += r_rate * v[k] + r * body.prescribed(h, t, 2);
}

}  // namespace rheo
