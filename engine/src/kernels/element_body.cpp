#include "kernels/element_body.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "kernels/node_blocks.hpp"

namespace rheo {
namespace {

std::vector<double> twice(const std::vector<double>& by_node) {
  std::vector<double> result;
  result.reserve(2 * by_node.size());
  for (const double x : by_node) result.insert(result.end(), {x, x});
  return result;
}

// Of all residual forces driven by one v at the largest frequency, the smallest one's size over the
// largest's: they share a part of the state, and an error bound for it has to be smaller by as much to hold
// for each.
double smallest_share(const std::vector<Material>& materials, double omega) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  const auto include = [&](double ela, double rate) {
    if (ela == 0.0) return;
    const double reach = ela / (rate + omega);
    smallest = std::min(smallest, reach);
    largest = std::max(largest, reach);
  };
  for (const Material& m : materials) {
    include(m.lambda_ela, m.lambda_rate());
    include(m.mu_ela, m.mu_rate());
  }
  return largest > 0.0 ? smallest / largest : 1.0;
}

SweepMaterial sweep_material(const Material& m) {
  return {{m.lambda_ela, m.lambda_ela, m.mu_ela, m.mu_ela},
          {m.lambda_rate(), m.lambda_rate(), m.mu_rate(), m.mu_rate()}};
}

}  // namespace

std::vector<std::int32_t> numbers_in_patches(const Model& model, const ElementForm& form) {
  std::vector<std::int32_t> numbers;
  numbers.reserve(form.slot_node.size());
  for (std::size_t slot = 0; slot < form.slot_node.size(); ++slot) {
    const Patch& patch = model.patches[static_cast<std::size_t>(form.slot_region[slot])];
    numbers.push_back(patch.number_of(form.mesh_node[static_cast<std::size_t>(form.slot_node[slot])]));
  }
  return numbers;
}

ElementBody::ElementBody(const Model& model, const ElementForce& force, int threads)
    : Body(model, 0.0),
      element_force_(force),
      form_(force.form()),
      blocks_(form_.blocks(smallest_block)),
      team_(block_ends(blocks_), paying_threads(form_.nodes, threads)),
      mass_(twice(form_.node_mass)),
      terms_(mass_, form_.kernel_node, block_ends(blocks_)),
      force_sums_(force, blocks_, team_.threads()),
      sums_(blocks_.size() * form_.materials.size()) {
  const auto n = static_cast<std::size_t>(form_.nodes);
  const auto s = static_cast<std::size_t>(form_.slots);
  state_.assign(4 * s + 4 * n, 0.0);
  parts_ = {StatePart{4 * s, smallest_share(form_.materials, model.element_omega)}, StatePart{2 * n, 1.0},
            StatePart{2 * n, 1.0}};
  for (const Material& m : form_.materials) materials_.push_back(sweep_material(m));
  number_in_patch_ = numbers_in_patches(model, form_);
  branches_.resize(form_.materials.size());
  for (const BranchPart& part : model.layout.branches)
    (part.modulus == Modulus::lambda ? branches_[part.region].lambda : branches_[part.region].mu) = &part;
}

// visit(kernel's number, mesh's number) for all of the state.
template <class Visit>
void ElementBody::for_each_number(const Visit& visit) const {
  const Layout& layout = model_.layout;
  for (std::size_t slot = 0; slot < number_in_patch_.size(); ++slot) {
    const auto& [lambda, mu] = branches_[static_cast<std::size_t>(form_.slot_region[slot])];
    const std::size_t i = 2 * static_cast<std::size_t>(number_in_patch_[slot]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (lambda != nullptr) visit(p() + 4 * slot + axis, lambda->offset + i + axis);
      if (mu != nullptr) visit(p() + 4 * slot + 2 + axis, mu->offset + i + axis);
    }
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(form_.nodes); ++k) {
    const std::size_t i = 2 * static_cast<std::size_t>(form_.mesh_node[k]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      visit(v() + 2 * k + axis, layout.v() + i + axis);
      visit(u() + 2 * k + axis, layout.u() + i + axis);
    }
  }
}

void ElementBody::load(std::span<const double> y) {
  for_each_number([&](std::size_t kernel, std::size_t mesh) { state_[kernel] = y[mesh]; });
}

void ElementBody::store(std::span<double> y) const {
  for_each_number([&](std::size_t kernel, std::size_t mesh) { y[mesh] = state_[kernel]; });
}

void ElementBody::enter(const Interval& interval, const Vector& base) {
  Body::enter(interval, base);
  terms_.enter(interval);
}

void ElementBody::impose_prescribed(double t) {
  terms_.impose(*this, t, state_.data() + u(), state_.data() + v());
}

void ElementBody::fma(double h, std::span<const double> x, std::span<const double> base,
                      const Forcing& forcing, std::span<double> out, Result result) {
  const Sweep sweep{h, x, base, forcing, out, result};
  chain({&sweep, 1});
}

