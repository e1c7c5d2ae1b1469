#include "rheo/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "assembled_body.hpp"
#include "energy_book.hpp"
#include "hands.hpp"
#include "holds.hpp"
#include "kernels/edge_body.hpp"
#include "kernels/element_body.hpp"
#include "kernels/flush_denormals.hpp"
#include "model.hpp"
#include "rheo/error.hpp"
#include "schedule.hpp"
#include "shifted_body.hpp"
#include "timeline.hpp"

namespace rheo {
namespace {

constexpr double most_steps = 1e15;  // counted exactly by a double, and beyond any patience
constexpr double not_asked = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t unasked_stride = 16;  // steps between looks at the energy where nobody asks for it
// Of all energy that ever went in: what is left below it cannot move the body by a rounding of its course.
constexpr double energy_at_rest = 1e-32;
constexpr double violation_allowed = 0.01;  // of a constraint's coefficients times the largest |u|
const Scene& validated(const Scene& scene) {
  validate(scene);
  return scene;
}

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

// An integrator that is to be chosen without an accuracy is RK4.
Scene decided(Scene scene, const std::optional<AccuracyPlan>& plan) {
  if (plan) return with_plan(std::move(scene), *plan);
  if (scene.time.integrator == IntegratorKind::automatic) scene.time.integrator = IntegratorKind::rk4;
  return scene;
}

// The fastest kernel that the scene's mass and constraints allow, unless one is asked for.
Assembly assembly_for(const Scene& scene, Kernel kernel) {
  const bool implicit = scene.time.integrator == IntegratorKind::implicit;
  const bool asked = kernel == Kernel::edge || kernel == Kernel::element;
  const char* name = kernel == Kernel::edge ? "edge" : "element";
  if (asked && implicit) {
    throw Error(
        Error::Kind::input,
        fmt::format("kernel {} has no matrices, which integrator = \"implicit\" factors: use auto or csr",
                    name));
  }
  const bool by_nodes = scene.material.mass == Mass::lumped && !has_columns(scene) && !implicit;
  if (asked && !by_nodes) {
    throw Error(Error::Kind::input,
                fmt::format("kernel {} needs mass = \"lumped\" and constraints = \"auto\" without "
                            "[[constraint]]: use auto or csr",
                            name));
  }
  if (kernel == Kernel::element) return Assembly::elements;
  return by_nodes && kernel != Kernel::csr ? Assembly::edges : Assembly::matrices;
}

}  // namespace

struct Simulation::Impl {
  Impl(Scene&& s, const SimulationOptions& options)
      : plan(s.time.accuracy != 0.0 ? std::optional(plan_accuracy(s, options)) : std::nullopt),
        scene(decided(std::move(s), plan)),
        model(validated(scene).mesh, scene.material, assembly_for(scene, options.kernel)),
        asked(options),
        schedule(scene, model),
        spectrum(schedule.spectrum()),
        body(make_body(options.threads)),
        integrator(make_integrator(scene.time.integrator, body->size(), exponential_settings())),
        stride(options.energies ? 1 : unasked_stride),
        y(model.layout.size(), 0.0),
        zeros(model.layout.part, 0.0),
        holds(model, scene.constraints.size()) {
    choose_step(options);
    enter(0);
  }

  // Refuses with the place in the scene file where there is one.
  [[noreturn]] void refuse_step(const std::string& text) const {
    const std::string& where = scene.time.where;
    throw Error(Error::Kind::input, where.empty() ? text : where + " " + text);
  }

  bool exponential() const { return scene.time.integrator == IntegratorKind::exponential; }
  bool implicit() const { return scene.time.integrator == IntegratorKind::implicit; }
  // No stable limit: steps go from event to event and output to output, too long for a quadrature.
  bool takes_long_steps() const { return exponential() || implicit(); }

