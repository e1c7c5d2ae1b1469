#include "stepping.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "kernels/flush_denormals.hpp"
#include "timeline.hpp"

namespace rheo {
namespace {

// Of all energy that ever went in: what is left below it cannot move the body by a rounding of its course.
constexpr double energy_at_rest = 1e-32;
constexpr double way_at_rest = 1e-14;  // of u under loads: some roundings (RestWatch)
constexpr double tolerance_at_rest =
    0.1;  // of the exponential integrator's, beside which less cannot be seen
constexpr std::int64_t steps_between_looks = 64;  // a multiple of every stride
constexpr std::int64_t steps_before_a_look = 16;  // where a stretch of steps begins
constexpr double violation_allowed = 0.01;        // of a constraint's coefficients times the largest |u|
// A pole that the step hardly resolves lets a violation swing to some multiple of its start before it decays.
constexpr double violation_swing = 100.0;
constexpr double motion_lag = 20.0;  // of a motion's way: what one step over all of it makes of it
// Where constraints do work, its quadrature can miss what happens within a step: a whole motion, a ringing.
// Energy beyond it is then taken for explained, up to so many times and with room for so much more each time;
// an unstable run uses that up within some tens of steps.
constexpr int most_excuses = 12;
constexpr double excused_growth = 4.0;
// Where the step is beyond the stable one: of the energy that went in, where the work is known to rounding;
// where constraints pull the body to where they hold it; and by how much Euler's energy may rise before it
// falls.
constexpr double unstable_slack = 1e-6;
constexpr double unstable_slack_of_pulls = 1e-2;
// The norm of one of Euler's stable steps may be larger than 1. Measured at 0.99 of the limit: 2.3e-2
// (rheo_stress).
constexpr double euler_overshoot = 0.03;
constexpr double cancelled_rounding = 1e-12;  // of loads and constraint forces that cancel each other
// Of the way that unresisted loads would make in a step: constraint forces cancel them but for rounding.
constexpr double cancelled_loads = 1e-6;

// The first node whose velocity is no number, or the one with the largest.
int fastest_node(const VectorMap& v) {
  double fastest = -1.0;
  Eigen::Index found = 0;
  for (Eigen::Index node = 0; node < v.size() / 2; ++node) {
    const double speed = std::hypot(v[2 * node], v[2 * node + 1]);
    if (!std::isfinite(speed)) return static_cast<int>(node);
    if (speed > fastest) {
      fastest = speed;
      found = node;
    }
  }
  return static_cast<int>(found);
}

std::vector<Material> materials_of(const Model& model) {
  std::vector<Material> all;
  for (const Patch& patch : model.patches) all.push_back(patch.material);
  return all;
}

}  // namespace

Stepping::Stepping(const Scene& scene, const Model& model, Schedule& schedule, Body& body,
                   Integrator& integrator, StepLimits limits, std::int64_t stride)
    : scene_(scene),
      model_(model),
      schedule_(schedule),
      body_(body),
      integrator_(integrator),
      limits_(limits),
      stride_(stride),
      readings_(model, body),
      rest_(materials_of(model), model.layout.part,
            scene.time.integrator == IntegratorKind::exponential
                ? std::max(way_at_rest, tolerance_at_rest * scene.time.tolerance)
                : way_at_rest),
      holds_(model, scene.constraints.size()) {
  enter(0);
}

// Where steps are long, the loads' part alone, by parts, is exact for constant loads.
bool Stepping::books_work() const {
  return !takes_long_steps(scene_.time.integrator) ||
         (scene_.moves.empty() && std::all_of(scene_.tractions.begin(), scene_.tractions.end(),
                                              [](const Traction& t) { return t.keys.size() == 1; }));
}
// Their work is exact by parts, and nothing else does any.
bool Stepping::has_constant_loads() const {
  return hands_ == nullptr && scene_.moves.empty() &&
         std::all_of(scene_.tractions.begin(), scene_.tractions.end(),
                     [](const Traction& t) { return t.keys.size() == 1; });
}
// Likewise: nothing, or unknown.
bool Stepping::books_dissipated() const {
  return !takes_long_steps(scene_.time.integrator) ||
         (std::all_of(model_.layout.branches.begin(), model_.layout.branches.end(),
                      [](const BranchPart& branch) { return branch.rate == 0.0; }) &&
          !model_.has_viscous_part());
}

void Stepping::enter(std::size_t i) {
  index_ = i;
  enter_from(schedule_.begin(i));
}

// Passes an event, or the hands' change of mind in the current interval: new loads and constraints, and the
// velocity's jump where a constraint begins or its b' jumps.
void Stepping::enter_from(double begin) {
  const bool first = !entered_;
  entered_ = true;
  rest_.restart();
  resting_ = false;
  schedule_.fill(index_, begin, next_);
  if (hands_ != nullptr && hands_->add_to(next_)) next_.solver = schedule_.solver_holding(index_, next_.held);
  if (holds_.change_owners(next_, hands_)) readings_.state();
  const double* const y = readings_.last_state().data();
  const bool begins =
      holds_.find_jumps(interval_, next_, y + model_.layout.u(), y + model_.layout.v()) || first;
  const bool other_constraints = next_.solver != interval_.solver;
  std::swap(interval_, next_);
  body_.enter(interval_, holds_.base());
  bool projected = false;
  if (begins) {
    const auto general = first ? Holds::General::begin : Holds::General::go_on;
    if (const auto work = holds_.project(interval_, general, readings_.v())) {
      book_.book_impulse(*work);
      ++body_.counters().projections;
      body_.load(readings_.state());
      projected = true;
    }
  }
  body_.impose_prescribed(time_);
  if (projected) {
    readings_.state_changed();
  } else {
    readings_.loads_changed();
  }
  if (begins || other_constraints) note_violations();
  if (interval_.moving) note_motions();
  if (is_beyond_limit()) {
    const EnergySample& now = readings_.sample(time_);
    begun_ = {now.kinetic + now.stored, book_.work(), book_.turnover(), book_.net_turnover(), 0.0};
  }
}

double Stepping::violation(std::size_t column) {
  const Column& c = interval_.solver->columns()[column];
  return interval_.solver->row_times(column, readings_.u().data()) - body_.column_value(c, time_, 0);
}

// How far each general constraint is from fulfilled where a set of them begins; from here it decays, if not
// at once.
void Stepping::note_violations() {
  const std::size_t columns = interval_.solver->columns().size();
  allowed_violation_.assign(columns, 0.0);
  for (std::size_t j = 0; j < columns; ++j) allowed_violation_[j] = violation_swing * std::abs(violation(j));
}

// What a motion goes by until the next event: a step that is long beside it may lag by as much, and
// Baumgarte's terms catch up.
void Stepping::note_motions() {
  const double end = schedule_.end(index_);
  if (!std::isfinite(end)) return;
  for (std::size_t j = 0; j < allowed_violation_.size(); ++j) {
    const Column& c = interval_.solver->columns()[j];
    const double way = body_.column_value(c, end, 0) - body_.column_value(c, time_, 0);
    allowed_violation_[j] = std::max(allowed_violation_[j], motion_lag * std::abs(way));
  }
}

// Nothing is moved and nothing that acts changes; without loads, what is left of the energy is nothing beside
// what went in; under loads or general constraints, RestWatch.
bool Stepping::looks_at_rest() {
  steps_since_look_ = 0;
  if (interval_.moving || !(interval_.force_rate.array() == 0.0).all()) return false;
  const bool general = !interval_.solver->columns().empty();
  if (!general && (interval_.force.array() == 0.0).all()) {
    const EnergySample& now = readings_.sample(time_);
    return now.kinetic + now.stored <= energy_at_rest * book_.turnover();
  }
  const auto numbers = [](const VectorMap& x) {
    return std::span<const double>(x.data(), static_cast<std::size_t>(x.size()));
  };
  return rest_.look(time_, numbers(readings_.u()), numbers(readings_.v()),
                    general ? scene_.time.baumgarte : 0.0);
}

// (Residual forces of a rigid motion hold no energy and may still be large.)
void Stepping::pass_at_rest(double end, std::int64_t steps) {
  const std::span<double> y = readings_.state();
  for (const BranchPart& branch : model_.layout.branches) {
    VectorMap(y.data() + branch.offset, static_cast<Eigen::Index>(branch.size)) *=
        std::exp(-branch.rate * (end - time_));
  }
  body_.load(y);
  body_.counters().steps_at_rest += steps;
  time_ = end;
  readings_.state_changed();
}

std::int64_t Stepping::steps_to(double end) const {
  return steps_in(end - time_, scene_.time.refinement,
                  resolving_bound(scene_.time, interval_.course, limits_.bound));
}

std::optional<Divergence> Stepping::run_segment(double end) {
  const double start = time_;
  const std::int64_t n = steps_to(end);
  // Long steps cost many times what a look does.
  const bool long_steps = takes_long_steps(scene_.time.integrator);
  const std::int64_t stride = long_steps ? 1 : stride_;
  const std::int64_t between_looks = long_steps ? 1 : steps_between_looks;
  const bool looks = steps_since_look_ == 0 || steps_since_look_ >= steps_before_a_look || long_steps;
  if (!resting_ && looks) resting_ = looks_at_rest();
  if (resting_) {
    pass_at_rest(end, n);
    return std::nullopt;
  }
  const double h = (end - start) / static_cast<double>(n);
  largest_step_ = std::max(largest_step_, h);
  readings_.sample(time_);
  for (std::int64_t k = 0; k < n; ++k) {
    integrator_.step(body_, time_, h, body_.state(), body_.known_rate());
    if (!integrator_.converged()) {
      readings_.state_changed();
      return divergence_now();
    }
    time_ = k + 1 == n ? end : start + static_cast<double>(k + 1) * h;
    ++body_.counters().steps;
    ++steps_since_look_;
    if (FlushDenormals::is_on()) ++body_.counters().flushed_steps;
    body_.impose_prescribed(time_);
    readings_.state_changed();
    if ((k + 1) % stride != 0 && k + 1 != n) continue;
    const EnergySample before = readings_.last_sample();
    const double since = readings_.last_sample_time();
    const EnergySample& now = readings_.sample(time_);
    book_.book_step(before, now, time_ - since);
    const auto power = [](const EnergySample& sample) {
      return std::abs(sample.load_power + sample.constraints);
    };
    begun_.late = std::max(begun_.late, 2 * h * std::max(power(before), power(now)));
    if (auto found = check_divergence()) return found;
    if ((k + 1) % between_looks != 0 || k + 1 == n) continue;
    resting_ = looks_at_rest();
    if (resting_) {
      pass_at_rest(end, n - (k + 1));
      break;
    }
  }
  return std::nullopt;
}

std::optional<Divergence> Stepping::check_divergence() {
  const EnergySample& now = readings_.sample(time_);
  const double energy = now.kinetic + now.stored;
  // Where the work is not known, the integrator's own error control stands guard.
  bool fine = books_work() ? energy <= explained_energy()  // false for NaN
                           : std::isfinite(energy);
  const bool work_by_constraints = interval_.moving || !interval_.solver->columns().empty();
  if (!fine && !is_beyond_limit() && work_by_constraints && std::isfinite(energy) &&
      excuses_ < most_excuses) {
    ++excuses_;
    book_.allow(excused_growth * energy);
    fine = true;
  }
  const double reach =
      allowed_violation_.empty() ? 0.0 : std::max(readings_.u().lpNorm<Eigen::Infinity>(), cancelled_way());
  for (std::size_t j = 0; fine && j < allowed_violation_.size(); ++j) {
    double size = 0.0;
    for (const auto& entry : interval_.solver->columns()[j].entries) size += std::abs(entry.second) * reach;
    fine = std::abs(violation(j)) <= allowed_violation_[j] + violation_allowed * size;
  }
  if (fine) return std::nullopt;
  return divergence_now();
}

// Beyond the limit what matters is what the body held when the loads and constraints of now began: what was
// spent before must not excuse what grows.
double Stepping::explained_energy() const {
  if (!is_beyond_limit() || !has_constant_loads()) return book_.work() + book_.turnover();
  const bool euler = scene_.time.integrator == IntegratorKind::euler;
  // Constraints that hold from the start do no work, and what a pole of theirs feeds is no excuse.
  const bool pulls = std::any_of(scene_.constraints.begin(), scene_.constraints.end(),
                                 [](const Constraint& c) { return c.value != 0.0; });
  const double overshoot = euler ? euler_overshoot : unstable_slack;
  const double done = book_.work() - begun_.work;
  const double slack = !pulls ? unstable_slack : euler ? 1.0 : unstable_slack_of_pulls;
  return (1.0 + overshoot) * (begun_.energy + std::max(done, 0.0)) + std::min(done, 0.0) +
         (euler ? begun_.late : 0.0) + slack * (book_.net_turnover() - begun_.net_turnover) +
         cancelled_rounding * (book_.turnover() - begun_.turnover);
}

// How far rounding may have moved a body whose constraints held against all of its loads.
double Stepping::cancelled_way() {
  const std::span<const double> force = readings_.external_force(time_);
  double fastest = 0.0;
  for (std::size_t dof = 0; dof < force.size(); ++dof)
    fastest = std::max(fastest, std::abs(force[dof]) / model_.node_mass[static_cast<Eigen::Index>(dof / 2)]);
  cancelled_way_ = std::max(cancelled_way_, cancelled_loads * fastest * largest_step_ * largest_step_);
  return cancelled_way_;
}

Divergence Stepping::divergence_now() {
  const EnergySample& now = readings_.sample(time_);
  Divergence d{time_, 0, now.kinetic + now.stored, explained_energy(), limits_.stable};
  d.node = fastest_node(readings_.v());
  return d;
}

void Stepping::attach(Hands& hands, StepLimits limits) {
  hands_ = &hands;
  limits_ = limits;
  for (Interval* i : {&interval_, &next_}) {
    i->force_rate.setZero(static_cast<Eigen::Index>(model_.layout.part));
    i->course.reserve(schedule_.holder_count() + hands.owner_count());
    i->held.reserve(model_.layout.part);
    i->eliminated.reserve(model_.layout.part);
  }
  readings_.reserve_reactions();
  hands.prepare(schedule_);
  enter_now();
}

void Stepping::resume(double t, std::span<const double> y, const std::optional<Energies>& before) {
  std::copy(y.begin(), y.end(), readings_.state().begin());
  body_.load(y);
  readings_.state_changed();
  readings_.state();
  diverged_.reset();
  book_ = {};
  holds_.forget();
  excuses_ = 0;
  entered_ = false;
  index_ = 0;
  while (schedule_.end(index_) <= t || same_time(schedule_.end(index_), t)) ++index_;
  time_ = t;
  enter_from(t);
  // What it holds has gone in before.
  const EnergySample& now = readings_.sample(time_);
  book_.allow(now.kinetic + now.stored);
  if (!before) return;
  const double jump = (now.kinetic + now.stored) - (before->kinetic + before->stored);
  book_.go_on(before->dissipated, before->work + jump - book_.work());
}

std::optional<Divergence> Stepping::advance(double t) {
  assert(t >= time_ || same_time(t, time_));
  const FlushDenormals flush;
  while (!diverged_ && time_ < t && !same_time(time_, t)) {
    const double event = schedule_.end(index_);
    const bool passes = event <= t || same_time(event, t);
    diverged_ = run_segment(passes ? event : t);
    if (!diverged_ && passes) enter(index_ + 1);
  }
  return diverged_;
}

}  // namespace rheo