void ElementBody::chain(std::span<const Sweep> sweeps) {
  counters_.force_evaluations += static_cast<std::int64_t>(sweeps.size());
  counters_.branch_updates += 2 * static_cast<std::int64_t>(sweeps.size() * materials_.size());
  for (const Sweep& sweep : sweeps) {
    if (sweep.result == Result::step) ++counters_.displacement_updates;
  }
  team_.chain(sweeps.size(), [&](const BlockVisit& at) { sweep_block(sweeps[at.sweep], at); });
}

void ElementBody::sweep_block(const Sweep& sweep, const BlockVisit& visit) {
  const ElementForm::Block& b = blocks_[visit.block];
  const double* x_p = sweep.x.data() + p();
  double* const force = force_sums_.of_block(x_p, visit);
  for (std::int32_t r = b.first_run; r < b.last_run; ++r) {
    const ElementForm::Run& run = form_.runs[r];
    const std::int32_t first = std::max(run.first, b.first_node);
    const std::int32_t last = std::min(run.last, b.last_node);
    const auto node = static_cast<std::size_t>(first);
    const auto slot = static_cast<std::size_t>(run.slot + (first - run.first) * run.slots_a_node);
    const bool step = sweep.result == Result::step;
    const SweepArrays arrays{x_p + 4 * slot,
                             sweep.x.data() + v() + 2 * node,
                             sweep.base.data() + p() + 4 * slot,
                             sweep.base.data() + v() + 2 * node,
                             sweep.out.data() + p() + 4 * slot,
                             sweep.out.data() + v() + 2 * node,
                             sweep.base.data() + u() + 2 * node,
                             step ? sweep.out.data() + u() + 2 * node : nullptr};
    if (run.slots_a_node > 1) {
      advance_interface(run, sweep.h, arrays, force + 2 * slot);
    } else {
      const NodeStretch stretch{last - first, arrays, terms_.inverse_mass() + 2 * node, force + 2 * slot};
      element_force_.sweep().advance(stretch, materials_[run.region], sweep.h);
    }
  }
  terms_.add(*this, sweep.h, sweep.forcing, sweep.out.data() + v(), visit.block);
}

void ElementBody::advance_interface(const ElementForm::Run& run, double h, const SweepArrays& a,
                                    double* force) {
  const double* inverse_mass = terms_.inverse_mass() + 2 * static_cast<std::size_t>(run.first);
  const double velocity[2] = {a.x_v[0], a.x_v[1]};
  double sum[2] = {};
  for (std::int32_t s = 0; s < run.slots_a_node; ++s) {
    const SweepMaterial& m = materials_[form_.slot_region[run.slot + s]];
    for (int axis = 0; axis < 2; ++axis) {
      sum[axis] += force[2 * s + axis];
      force[2 * s + axis] = 0.0;
    }
    for (int c = 0; c < 4; ++c) {
      const int k = 4 * s + c;
      a.out_p[k] = a.base_p[k] + h * (m.growth[c] * velocity[c % 2] - m.decay[c] * a.x_p[k]);
    }
  }
  for (int axis = 0; axis < 2; ++axis) {
    a.out_v[axis] = a.base_v[axis] - h * (inverse_mass[axis] * sum[axis]);
    if (a.out_u != nullptr) a.out_u[axis] = a.base_u[axis] + h * velocity[axis];
  }
}

// Only constrained nodes are asked for, a few: triangle by triangle, not by a sweep over the mesh.
NodeForce ElementBody::force_at(std::size_t node) const {
  using Row = std::array<double, 4>;
  const double* xp = state_.data() + p();
  const double* xv = state_.data() + v();
  const auto p_of = [&](std::size_t s) {
    return Row{xp[4 * s], xp[4 * s + 1], xp[4 * s + 2], xp[4 * s + 3]};
  };
  const auto rate_of = [&](std::size_t s) {
    const SweepMaterial& m = materials_[static_cast<std::size_t>(form_.slot_region[s])];
    const double* vs = xv + 2 * static_cast<std::size_t>(form_.slot_node[s]);
    Row rate{};
    for (std::size_t c = 0; c < 4; ++c) rate[c] = m.growth[c] * vs[c % 2] - m.decay[c] * xp[4 * s + c];
    return rate;
  };
  NodeForce result;
  for (const std::int32_t e : form_.triangles_at(node)) {
    const std::array<double, 4>& q = form_.gradient[e];
    std::array<std::size_t, 3> slots{};
    double b = 0.0, c = 0.0;  // of this node's corner
    for (std::size_t k = 0; k < 3; ++k) {
      slots[k] = form_.offset[e][k] / 4;
      if (static_cast<std::size_t>(form_.slot_node[slots[k]]) != node) continue;
      b = k == 0 ? -(q[0] + q[2]) : q[2 * (k - 1)];
      c = k == 0 ? -(q[1] + q[3]) : q[2 * (k - 1) + 1];
    }
    const auto add = [&](const auto& row_of, std::array<double, 2>& f) {
      const Row w0 = row_of(slots[0]), w1 = row_of(slots[1]), w2 = row_of(slots[2]);
      const auto dx = [&](std::size_t i) { return q[0] * (w1[i] - w0[i]) + q[2] * (w2[i] - w0[i]); };
      const auto dy = [&](std::size_t i) { return q[1] * (w1[i] - w0[i]) + q[3] * (w2[i] - w0[i]); };
      const double div = dx(0) + dy(1);
      const double xx = div + 2 * dx(2), yy = div + 2 * dy(3), xy = dx(3) + dy(2);
      f[0] += b * xx + c * xy;
      f[1] += b * xy + c * yy;
    };
    add(p_of, result.force);
    add(rate_of, result.rate);
  }
  return result;
}