  // The tolerance is that of the run: errors of its steps add up at worst.
  ExponentialSettings exponential_settings() const {
    const TimeSettings& settings = scene.time;
    if (exponential() && has_columns(scene)) {
      throw Error(Error::Kind::input,
                  "integrator = \"exponential\" needs constraints = \"auto\" without [[constraint]]: use "
                  "\"rk4\" or \"implicit\"");
    }
    const double rate =
        settings.step > 0.0 ? std::max(settings.frame_rate, 1.0 / settings.step) : settings.frame_rate;
    const double steps = std::ceil(settings.duration * rate) + static_cast<double>(schedule.interval_count());
    return {
        spectrum.omega_max,
        std::max(spectrum.lambda_on ? spectrum.lambda_rate : 0.0, spectrum.mu_on ? spectrum.mu_rate : 0.0),
        settings.tolerance / steps};
  }

  // Whether the quadrature over a step gives all of the work: where steps are long,
  // the loads' part alone, by parts, is exact for constant loads.
  bool books_work() const {
    return !takes_long_steps() ||
           (scene.moves.empty() && std::all_of(scene.tractions.begin(), scene.tractions.end(),
                                               [](const Traction& t) { return t.keys.size() == 1; }));
  }
  // Likewise what is dissipated: nothing, or unknown.
  bool books_dissipated() const {
    return !takes_long_steps() || ((!spectrum.lambda_on || spectrum.lambda_rate == 0.0) &&
                                   (!spectrum.mu_on || spectrum.mu_rate == 0.0));
  }

  void choose_step(const SimulationOptions& options) {
    const TimeSettings& settings = scene.time;
    limit = rheo::stable_step(spectrum, settings.integrator);
    const std::string name(integrator->name());
    const bool given = settings.step > 0.0;
    if (limit == 0.0 && !(given && options.allow_unstable)) {
      refuse_step(fmt::format(
          "integrator = \"{}\": no step of it is stable here, some vibrations are not damped: use "
          "\"rk4\", or give a step and allow it (--allow-unstable)",
          name));
    }
    if (given && settings.step > limit * (1.0 + 1e-12) && !options.allow_unstable) {
      refuse_step(fmt::format(
          "step = {:g} s: beyond the largest {} of {}, {:.6g} s: take a smaller one or "
          "\"auto\", or allow it (--allow-unstable)",
          settings.step,
          stable_step_is_bound(spectrum, settings.integrator) ? "step that is surely stable" : "stable step",
          name, limit));
    }
    bound = given ? settings.step : takes_long_steps() ? limit : options.stable_share * limit;
    if (!(settings.refinement * settings.duration / bound < most_steps)) {
      refuse_step(
          fmt::format("step = {}: {:g} s needs {:.2g} steps for the duration of {:g} s, at most {:g} can be "
                      "counted: check the material's moduli and density and the mesh's size",
                      given ? fmt::format("{:g}", settings.step) : "\"auto\"", bound,
                      settings.duration / bound, settings.duration, most_steps));
    }
  }

  std::unique_ptr<Body> make_body(int threads) const {
    if (model.edges) return std::make_unique<EdgeBody>(model, *model.edges, threads);
    if (model.elements) return std::make_unique<ElementBody>(model, *model.elements, threads);
    if (implicit()) {
      require_few_general_constraints(scene);
      return std::make_unique<ShiftedBody>(model, scene.time.baumgarte);
    }
    return std::make_unique<AssembledBody>(model, scene.time.baumgarte);
  }

  VectorMap u() {
    fetch();
    return {y.data() + model.layout.u(), static_cast<Eigen::Index>(model.layout.part)};
  }
  VectorMap v() {
    fetch();
    return {y.data() + model.layout.v(), static_cast<Eigen::Index>(model.layout.part)};
  }

  // Passes an event: new loads and constraints, and the velocity's jump where a constraint begins or its b'
  // jumps.
  void enter(std::size_t i) {
    index = i;
    enter_from(schedule.begin(i));
  }

