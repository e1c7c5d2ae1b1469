#include "schedule.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "full_spectrum.hpp"
#include "lanczos.hpp"
#include "timeline.hpp"

namespace rheo {
namespace {

constexpr std::size_t solvers_kept = 16;  // beyond it they are made again when their interval comes
constexpr std::size_t spectra_taken = 8;  // beyond it the free body's frequency bounds all

}  // namespace

bool has_columns(const Scene& scene) {
  const bool held = !scene.fixes.empty() || !scene.moves.empty();
  return !scene.constraints.empty() || (scene.time.constraints == ConstraintMethod::baumgarte && held);
}

Schedule::Schedule(const Scene& scene, const Model& model)
    : scene_(scene), model_(model), events_(event_times(scene)), holders_(holders_of(scene)) {
  for (const Traction& traction : scene.tractions) {
    std::map<int, double> weights;
    for (const Edge& edge : traction.edges) {
      const Vec2& p = scene.mesh.points[edge[0]];
      const Vec2& q = scene.mesh.points[edge[1]];
      const double half = 0.5 * scene.mesh.thickness * std::hypot(q.x - p.x, q.y - p.y);
      weights[edge[0]] += half;
      weights[edge[1]] += half;
    }
    patterns_.emplace_back(weights.begin(), weights.end());
  }
  std::set<Signature> distinct;
  for (std::size_t i = 0; i < events_.size(); ++i) distinct.insert(signature(i));
  for (const Signature& s : distinct) {
    const auto made = make_solver(s);
    if (solvers_.size() < solvers_kept) solvers_[s] = made;
  }
  make_spectrum({distinct.begin(), distinct.end()});
}

double Schedule::end(std::size_t i) const {
  return i + 1 < events_.size() ? events_[i + 1] : std::numeric_limits<double>::infinity();
}

double Schedule::middle(std::size_t i) const {
  return i + 1 < events_.size() ? 0.5 * (events_[i] + events_[i + 1])
                                : 2.0 * events_[i] + scene_.time.duration;
}

Schedule::Signature Schedule::signature(std::size_t i) const {
  Signature active;
  for (const Holder& holder : holders_) active.push_back(is_active(holder.window, middle(i)) ? 1 : 0);
  return active;
}

std::shared_ptr<const ConstraintSolver> Schedule::make_solver(const Signature& active) const {
  std::vector<HeldDof> held = held_dofs(holders_, active);
  std::vector<Column> columns;
  for (const Constraint& constraint : scene_.constraints) {
    Column column;
    for (const ConstraintTerm& term : constraint.terms) {
      column.entries.emplace_back(2 * term.node + (term.axis == Axis::y ? 1 : 0), term.coefficient);
    }
    column.value = constraint.value;
    column.where = constraint.where;
    columns.push_back(std::move(column));
  }
  if (scene_.time.constraints == ConstraintMethod::baumgarte) {
    for (const HeldDof& h : held) columns.push_back({{{h.dof, 1.0}}, 0.0, h.owner, holders_[h.owner].where});
    held.clear();
  }
  return std::make_shared<ConstraintSolver>(model_, held, std::move(columns));
}

std::shared_ptr<const ConstraintSolver> Schedule::solver(const Signature& active) {
  const auto known = solvers_.find(active);
  return known != solvers_.end() ? known->second : make_solver(active);
}

void Schedule::make_spectrum(const std::vector<Signature>& signatures) {
  const Material& material = scene_.material;
  Spectrum& s = spectrum_;
  s.lambda_on = material.lambda_ela > 0.0;
  s.mu_on = material.mu_ela > 0.0;
  s.lambda_rate = material.lambda_rate();
  s.mu_rate = material.mu_rate();
  // J_lambda never exceeds J_mu: (e_x + e_y)^2 <= 2 e_x^2 + 2 e_y^2 + g^2.
  if (s.lambda_on) s.lambda_share = material.lambda_ela / (material.lambda_ela + material.mu_ela);
  s.element_bound = model_.element_omega;
  double omega = 0.0;
  // Every set of constraints must give its eigenvalues, or none counts.
  bool eigenvalues = scene_.time.integrator == IntegratorKind::euler && s.lambda_on && s.mu_on &&
                     s.lambda_rate != s.mu_rate && signatures.size() <= spectra_taken;
  const auto include = [&](const ConstraintSolver& constrained) {
    if (eigenvalues) {
      const auto found = full_spectrum(model_, constrained);
      eigenvalues = !found.empty();
      s.eigenvalues.insert(s.eigenvalues.end(), found.begin(), found.end());
    }
    const RitzBound bound = largest_frequency(model_, constrained);
    omega = std::max(omega, bound.omega);
    s.lanczos_steps = std::max(s.lanczos_steps, bound.steps);
  };
  if (signatures.size() <= spectra_taken) {
    for (const Signature& active : signatures) include(*solver(active));
  } else {
    include(ConstraintSolver(model_, {}, {}));
  }
  s.omega_max = std::min(omega, s.element_bound);
  if (!eigenvalues) s.eigenvalues.clear();
  if (has_columns(scene_)) s.baumgarte = scene_.time.baumgarte;
}

Interval Schedule::interval(std::size_t i) {
  Interval result;
  result.begin = events_[i];
  const double inside = middle(i);
  const Signature active = signature(i);
  result.held = held_dofs(holders_, active);
  if (scene_.time.constraints == ConstraintMethod::automatic) result.eliminated = result.held;
  result.solver = solver(active);
  for (std::size_t k = 0; k < holders_.size(); ++k) {
    std::array<Polynomial, 2> course{};
    if (active[k] && holders_[k].move != nullptr) {
      course = piece_at(*holders_[k].move, inside);
      for (int axis = 0; axis < 2; ++axis) {
        if (holders_[k].axis == (axis == 0 ? Axis::y : Axis::x)) course[axis] = {};
        Polynomial change = course[axis];
        change.c[0] = 0.0;
        if (!change.is_zero()) result.moving = true;
      }
    }
    result.course.push_back(course);
  }

  const auto size = static_cast<Eigen::Index>(model_.layout.part);
  result.force.setZero(size);
  for (Eigen::Index n = 0; n < size / 2; ++n) {
    result.force[2 * n] = model_.node_mass[n] * scene_.body_acceleration.x;
    result.force[2 * n + 1] = model_.node_mass[n] * scene_.body_acceleration.y;
  }
  for (std::size_t k = 0; k < scene_.tractions.size(); ++k) {
    const Traction& traction = scene_.tractions[k];
    if (!is_active(traction.window, inside)) continue;
    const auto course = piece_at(traction, inside);
    for (int axis = 0; axis < 2; ++axis) {
      const double value = course[axis].value(result.begin);
      const double slope = course[axis].derivative(result.begin, 1);
      if (slope != 0.0 && result.force_rate.size() == 0) result.force_rate.setZero(size);
      for (const auto& [node, weight] : patterns_[k]) {
        result.force[2 * node + axis] += weight * value;
        if (slope != 0.0) result.force_rate[2 * node + axis] += weight * slope;
      }
    }
  }
  return result;
}

std::vector<Simulation::ActiveTraction> Schedule::active_tractions(std::size_t i, double t) const {
  std::vector<Simulation::ActiveTraction> result;
  const double inside = middle(i);
  for (std::size_t k = 0; k < scene_.tractions.size(); ++k) {
    if (!is_active(scene_.tractions[k].window, inside)) continue;
    const auto course = piece_at(scene_.tractions[k], inside);
    result.push_back({static_cast<int>(k), {course[0].value(t), course[1].value(t)}});
  }
  return result;
}

}  // namespace rheo