// w_l^T J_lambda w_l = sum of div^2, w_m^T J_mu w_m = sum of 2 xx^2 + 2 yy^2 + (xy + yx)^2, by triangle.
void ElementBody::add_sums(const ElementForm::Block& block, std::span<Sums> by_region) const {
  const double* xp = state_.data() + p();
  const double* xv = state_.data() + v();
  for (std::int64_t e = block.first_triangle; e < block.last_triangle; ++e) {
    const auto& q = form_.gradient[e];
    double x[6] = {}, y[6] = {};  // d/dx and d/dy of l, m, v
    for (std::size_t corner : {1u, 2u}) {
      const std::uint32_t i = form_.offset[e][0], j = form_.offset[e][corner];
      const double b = q[2 * (corner - 1)], c = q[2 * (corner - 1) + 1];
      const double* vi = xv + 2 * static_cast<std::size_t>(form_.slot_node[i / 4]);
      const double* vj = xv + 2 * static_cast<std::size_t>(form_.slot_node[j / 4]);
      for (std::size_t k = 0; k < 6; ++k) {
        const double d = k < 4 ? xp[j + k] - xp[i + k] : vj[k - 4] - vi[k - 4];
        x[k] += b * d;
        y[k] += c * d;
      }
    }
    Sums& sums = by_region[static_cast<std::size_t>(form_.slot_region[form_.offset[e][0] / 4])];
    const double l = x[0] + y[1];
    const double mx = x[2], my = y[3], ms = x[3] + y[2];
    sums.ll += l * l;
    sums.mm += 2 * (mx * mx + my * my) + ms * ms;
    sums.vl += (x[4] + y[5]) * l;
    sums.vm += 2 * (x[4] * mx + y[5] * my) + (x[5] + y[4]) * ms;
  }
}

EnergySample ElementBody::sample(double t) {
  const double* xv = state_.data() + v();
  const std::size_t regions = form_.materials.size();
  std::fill(sums_.begin(), sums_.end(), Sums{});
  team_.chain(1, [&](const BlockVisit& at) {
    add_sums(blocks_[at.block], std::span(sums_).subspan(at.block * regions, regions));
  });

  EnergySample e;
  for (std::size_t r = 0; r < regions; ++r) {
    Sums total;
    for (std::size_t k = r; k < sums_.size(); k += regions) {
      total.ll += sums_[k].ll;
      total.mm += sums_[k].mm;
      total.vl += sums_[k].vl;
      total.vm += sums_[k].vm;
    }
    const auto branch = [&](double quadratic, double with_v, double ela, double vis, double decay) {
      if (ela == 0.0) return;
      e.stored += 0.5 * quadratic / ela;
      if (std::isinf(vis)) return;
      e.dissipated += quadratic / vis;
      e.dissipated_rate += 2.0 * (ela * with_v - decay * quadratic) / vis;
    };
    const Material& m = form_.materials[r];
    branch(total.ll, total.vl, m.lambda_ela, m.lambda_vis, m.lambda_rate());
    branch(total.mm, total.vm, m.mu_ela, m.mu_vis, m.mu_rate());
  }
  for (std::size_t i = 0; i < mass_.size(); ++i) e.kinetic += 0.5 * mass_[i] * xv[i] * xv[i];
  resample(t, e);
  return e;
}

void ElementBody::resample(double t, EnergySample& e) {
  terms_.sample(
      *this, t, state_.data() + u(), state_.data() + v(), [&](std::size_t node) { return force_at(node); },
      e);
}

void ElementBody::reaction(double t, Vector& out) {
  terms_.reaction(
      *this, t, [&](std::size_t node) { return force_at(node); }, out);
}

void ElementBody::reaction_at(double t, std::span<const HeldDof> held, Vector& out) {
  terms_.reaction_at(
      *this, t, held, [&](std::size_t node) { return force_at(node); }, out);
}

}  // namespace rheo
