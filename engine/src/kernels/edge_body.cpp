#include "kernels/edge_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rheo {

EdgeBody::EdgeBody(const Mesh& mesh, const Model& model, SimdLevel level)
    : Body(model, 0.0), form_(mesh), sweep_(sweep_function(level)) {
  const auto n = static_cast<std::size_t>(form_.nodes);
  state_.assign(8 * n, 0.0);
  zeros_.assign(4 * n, 0.0);
  ones_.assign(2 * n, 1.0);
  p_rate_.assign(4 * n, 0.0);
  force_.setZero(static_cast<Eigen::Index>(2 * n));
  force_rate_ = force_;
  mass_.resize(2 * n);
  for (std::size_t k = 0; k < n; ++k) mass_[2 * k] = mass_[2 * k + 1] = model.node_mass[form_.mesh_node[k]];

  // w_l = (3 a - b) / 2, w_m = (b - a) / 2 with a = w_l + w_m, b = w_l + 3 w_m; a branch that is off stays 0.
  const Material& m = model.material;
  const double l = m.lambda_rate();
  const double r = m.mu_rate();
  parts_ = {StatePart{4 * n, smallest_share(model)}, StatePart{2 * n, 1.0}, StatePart{2 * n, 1.0}};
  for (int axis = 0; axis < 2; ++axis) {
    const int b = 2 * axis;
    const int a = b + 1;
    material_.growth[b] = m.lambda_ela + 3 * m.mu_ela;
    material_.growth[a] = m.lambda_ela + m.mu_ela;
    material_.own[b] = -0.5 * (3 * r - l);
    material_.cross[b] = -1.5 * (l - r);
    material_.own[a] = -0.5 * (3 * l - r);
    material_.cross[a] = -0.5 * (r - l);
  }
}

double EdgeBody::smallest_share(const Model& model) {
  const Material& m = model.material;
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
      const double l = layout.lambda ? y[layout.w_lambda() + i] : 0.0;
      const double m = layout.mu ? y[layout.w_mu() + i] : 0.0;
      state_[p() + 4 * k + 2 * axis] = l + 3 * m;
      state_[p() + 4 * k + 2 * axis + 1] = l + m;
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
      const double b = state_[p() + 4 * k + 2 * axis];
      const double a = state_[p() + 4 * k + 2 * axis + 1];
      if (layout.lambda) y[layout.w_lambda() + i] = 0.5 * (3 * a - b);
      if (layout.mu) y[layout.w_mu() + i] = 0.5 * (b - a);
      y[layout.v() + i] = state_[v() + 2 * k + axis];
      y[layout.u() + i] = state_[u() + 2 * k + axis];
    }
  }
}

void EdgeBody::enter(const Interval& interval, const Vector& base) {
  Body::enter(interval, base);
  inverse_mass_.resize(mass_.size());
  std::transform(mass_.begin(), mass_.end(), inverse_mass_.begin(), [](double m) { return 1.0 / m; });
  held_.clear();
  for (const HeldDof& h : interval.eliminated) {
    held_.push_back({slot(h.dof), h});
    inverse_mass_[held_.back().slot] = 0.0;
  }
  loads_.clear();
  for (int dof = 0; dof < static_cast<int>(model_.layout.part); ++dof) {
    const double force = interval.force[dof];
    const double slope = interval.force_rate.size() > 0 ? interval.force_rate[dof] : 0.0;
    if (force == 0.0 && slope == 0.0) continue;
    const std::size_t s = slot(dof);
    loads_.push_back({s, inverse_mass_[s] * force, inverse_mass_[s] * slope, force, slope});
  }
}

void EdgeBody::impose_prescribed(double t) {
  if (!interval_->moving) return;  // held where they were: their velocity and acceleration are exactly zero
  for (const Held& h : held_) {
    state_[u() + h.slot] = prescribed(h.dof, t, 0);
    state_[v() + h.slot] = prescribed(h.dof, t, 1);
  }
}