  // The same at a time in the current interval, where only the hands changed what they do.
  void enter_from(double begin) {
    const bool first = !entered;
    entered = true;
    schedule.fill(index, begin, next);
    if (hands != nullptr && hands->add_to(next)) next.solver = schedule.solver_holding(index, next.held);
    if (holds.change_owners(next, hands)) fetch();
    const bool begins =
        holds.find_jumps(interval, next, y.data() + model.layout.u(), y.data() + model.layout.v()) || first;
    const bool other_constraints = next.solver != interval.solver;
    std::swap(interval, next);
    body->enter(interval, holds.base());
    bool projected = false;
    if (begins) {
      const auto general = first ? Holds::General::begin : Holds::General::go_on;
      if (const auto work = holds.project(interval, general, v())) {
        book.book_impulse(*work);
        ++body->counters().projections;
        body->load(y);
        projected = true;
      }
    }
    body->impose_prescribed(time);
    const bool known = sampled && !projected;
    changed();
    state_sampled = known;  // but for the loads and constraints, the last sample holds
    if (begins || other_constraints) note_violations();
  }

  double violation(std::size_t column) {
    const Column& c = interval.solver->columns()[column];
    return interval.solver->row_times(column, u().data()) - body->column_value(c, time, 0);
  }

  // How far each general constraint is from fulfilled where a set of them begins; from here it may only
  // decay.
  void note_violations() {
    const std::size_t columns = interval.solver->columns().size();
    allowed_violation.assign(columns, 0.0);
    for (std::size_t j = 0; j < columns; ++j) allowed_violation[j] = 2.0 * std::abs(violation(j));
  }

  // The body's state is another one now.
  void changed() {
    y_current = false;
    sampled = state_sampled = false;
    reaction_known = false;
  }

  // y, the state in the mesh's order.
  void fetch() {
    if (y_current) return;
    body->store(y);
    y_current = true;
  }

  void sample_now() {
    if (sampled) return;
    if (state_sampled) {
      body->resample(time, sample);
    } else {
      sample = body->sample(time);
      ++body->counters().energy_samples;
    }
    sample_time = time;
    sampled = state_sampled = true;
  }

  void know_reaction_at(std::span<const HeldDof> held) {
    if (!reaction_known) body->reaction_at(time, held, reaction);
  }

  void know_reaction() {
    if (reaction_known) return;
    body->reaction(time, reaction);
    body->external_force(time, external);
    reaction_known = true;
  }

  // Nothing acts, nothing is moved, and what is left of the energy is nothing beside what went in.
  bool at_rest() {
    if (interval.moving || !interval.solver->columns().empty()) return false;
    if (!(interval.force.array() == 0.0).all() || !(interval.force_rate.array() == 0.0).all()) return false;
    sample_now();
    return sample.kinetic + sample.stored <= energy_at_rest * book.turnover();
  }

  // At rest, v = 0, residual forces decay by their own rates: w' = - rate w, exactly. (Those of a rigid
  // motion hold no energy and may still be large.)
  void pass_at_rest(double end) {
    const auto decay = [&](std::size_t offset, double rate) {
      VectorMap(y.data() + offset, static_cast<Eigen::Index>(model.layout.part)) *=
          std::exp(-rate * (end - time));
    };
    fetch();
    if (model.layout.lambda) decay(model.layout.w_lambda(), model.material.lambda_rate());
    if (model.layout.mu) decay(model.layout.w_mu(), model.material.mu_rate());
    body->load(y);
    body->counters().steps_at_rest += steps_to(end);
    time = end;
    changed();
  }

  std::int64_t steps_to(double end) const { return steps_in(end - time, scene.time.refinement, bound); }

  std::optional<Divergence> run_segment(double end) {
    const double start = time;
    if (at_rest()) {
      pass_at_rest(end);
      return std::nullopt;
    }
    const std::int64_t n = steps_to(end);
    const double h = (end - start) / static_cast<double>(n);
    largest_step = std::max(largest_step, h);
    sample_now();
    for (std::int64_t k = 0; k < n; ++k) {
      integrator->step(*body, time, h, body->state(), body->known_rate());
      if (!integrator->converged()) {
        changed();
        sample_now();
        return divergence_now();
      }
      time = k + 1 == n ? end : start + static_cast<double>(k + 1) * h;
      ++body->counters().steps;
      body->impose_prescribed(time);
      changed();
      if ((k + 1) % stride != 0 && k + 1 != n) continue;
      const EnergySample before = sample;
      const double since = sample_time;
      sample_now();
      book.book_step(before, sample, time - since);
      if (auto found = check_divergence()) return found;
    }
    return std::nullopt;
  }

