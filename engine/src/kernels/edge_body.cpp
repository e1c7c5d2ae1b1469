#include "kernels/edge_body.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "kernels/node_blocks.hpp"

namespace rheo {
namespace {

// n x 2, in the kernel's order.
std::vector<double> entry_masses(const Model& model, const EdgeForm& form) {
  std::vector<double> masses;
  masses.reserve(2 * form.mesh_node.size());
  for (const std::int32_t node : form.mesh_node)
    masses.insert(masses.end(), {model.node_mass[node], model.node_mass[node]});
  return masses;
}

}  // namespace

EdgeBody::EdgeBody(const Model& model, const EdgeForce& force, int threads)
    : Body(model, 0.0),
      edge_force_(force),
      form_(force.form()),
      team_(block_ends(form_.blocks), paying_threads(form_.nodes, threads)),
      sums_(form_.blocks.size()),
      mass_(entry_masses(model, form_)),
      terms_(mass_, form_.kernel_node, block_ends(form_.blocks)) {
  const auto n = static_cast<std::size_t>(form_.nodes);
  const Material& m = model.material();
  assert(form_.moduli.has_value() == combined(m).has_value());
  elastic_ = form_.moduli && m.lambda_rate() == 0.0 && m.mu_rate() == 0.0;
  state_.assign((row() + (elastic_ ? 2 : 4)) * n, 0.0);
  find_block_begins(
      block_ends(form_.blocks), form_.corners,
      [](const EdgeForm::Corner& corner) { return static_cast<std::size_t>(corner.node); }, corner_begin_);
  parts_ = {StatePart{row() * n, form_.moduli ? 1.0 : smallest_share(model)}, StatePart{2 * n, 1.0}};
  if (!elastic_) parts_.push_back({2 * n, 1.0});
  for (int axis = 0; axis < 2; ++axis) {
    if (form_.moduli) {
      material_.growth[axis] = 1.0;
      material_.decay[axis] = std::max(m.lambda_rate(), m.mu_rate());
      continue;
    }
    material_.growth[axis] = m.lambda_ela;
    material_.growth[2 + axis] = m.mu_ela;
    material_.decay[axis] = m.lambda_rate();
    material_.decay[2 + axis] = m.mu_rate();
  }
}

double EdgeBody::smallest_share(const Model& model) {
  const Material& m = model.material();
  if (m.lambda_ela == 0.0 || m.mu_ela == 0.0) return 1.0;
  const auto reach = [&](double ela, double rate) { return ela / (rate + model.element_omega); };
  const double lambda = reach(m.lambda_ela, m.lambda_rate());
  const double mu = reach(m.mu_ela, m.mu_rate());
  return std::min(lambda, mu) / std::max(lambda, mu);
}

void EdgeBody::load(std::span<const double> y) {
  const Layout& layout = model_.layout;
  for (std::size_t k = 0; k < static_cast<std::size_t>(form_.nodes); ++k) {
    const auto node = static_cast<std::size_t>(form_.mesh_node[k]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const std::size_t i = 2 * node + axis;
      double* const pk = state_.data() + p() + row() * k;
      if (!form_.moduli) {
        pk[axis] = y[layout.w_lambda() + i];
        pk[2 + axis] = y[layout.w_mu() + i];
      } else if (!elastic_) {
        pk[axis] = layout.lambda ? y[layout.w_lambda() + i] / form_.moduli->lambda
                   : layout.mu   ? y[layout.w_mu() + i] / form_.moduli->mu
                                 : 0.0;
      }
      state_[v() + 2 * k + axis] = y[layout.v() + i];
      state_[u() + 2 * k + axis] = y[layout.u() + i];
    }
  }
}

void EdgeBody::store(std::span<double> y) const {
  const Layout& layout = model_.layout;
  for (std::size_t k = 0; k < static_cast<std::size_t>(form_.nodes); ++k) {
    const auto node = static_cast<std::size_t>(form_.mesh_node[k]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const std::size_t i = 2 * node + axis;
      const double* const pk = state_.data() + p() + row() * k;
      if (layout.lambda) y[layout.w_lambda() + i] = form_.moduli ? form_.moduli->lambda * pk[axis] : pk[axis];
      if (layout.mu) y[layout.w_mu() + i] = form_.moduli ? form_.moduli->mu * pk[axis] : pk[2 + axis];
      y[layout.v() + i] = state_[v() + 2 * k + axis];
      y[layout.u() + i] = state_[u() + 2 * k + axis];
    }
  }
}

void EdgeBody::enter(const Interval& interval, const Vector& base) {
  Body::enter(interval, base);
  terms_.enter(interval);
}

void EdgeBody::impose_prescribed(double t) {
  terms_.impose(*this, t, state_.data() + u(), state_.data() + v());
}

void EdgeBody::sweep_block(const Sweep& sweep, std::size_t block) const {
  const EdgeForm::Block& b = form_.blocks[block];
  const double h = sweep.h;
  const SweepArrays arrays{
      sweep.x.data() + p(),    sweep.x.data() + v(),
      sweep.base.data() + p(), sweep.base.data() + v(),
      sweep.out.data() + p(),  sweep.out.data() + v(),
      sweep.base.data() + u(), sweep.result == Result::step && !elastic_ ? sweep.out.data() + u() : nullptr};
  edge_force_.sweep()(form_, terms_.inverse_mass(), material_, h, arrays, b.first_run, b.last_run);
  double* out_v = sweep.out.data() + v();
  edge_force_.subtract_boundary(h, terms_.inverse_mass(), sweep.x.data() + p(), out_v, corner_begin_[block],
                                corner_begin_[block + 1]);
  terms_.add(*this, h, sweep.forcing, out_v, block);
}

void EdgeBody::fma(double h, std::span<const double> x, std::span<const double> base, const Forcing& forcing,
                   std::span<double> out, Result result) {
  const Sweep sweep{h, x, base, forcing, out, result};
  chain({&sweep, 1});
}

// What sweep k overwrites (the argument of sweep k - 1, or the base) was read in the block and in those
// beside it before: the team's order.
void EdgeBody::chain(std::span<const Sweep> sweeps) {
  const auto count = static_cast<std::int64_t>(sweeps.size());
  counters_.force_evaluations += count;
  counters_.branch_updates += elastic_ ? 0 : form_.moduli ? count : 2 * count;
  for (const Sweep& sweep : sweeps) {
    if (elastic_ || sweep.result == Result::step) ++counters_.displacement_updates;
  }
  team_.chain(sweeps.size(), [&](const BlockVisit& at) { sweep_block(sweeps[at.sweep], at.block); });
}

EdgeBody::Sums EdgeBody::sums_of(const EdgeForm::Block& block) const {
  const double* xp = state_.data() + p();
  const double* xv = state_.data() + v();
  Sums sums;
  for (auto i = 2 * static_cast<std::size_t>(block.first_node);
       i < 2 * static_cast<std::size_t>(block.last_node); ++i)
    sums.kinetic += mass_[i] * xv[i] * xv[i];
  sums.forms = form_.moduli ? combined_forms(xp, xv, block)
                            : edge_force_.forms().rows(form_, xp, xv, block.first_run, block.last_run);
  return sums;
}

// q^T K q and v^T K q.
EdgeForms EdgeBody::combined_forms(const double* xq, const double* xv, const EdgeForm::Block& block) const {
  EdgeForms sums;
  for (std::int32_t r = block.first_run; r < block.last_run; ++r) {
    const EdgeForm::Run& run = form_.runs[static_cast<std::size_t>(r)];
    for (auto i = static_cast<std::size_t>(run.first); i < static_cast<std::size_t>(run.last); ++i) {
      const EdgeForm::Edges edges = run.edges_of(static_cast<std::int64_t>(i));
      auto e = static_cast<std::size_t>(edges.edge);
      for (std::int32_t k = 0; k < run.valence; ++k, e += static_cast<std::size_t>(edges.stride)) {
        const std::size_t j = form_.offset[e];  // 2 x the neighbour's number
        if (j < 2 * i) continue;                // each edge once
        const double kxx = form_.level[2 * e], kyy = form_.level[2 * e + 1], kxy = form_.mixed[e];
        const double dx = xv[j] - xv[2 * i], dy = xv[j + 1] - xv[2 * i + 1];
        const double qx = xq[j] - xq[2 * i], qy = xq[j + 1] - xq[2 * i + 1];
        const double sx = kxx * qx + kxy * qy, sy = kxy * qx + kyy * qy;
        sums.ll -= qx * sx + qy * sy;
        sums.xl -= dx * sx + dy * sy;
      }
    }
  }
  return sums;
}

// Only constrained nodes are asked for, a few: one by one, not by a sweep over the mesh.
NodeForce EdgeBody::force_at(std::size_t node) const {
  const double* xp = state_.data() + p();
  const double* xv = state_.data() + v();
  const std::size_t row_size = row();
  // p and p' of a node, a row each.
  struct Rows {
    std::array<double, 4> p{}, rate{};
  };
  const auto at = [&](std::size_t i) {
    Rows rows;
    for (std::size_t c = 0; c < row_size; ++c) {
      rows.p[c] = xp[row_size * i + c];
      rows.rate[c] = material_.growth[c] * xv[2 * i + c % 2] - material_.decay[c] * rows.p[c];
    }
    return rows;
  };
  const auto difference = [&](const Rows& a, const Rows& b) {
    Rows d;
    for (std::size_t c = 0; c < row_size; ++c) {
      d.p[c] = a.p[c] - b.p[c];
      d.rate[c] = a.rate[c] - b.rate[c];
    }
    return d;
  };
  NodeForce result;
  const auto run = std::upper_bound(
      form_.runs.begin(), form_.runs.end(), node,
      [](std::size_t i, const EdgeForm::Run& r) { return i < static_cast<std::size_t>(r.last); });
  const EdgeForm::Edges edges = run->edges_of(static_cast<std::int64_t>(node));
  const Rows own = at(node);
  for (std::int32_t k = 0; k < run->valence; ++k) {
    const auto edge = static_cast<std::size_t>(edges.edge + k * edges.stride);
    const Rows d = difference(at(form_.offset[edge] / row_size), own);
    const std::array<double, 4> level = form_.full_level(edge);
    const double mixed = form_.mixed[edge];
    // Rows of two have nothing in their third and fourth number.
    const auto add = [&](const std::array<double, 4>& w, std::array<double, 2>& f) {
      f[0] += level[0] * w[0] + mixed * (w[1] + w[3]);
      f[1] += level[1] * w[1] + mixed * (w[0] + w[2]);
      if (row_size < 4) return;
      f[0] += level[2] * w[2];
      f[1] += level[3] * w[3];
    };
    add(d.p, result.force);
    add(d.rate, result.rate);
  }
  const auto by_node = [](const EdgeForm::Corner& c, std::size_t i) {
    return static_cast<std::size_t>(c.node) < i;
  };
  for (auto c = std::lower_bound(form_.corners.begin(), form_.corners.end(), node, by_node);
       c != form_.corners.end() && static_cast<std::size_t>(c->node) == node; ++c) {
    const Rows d =
        difference(at(static_cast<std::size_t>(c->next)), at(static_cast<std::size_t>(c->previous)));
    const auto add = [&](const std::array<double, 4>& w, std::array<double, 2>& f) {
      f[0] += form_.corner_factor * (w[1] - w[3]);
      f[1] -= form_.corner_factor * (w[0] - w[2]);
    };
    add(d.p, result.force);
    add(d.rate, result.rate);
  }
  return result;
}

EnergySample EdgeBody::sample(double t) {
  const Material& material = model_.material();
  const double* xp = state_.data() + p();
  const double* xv = state_.data() + v();
  team_.chain(1, [&](const BlockVisit& at) { sums_[at.block] = sums_of(form_.blocks[at.block]); });
  EdgeForms all = boundary_forms(form_, xp, row(), xv);  // combined: of q, with K's factor, as lambda's
  double kinetic = 0.0;
  for (const Sums& sums : sums_) {
    all += sums.forms;
    kinetic += sums.kinetic;
  }

  EnergySample e;
  e.kinetic = 0.5 * kinetic;
  if (form_.moduli) {
    // w_l^T J_l w_l / lambda_vis + w_m^T J_m w_m / mu_vis = rate q^T K q
    const double rate = material_.decay[0];
    e.stored = 0.5 * all.ll;
    e.dissipated = rate * all.ll;
    e.dissipated_rate = 2.0 * rate * (all.xl - rate * all.ll);
  } else {
    const auto branch = [&](double quadratic, double with_v, double ela, double vis, double decay) {
      e.stored += 0.5 * quadratic / ela;
      if (std::isinf(vis)) return;
      e.dissipated += quadratic / vis;
      e.dissipated_rate += 2.0 * (ela * with_v - decay * quadratic) / vis;
    };
    branch(all.ll, all.xl, material.lambda_ela, material.lambda_vis, material.lambda_rate());
    branch(all.mm, all.xm, material.mu_ela, material.mu_vis, material.mu_rate());
  }
  resample(t, e);
  return e;
}

void EdgeBody::resample(double t, EnergySample& e) {
  terms_.sample(
      *this, t, state_.data() + u(), state_.data() + v(), [&](std::size_t node) { return force_at(node); },
      e);
}

void EdgeBody::reaction(double t, Vector& out) {
  terms_.reaction(
      *this, t, [&](std::size_t node) { return force_at(node); }, out);
}

void EdgeBody::reaction_at(double t, std::span<const HeldDof> held, Vector& out) {
  terms_.reaction_at(
      *this, t, held, [&](std::size_t node) { return force_at(node); }, out);
}

}  // namespace rheo