void EdgeBody::add_boundary(double h, const double* x_p, double* out_v) const {
  const double scale = h * form_.quarter_thickness;
  const auto difference = [&](const EdgeForm::Corner& c, int axis) {  // of g = w_lambda - w_mu = 2 a - b
    const double* next = x_p + 4 * static_cast<std::size_t>(c.next) + 2 * axis;
    const double* previous = x_p + 4 * static_cast<std::size_t>(c.previous) + 2 * axis;
    return 2 * (next[1] - previous[1]) - (next[0] - previous[0]);
  };
  for (const EdgeForm::Corner& c : form_.corners) {
    const std::size_t i = 2 * static_cast<std::size_t>(c.node);
    out_v[i] -= scale * inverse_mass_[i] * difference(c, 1);
    out_v[i + 1] += scale * inverse_mass_[i + 1] * difference(c, 0);
  }
}

void EdgeBody::fma(double h, std::span<const double> x, std::span<const double> base, const Forcing& forcing,
                   std::span<double> out, Result result) {
  ++counters_.force_evaluations;
  const SweepArrays arrays{x.data() + p(),    x.data() + v(),
                           base.data() + p(), base.data() + v(),
                           out.data() + p(),  out.data() + v(),
                           base.data() + u(), result == Result::step ? out.data() + u() : nullptr};
  sweep_(form_, inverse_mass_.data(), material_, h, arrays, 0, static_cast<std::int32_t>(form_.runs.size()));
  double* out_v = out.data() + v();
  add_boundary(h, x.data() + p(), out_v);
  const double constant = forcing.weight[0];
  const double linear = forcing.weight[0] * (forcing.t - interval_->begin) + forcing.weight[1];
  for (const Load& load : loads_)
    out_v[load.slot] += h * (constant * load.acceleration + linear * load.slope);
  if (interval_->moving) {
    for (const Held& held : held_) {
      double a = 0.0;
      for (int k = 0; k < 4; ++k) {
        if (forcing.weight[k] != 0.0) a += forcing.weight[k] * prescribed(held.dof, forcing.t, 2 + k);
      }
      out_v[held.slot] += h * a;
    }
  }
}

void EdgeBody::rheological_force(const double* x_p, Vector& force) {
  // The sweep with unit masses and h = -1 leaves F alone in out_v.
  static const SweepMaterial none;
  std::vector<double> unused(zeros_.size());
  const SweepArrays arrays{x_p,           zeros_.data(), zeros_.data(), zeros_.data(),
                           unused.data(), force.data(),  nullptr,       nullptr};
  sweep_(form_, ones_.data(), none, -1.0, arrays, 0, static_cast<std::int32_t>(form_.runs.size()));
  std::swap(ones_, inverse_mass_);
  add_boundary(-1.0, x_p, force.data());
  std::swap(ones_, inverse_mass_);
}