  std::optional<Divergence> check_divergence() {
    const double energy = sample.kinetic + sample.stored;
    // Where the work is not known, the integrator's own error control stands guard.
    bool fine = books_work() ? energy <= book.work() + book.turnover()  // false for NaN
                             : std::isfinite(energy);
    const double reach = allowed_violation.empty() ? 0.0 : u().lpNorm<Eigen::Infinity>();
    for (std::size_t j = 0; fine && j < allowed_violation.size(); ++j) {
      double size = 0.0;
      for (const auto& entry : interval.solver->columns()[j].entries) size += std::abs(entry.second) * reach;
      fine = std::abs(violation(j)) <= allowed_violation[j] + violation_allowed * size;
    }
    if (fine) return std::nullopt;
    return divergence_now();
  }

  // Takes all memory that the hands will need.
  void attach(Hands& others) {
    hands = &others;
    // Beside the scene's constraints only more are held, and a held body's frequencies interlace with the
    // free one's: the limit stands. Eigenvalues of the scene's own sets say nothing of others.
    spectrum.eigenvalues.clear();
    choose_step(asked);
    for (Interval* i : {&interval, &next}) {
      i->force_rate.setZero(static_cast<Eigen::Index>(model.layout.part));
      i->course.reserve(schedule.holder_count() + hands->owner_count());
      i->held.reserve(model.layout.part);
      i->eliminated.reserve(model.layout.part);
    }
    reaction.setZero(static_cast<Eigen::Index>(model.layout.part));
    external = reaction;
    hands->prepare(schedule);
    enter_from(time);
  }

  Divergence divergence_now() {
    Divergence d{time, 0, sample.kinetic + sample.stored, book.work() + book.turnover(), limit};
    d.node = fastest_node(v());
    return d;
  }

  std::optional<Divergence> advance(double t) {
    assert(t >= time || same_time(t, time));
    const FlushDenormals flush;
    while (!diverged && time < t && !same_time(time, t)) {
      const double event = schedule.end(index);
      const bool passes = event <= t || same_time(event, t);
      diverged = run_segment(passes ? event : t);
      if (!diverged && passes) enter(index + 1);
    }
    return diverged;
  }

  std::optional<AccuracyPlan> plan;
  Scene scene;
  Model model;
  SimulationOptions asked;
  Schedule schedule;
  Spectrum spectrum;
  std::unique_ptr<Body> body;
  EnergyBook book;
  std::unique_ptr<Integrator> integrator;
  std::int64_t stride = 1;  // steps from one energy sample to the next

