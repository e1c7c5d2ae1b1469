#include "schedule.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>

#include "full_spectrum.hpp"
#include "lanczos.hpp"
#include "range_step.hpp"
#include "regions.hpp"
#include "step_choice.hpp"
#include "timeline.hpp"

namespace rheo {
namespace {

constexpr std::size_t solvers_kept = 16;   // beyond it they are made again when their interval comes
constexpr double rates_that_matter = 0.1;  // of the largest frequency: RK4 (design)
constexpr int most_for_rk4 = 96;           // eigenvalues, which take some ten milliseconds
constexpr std::size_t spectra_taken = 8;   // beyond it the free body's frequency bounds all

}  // namespace

Schedule::Schedule(const Scene& scene, const Model& model, double memory, Nearness nearness,
                   const std::function<void(double)>& searching)
    : scene_(scene),
      model_(model),
      memory_(memory),
      events_(event_times(scene)),
      holders_(holders_of(scene)) {
  for (const Traction& traction : scene.tractions) {
    load_pattern(scene.mesh, traction.edges, patterns_.emplace_back());
  }
  std::map<Signature, std::size_t> known;
  for (std::size_t i = 0; i < events_.size(); ++i) {
    const auto [place, is_new] = known.try_emplace(signature(i), sets_.size());
    set_of_.push_back(place->second);
    if (!is_new) continue;
    Held made = make_held(place->first);  // refuses what cannot be
    if (sets_.size() >= solvers_kept) made = {place->first, {}, nullptr};
    sets_.push_back(std::move(made));
  }
  make_spectrum(nearness, searching);
}

void load_pattern(const Mesh& mesh, std::span<const Edge> edges, LoadPattern& out) {
  out.clear();
  for (const Edge& edge : edges) {
    const Vec2& p = mesh.points[edge[0]];
    const Vec2& q = mesh.points[edge[1]];
    const double half = 0.5 * mesh.thickness_of(edge) * std::hypot(q.x - p.x, q.y - p.y);
    for (const int node : edge) out.emplace_back(node, half);
  }
  // By node, then by size: a sum does not depend on the order of the edges.
  std::sort(out.begin(), out.end());
  std::size_t last = 0;
  for (std::size_t k = 1; k < out.size(); ++k) {
    if (out[k].first == out[last].first) {
      out[last].second += out[k].second;
    } else {
      out[++last] = out[k];
    }
  }
  if (!out.empty()) out.resize(last + 1);
}

void add_traction(Interval& interval, const LoadPattern& pattern, const std::array<Polynomial, 2>& course) {
  for (int axis = 0; axis < 2; ++axis) {
    const double value = course[axis].value(interval.begin);
    const double slope = course[axis].derivative(interval.begin, 1);
    if (slope != 0.0 && interval.force_rate.size() == 0) interval.force_rate.setZero(interval.force.size());
    for (const auto& [node, weight] : pattern) {
      interval.force[2 * node + axis] += weight * value;
      if (slope != 0.0) interval.force_rate[2 * node + axis] += weight * slope;
    }
  }
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

std::vector<Column> Schedule::general_columns() const {
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
  return columns;
}

Schedule::Held Schedule::make_held(const Signature& active) const {
  Held result{active, held_dofs(holders_, active), nullptr};
  std::vector<HeldDof> eliminated = result.held;
  std::vector<Column> columns = general_columns();
  if (scene_.time.constraints == ConstraintMethod::baumgarte) {
    for (const HeldDof& h : result.held)
      columns.push_back({{{h.dof, 1.0}}, 0.0, h.owner, holders_[h.owner].where});
    eliminated.clear();
  }
  result.solver = std::make_shared<ConstraintSolver>(model_, eliminated, std::move(columns), memory_);
  return result;
}

std::shared_ptr<const ConstraintSolver> Schedule::solver_holding(std::size_t i,
                                                                 const std::vector<HeldDof>& held) {
  if (holding_is_free()) {
    if (!working_) working_ = std::make_shared<ConstraintSolver>(model_, held, std::vector<Column>{});
    working_->hold(held);
    return working_;
  }
  for (const Holding& known : holding_) {
    if (known.set == set_of_[i] &&
        std::equal(known.held.begin(), known.held.end(), held.begin(), held.end(),
                   [](const HeldDof& a, const HeldDof& b) { return a.dof == b.dof; }))
      return known.solver;
  }
  holding_.push_back(
      {set_of_[i], held, std::make_shared<ConstraintSolver>(model_, held, general_columns(), memory_)});
  return holding_.back().solver;
}

void Schedule::make_spectrum(Nearness nearness, const std::function<void(double)>& searching) {
  Spectrum& s = spectrum_;
  s.lambda_on = model_.layout.lambda;
  s.mu_on = model_.layout.mu;
  for (const BranchPart& branch : model_.layout.branches) {
    double& rate = branch.modulus == Modulus::lambda ? s.lambda_rate : s.mu_rate;
    rate = std::max(rate, branch.rate);
  }
  std::vector<Moduli> springs, dashpots;  // by region
  for (const Patch& patch : model_.patches) {
    springs.push_back(patch.material.instantaneous());
    dashpots.push_back(patch.material.viscous);
    // J_lambda never exceeds J_mu: (e_x + e_y)^2 <= 2 e_x^2 + 2 e_y^2 + g^2.
    const Moduli& own = springs.back();
    if (own.lambda > 0.0) s.lambda_share = std::max(s.lambda_share, own.lambda / (own.lambda + own.mu));
    s.viscous.lambda = std::max(s.viscous.lambda, dashpots.back().lambda);
    s.viscous.mu = std::max(s.viscous.mu, dashpots.back().mu);
  }
  s.element_bound = model_.element_omega;
  s.several_materials = model_.has_several_materials();
  const bool parallel = s.several_materials || model_.is_parallel();
  if (s.several_materials) {
    std::vector<Material> materials;
    for (const Patch& patch : model_.patches) {
      materials.push_back(patch.material);
      s.materials.push_back({relaxations_of(patch.material), patch.material.viscous});
    }
    for (const SharedRelaxation& each : relaxations_of(materials)) {
      Relaxation largest{each.rate, {}};
      for (const Moduli& moduli : each.moduli) {
        largest.moduli.lambda = std::max(largest.moduli.lambda, moduli.lambda);
        largest.moduli.mu = std::max(largest.moduli.mu, moduli.mu);
      }
      s.relaxations.push_back(largest);
    }
  } else {
    // Rates that differ by rounding are one: the branches are combined then.
    if (s.lambda_on && s.mu_on && combined(model_.material())) s.mu_rate = s.lambda_rate;
    if (parallel) s.relaxations = relaxations_of(model_.material());
  }
  const bool damped = model_.has_viscous_part();
  double omega = 0.0, damping = 0.0;
  // Every set of constraints must give its eigenvalues, or none counts.
  const bool rates_differ =
      parallel ? damped || s.relaxations.size() > 1 : s.lambda_on && s.mu_on && s.lambda_rate != s.mu_rate;
  const bool euler = scene_.time.integrator == IntegratorKind::euler;
  const bool rk4 = scene_.time.integrator == IntegratorKind::rk4;
  bool eigenvalues = rates_differ && (euler || rk4) && sets_.size() <= spectra_taken;
  const auto include = [&](const ConstraintSolver& constrained) {
    const RitzBound bound = largest_frequency(model_, constrained, springs);
    omega = std::max(omega, bound.omega);
    s.lanczos_steps = std::max(s.lanczos_steps, bound.steps);
    if (damped) {
      const double root = largest_frequency(model_, constrained, dashpots).omega;
      damping = std::max(damping, root * root);
    }
    // RK4's limit hangs on rates only where they are not small beside the vibrations.
    const bool rates_matter = euler || std::max(s.largest_rate(), damping) > rates_that_matter * bound.omega;
    if (eigenvalues && rates_matter) {
      const auto found =
          full_spectrum(scene_.mesh, model_, constrained, euler ? most_eigenvalues : most_for_rk4);
      eigenvalues = found.has_value();
      if (found) s.eigenvalues.insert(s.eigenvalues.end(), found->begin(), found->end());
    } else {
      eigenvalues = false;
    }
  };
  for_each_bounding_solver(include);
  s.omega_max = std::min(omega, s.element_bound);
  s.viscous_max = std::min(damping, model_.element_viscous);
  if (!eigenvalues) s.eigenvalues.clear();
  if (has_columns(scene_)) s.baumgarte = scene_.time.baumgarte;
  if (nearness != Nearness::safe) find_range_step(nearness, searching);
}

void Schedule::for_each_bounding_solver(const std::function<void(const ConstraintSolver&)>& visit) const {
  if (sets_.size() > spectra_taken) {
    visit(ConstraintSolver(model_, {}, {}));
    return;
  }
  for (const Held& set : sets_) visit(*set.solver);
}

void Schedule::find_range_step(Nearness nearness, const std::function<void(double)>& searching) {
  Spectrum& s = spectrum_;
  const IntegratorKind integrator = scene_.time.integrator;
  if (!stable_step_is_bound(s, integrator)) return;
  const bool is_euler = integrator == IntegratorKind::euler;
  // RK4's limit is omega_max's but for rates beside it.
  if (!is_euler && std::max(s.largest_rate(), s.viscous_max) <= rates_that_matter * s.omega_max) return;
  const double surely = stable_step(s, integrator);
  if (scene_.time.step > 0.0 && scene_.time.step <= surely) return;
  // Baumgarte's pole is the limit, or nearly.
  if (s.baumgarte > 0.0 && surely > 0.97 * stable_step_of(-s.baumgarte, integrator)) {
    if (is_euler) s.near_euler_step = surely;
    return;
  }
  // (Other eigenvalues than the free body's take the place of the sets' own.)
  const bool by_discs = is_euler && nearness == Nearness::near && sets_.size() <= spectra_taken &&
                        NearbyEigenvalues::can_take(model_, memory_);
  std::optional<Model> assembled;
  double step = std::numeric_limits<double>::infinity(), near_step = step;
  std::size_t set = 0;
  for_each_bounding_solver([&](const ConstraintSolver& solver) {
    DiscSearch discs;
    discs.most_work /= static_cast<double>(sets_.size());
    discs.eigenvalues = [&] {
      const bool has_matrices = !model_.edges && !model_.elements;
      if (!has_matrices && !assembled) assembled.emplace(scene_.mesh, regions_of(scene_));
      return NearbyEigenvalues(scene_.mesh, has_matrices ? model_ : *assembled, solver);
    };
    if (searching) {
      discs.told = [&](double part) {
        searching((static_cast<double>(set) + part) / static_cast<double>(sets_.size()));
      };
    }
    const bool is_asked_for = step > surely || near_step > 0.0;
    const RangeStep found =
        is_asked_for ? range_step(model_, solver, s, integrator, surely, by_discs ? &discs : nullptr)
                     : RangeStep{};
    step = std::min(step, found.step);
    near_step = std::min(near_step, found.near_step);
    ++set;
  });
  if (step > surely) (is_euler ? s.euler_step : s.rk4_step) = step;
  if (near_step > 0.0 && std::isfinite(near_step)) s.near_euler_step = near_step;
}

void Schedule::courses(const Signature& active, double inside,
                       std::vector<std::array<Polynomial, 2>>& out) const {
  out.clear();
  for (std::size_t k = 0; k < holders_.size(); ++k) {
    std::array<Polynomial, 2> course{};
    if (active[k] && holders_[k].move != nullptr) {
      course = piece_at(*holders_[k].move, inside);
      if (holders_[k].axis != Axis::both) course[holders_[k].axis == Axis::x ? 1 : 0] = {};
    }
    out.push_back(course);
  }
}

void Schedule::fill(std::size_t i, double begin, Interval& result) {
  result.begin = begin;
  const double inside = middle(i);
  const Held* set = &sets_[set_of_[i]];
  if (!set->solver) {
    if (unkept_.active != set->active) unkept_ = make_held(set->active);
    set = &unkept_;
  }
  const Signature& active = set->active;
  result.held = set->held;
  result.eliminated.clear();
  if (scene_.time.constraints == ConstraintMethod::automatic) result.eliminated = result.held;
  result.solver = set->solver;
  courses(active, inside, result.course);
  result.moving = std::any_of(result.course.begin(), result.course.end(), [](const auto& course) {
    return std::any_of(course.begin(), course.end(), [](Polynomial change) {
      change.c[0] = 0.0;
      return !change.is_zero();
    });
  });

  const auto size = static_cast<Eigen::Index>(model_.layout.part);
  result.force.setZero(size);
  if (result.force_rate.size() > 0) result.force_rate.setZero();
  for (Eigen::Index n = 0; n < size / 2; ++n) {
    result.force[2 * n] = model_.node_mass[n] * scene_.body_acceleration.x;
    result.force[2 * n + 1] = model_.node_mass[n] * scene_.body_acceleration.y;
  }
  for (std::size_t k = 0; k < scene_.tractions.size(); ++k) {
    const Traction& traction = scene_.tractions[k];
    if (!is_active(traction.window, inside)) continue;
    add_traction(result, patterns_[k], piece_at(traction, inside));
  }
}

double resolving_bound(const TimeSettings& settings, std::span<const std::array<Polynomial, 2>> courses,
                       double bound) {
  constexpr double steps_a_motion = 16.0;
  if (settings.step > 0.0 || takes_long_steps(settings.integrator)) return bound;
  for (const auto& course : courses) {
    for (const Polynomial& p : course) {
      if (p.c[5] == 0.0) continue;  // of degree three at most: exact but for the body's answer
      const double length = 0.4 * std::abs(p.c[4] / p.c[5]);  // of d (10 s^3 - 15 s^4 + 6 s^5)
      bound = std::min(bound, length / steps_a_motion);
    }
  }
  return bound;
}

std::int64_t Schedule::planned_steps(double bound) const {
  const TimeSettings& settings = scene_.time;
  std::int64_t steps = 0;
  double t = 0.0;
  std::size_t interval = 0;
  double here = bound;
  std::vector<std::array<Polynomial, 2>> course;
  const auto look = [&] {
    if (scene_.moves.empty()) return;
    courses(signature(interval), middle(interval), course);
    here = resolving_bound(settings, course, bound);
  };
  look();
  const auto run_to = [&](double target) {
    while (t < target && !same_time(t, target)) {
      const double event = end(interval);
      const bool passes = event <= target || same_time(event, target);
      const double stop = passes ? event : target;
      steps += steps_in(stop - t, settings.refinement, here);
      t = stop;
      if (!passes) continue;
      ++interval;
      look();
    }
  };
  for (std::int64_t k = 0; k < output_count(settings); ++k) run_to(output_time(settings, k));
  run_to(settings.duration);
  return steps;
}

void Schedule::active_tractions(std::size_t i, double t, std::vector<Simulation::ActiveTraction>& out) const {
  out.clear();
  const double inside = middle(i);
  for (std::size_t k = 0; k < scene_.tractions.size(); ++k) {
    if (!is_active(scene_.tractions[k].window, inside)) continue;
    const auto course = piece_at(scene_.tractions[k], inside);
    out.push_back({static_cast<int>(k), {course[0].value(t), course[1].value(t)}});
  }
}

}  // namespace rheo