// Sums over edges: x^T J_lambda w = - sum over edges of dx^T S dw, x^T J_mu w = - sum of dx^T (S + trace(S)
// I) dw, and the boundary's antisymmetric part in both.
EnergySample EdgeBody::sample(double t) {
  const Material& material = model_.material;
  const double* xp = state_.data() + p();
  const double* xv = state_.data() + v();
  const double* xu = state_.data() + u();
  double ll = 0.0, mm = 0.0, vl = 0.0, vm = 0.0, kinetic = 0.0;
  for (const EdgeForm::Run& run : form_.runs) {
    const double* s = form_.s.data() + 3 * run.edge;
    const std::int32_t* neighbour = form_.neighbour.data() + run.edge;
    for (std::int32_t i = run.first; i < run.last; ++i) {
      const double* pi = xp + 4 * static_cast<std::size_t>(i);
      const double* vi = xv + 2 * static_cast<std::size_t>(i);
      kinetic += mass_[2 * static_cast<std::size_t>(i)] * (vi[0] * vi[0] + vi[1] * vi[1]);
      for (std::int32_t k = 0; k < run.valence; ++k, s += 3, ++neighbour) {
        if (*neighbour < i) continue;  // each edge once
        const double* pj = xp + 4 * static_cast<std::size_t>(*neighbour);
        const double* vj = xv + 2 * static_cast<std::size_t>(*neighbour);
        const double bx = pj[0] - pi[0], ax = pj[1] - pi[1], by = pj[2] - pi[2], ay = pj[3] - pi[3];
        const double lx = 1.5 * ax - 0.5 * bx, ly = 1.5 * ay - 0.5 * by;
        const double mx = 0.5 * (bx - ax), my = 0.5 * (by - ay);
        const double dx = vj[0] - vi[0], dy = vj[1] - vi[1];
        const double slx = (s[0] + s[1]) * lx + s[2] * ly, sly = s[2] * lx + (s[0] - s[1]) * ly;
        const double smx = (3 * s[0] + s[1]) * mx + s[2] * my, smy = s[2] * mx + (3 * s[0] - s[1]) * my;
        ll -= lx * slx + ly * sly;
        mm -= mx * smx + my * smy;
        vl -= dx * slx + dy * sly;
        vm -= dx * smx + dy * smy;
      }
    }
  }
  // x^T times the boundary's part of F, (h / 4) rot(w_next - w_previous): + for lambda, - for mu.
  for (const EdgeForm::Corner& c : form_.corners) {
    const double* next = xp + 4 * static_cast<std::size_t>(c.next);
    const double* previous = xp + 4 * static_cast<std::size_t>(c.previous);
    const double* pi = xp + 4 * static_cast<std::size_t>(c.node);
    const double* vi = xv + 2 * static_cast<std::size_t>(c.node);
    std::array<double, 4> d;
    for (int k = 0; k < 4; ++k) d[k] = next[k] - previous[k];
    const double lx = 1.5 * d[1] - 0.5 * d[0], ly = 1.5 * d[3] - 0.5 * d[2];
    const double mx = 0.5 * (d[0] - d[1]), my = 0.5 * (d[2] - d[3]);
    const double q = form_.quarter_thickness;
    ll += q * ((1.5 * pi[1] - 0.5 * pi[0]) * ly - (1.5 * pi[3] - 0.5 * pi[2]) * lx);
    mm -= q * (0.5 * (pi[0] - pi[1]) * my - 0.5 * (pi[2] - pi[3]) * mx);
    vl += q * (vi[0] * ly - vi[1] * lx);
    vm -= q * (vi[0] * my - vi[1] * mx);
  }

  EnergySample e;
  e.kinetic = 0.5 * kinetic;
  const auto branch = [&](double quadratic, double with_v, double ela, double vis, double decay) {
    if (ela == 0.0) return;
    e.stored += 0.5 * quadratic / ela;
    if (std::isinf(vis)) return;
    e.dissipated += quadratic / vis;
    e.dissipated_rate += 2.0 * (ela * with_v - decay * quadratic) / vis;
  };
  branch(ll, vl, material.lambda_ela, material.lambda_vis, material.lambda_rate());
  branch(mm, vm, material.mu_ela, material.mu_vis, material.mu_rate());
  const double s = t - interval_->begin;
  for (const Load& load : loads_) {
    e.load += (load.force + s * load.force_slope) * xu[load.slot];
    e.load_power += (load.force + s * load.force_slope) * xv[load.slot];
    e.load_slope += load.force_slope * xu[load.slot];
    e.load_slope_rate += load.force_slope * xv[load.slot];
  }
  if (interval_->moving) {
    // R = m b'' + F - f and its slope with F(w') for F(w).
    rheological_force(xp, force_);
    for (std::size_t i = 0; i < p_rate_.size(); ++i) {
      const std::size_t k = i % 4;
      p_rate_[i] = material_.growth[k] * xv[i / 4 * 2 + k / 2] + material_.own[k] * xp[i] +
                   material_.cross[k] * xp[i ^ 1];
    }
    rheological_force(p_rate_.data(), force_rate_);
    std::vector<double> external(mass_.size(), 0.0), external_rate(mass_.size(), 0.0);
    for (const Load& load : loads_) {
      external[load.slot] = load.force + s * load.force_slope;
      external_rate[load.slot] = load.force_slope;
    }
    for (const Held& h : held_) {
      const double a = prescribed(h.dof, t, 2);
      const double r = mass_[h.slot] * a + force_[h.slot] - external[h.slot];
      const double r_rate =
          mass_[h.slot] * prescribed(h.dof, t, 3) + force_rate_[h.slot] - external_rate[h.slot];
      e.constraints += r * xv[h.slot];
      e.constraints_rate += r_rate * xv[h.slot] + r * a;
    }
  }
  return e;
}

void EdgeBody::reaction(double t, Vector& out) {
  rheological_force(state_.data() + p(), force_);
  const Vector external = Body::external_force(t);
  out.setZero(static_cast<Eigen::Index>(model_.layout.part));
  for (const Held& h : held_) {
    out[h.dof.dof] = mass_[h.slot] * (interval_->moving ? prescribed(h.dof, t, 2) : 0.0) + force_[h.slot] -
                     external[h.dof.dof];
  }
}

}  // namespace rheo