  double limit = 0.0;
  double bound = 0.0;
  double largest_step = 0.0;
  double time = 0.0;
  std::size_t index = 0;
  Interval interval, next;
  bool entered = false;
  Hands* hands = nullptr;
  std::vector<double> y, zeros;
  bool y_current = true;
  Holds holds;
  std::vector<double> allowed_violation;
  EnergySample sample;
  double sample_time = 0.0;
  bool sampled = false, state_sampled = false;  // all of it; what depends on the state alone
  Vector reaction, external;
  bool reaction_known = false;
  std::optional<Divergence> diverged;
};

Simulation::Simulation(Scene scene, SimulationOptions options)
    : impl_(std::make_unique<Impl>(std::move(scene), options)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

const Scene& Simulation::scene() const {
  return impl_->scene;
}
const std::optional<AccuracyPlan>& Simulation::plan() const {
  return impl_->plan;
}
const Spectrum& Simulation::spectrum() const {
  return impl_->spectrum;
}
double Simulation::stable_step() const {
  return impl_->limit;
}
double Simulation::step_bound() const {
  return impl_->bound / impl_->scene.time.refinement;
}
double Simulation::largest_step() const {
  return impl_->largest_step;
}
double Simulation::time() const {
  return impl_->time;
}
std::optional<Divergence> Simulation::advance(double t) {
  return impl_->advance(t);
}
const Counters& Simulation::counters() const {
  return impl_->body->counters();
}

std::int64_t Simulation::planned_steps() const {
  return impl_->schedule.planned_steps(impl_->bound);
}

void Simulation::attach(Hands& hands) {
  impl_->attach(hands);
}

void Simulation::hands_changed() {
  const FlushDenormals flush;
  impl_->enter_from(impl_->time);
}

std::span<const double> Simulation::reaction_at(std::span<const HeldDof> held) {
  impl_->know_reaction_at(held);
  return {impl_->reaction.data(), impl_->model.layout.part};
}

std::span<const double> Simulation::u() const {
  impl_->fetch();
  return {impl_->y.data() + impl_->model.layout.u(), impl_->model.layout.part};
}
std::span<const double> Simulation::v() const {
  impl_->fetch();
  return {impl_->y.data() + impl_->model.layout.v(), impl_->model.layout.part};
}
std::span<const double> Simulation::w_lambda() const {
  if (!impl_->model.layout.lambda) return impl_->zeros;
  impl_->fetch();
  return {impl_->y.data() + impl_->model.layout.w_lambda(), impl_->model.layout.part};
}
std::span<const double> Simulation::w_mu() const {
  if (!impl_->model.layout.mu) return impl_->zeros;
  impl_->fetch();
  return {impl_->y.data() + impl_->model.layout.w_mu(), impl_->model.layout.part};
}

Energies Simulation::energies() const {
  impl_->sample_now();
  const EnergySample& now = impl_->sample;
  const bool asked = impl_->stride == 1;
  return {now.kinetic, now.stored, asked && impl_->books_dissipated() ? impl_->book.dissipated() : not_asked,
          asked && impl_->books_work() ? impl_->book.work() : not_asked};
}

std::string_view Simulation::kernel() const {
  return impl_->body->kernel();
}
int Simulation::threads() const {
  return impl_->body->threads();
}
std::size_t Simulation::factor_bytes() const {
  return impl_->body->factor_bytes();
}

std::span<const double> Simulation::reaction() {
  impl_->know_reaction();
  return {impl_->reaction.data(), impl_->model.layout.part};
}

std::span<const double> Simulation::external_force() {
  impl_->know_reaction();
  return {impl_->external.data(), impl_->model.layout.part};
}

std::span<const double> Simulation::multipliers() {
  return impl_->body->multipliers(impl_->time).first(impl_->scene.constraints.size());
}

ProbeReading Simulation::read(const Probe& probe) {
  impl_->know_reaction();
  ProbeReading reading;
  if (probe.nodes.empty()) return reading;
  for (int node : probe.nodes) {
    reading.displacement.x += u()[2 * node];
    reading.displacement.y += u()[2 * node + 1];
    // Of the external force the tractions alone: what touches the body there.
    const double mass = impl_->model.node_mass[node];
    const Vec2& g = impl_->scene.body_acceleration;
    reading.force.x += impl_->reaction[2 * node] + impl_->external[2 * node] - mass * g.x;
    reading.force.y += impl_->reaction[2 * node + 1] + impl_->external[2 * node + 1] - mass * g.y;
  }
  reading.displacement.x /= static_cast<double>(probe.nodes.size());
  reading.displacement.y /= static_cast<double>(probe.nodes.size());
  return reading;
}

std::vector<Simulation::ActiveTraction> Simulation::active_tractions() const {
  return impl_->schedule.active_tractions(impl_->index, impl_->time);
}

std::vector<int> Simulation::held_nodes() const {
  std::vector<int> nodes;
  for (const HeldDof& h : impl_->interval.held) {
    if (nodes.empty() || nodes.back() != h.dof / 2) nodes.push_back(h.dof / 2);
  }
  return nodes;
}

}  // namespace rheo
