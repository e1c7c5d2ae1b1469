#include "rheo/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "assembled_body.hpp"
#include "energy_book.hpp"
#include "kernels/edge_body.hpp"
#include "kernels/flush_denormals.hpp"
#include "model.hpp"
#include "rheo/error.hpp"
#include "schedule.hpp"
#include "timeline.hpp"

namespace rheo {
namespace {

constexpr double auto_fraction = 0.25;  // of the stable limit
constexpr double most_steps = 1e15;     // counted exactly by a double, and beyond any patience
constexpr double not_asked = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t unasked_stride = 16;  // steps between looks at the energy where nobody asks for it
// Of all energy that ever went in: what is left below it cannot move the body by a rounding of its course.
constexpr double energy_at_rest = 1e-32;
constexpr double violation_allowed = 0.01;  // of a constraint's coefficients times the largest |u|

const Scene& validated(const Scene& scene) {
  validate(scene);
  return scene;
}

// An integrator that is to be chosen without an accuracy is RK4.
Scene decided(Scene scene, const std::optional<AccuracyPlan>& plan) {
  if (plan) return with_plan(std::move(scene), *plan);
  if (scene.time.integrator == IntegratorKind::automatic) scene.time.integrator = IntegratorKind::rk4;
  return scene;
}

// Equal steps that divide a stretch of time: `refinement` times those of at most `bound`.
std::int64_t steps_in(double length, double refinement, double bound) {
  constexpr double slack = 1.0 - 1e-12;
  const double steps = std::max(1.0, std::ceil(length / bound * slack));
  return static_cast<std::int64_t>(std::ceil(refinement * steps * slack));
}

// The fastest kernel that the scene's mass and constraints allow, unless one is asked for.
Assembly assembly_for(const Scene& scene, Kernel kernel) {
  const bool edges = scene.material.mass == Mass::lumped && !has_columns(scene);
  if (kernel == Kernel::edge && !edges) {
    throw Error(Error::Kind::input,
                "kernel edge needs mass = \"lumped\" and constraints = \"auto\" without [[constraint]]: use "
                "auto or csr");
  }
  return edges && kernel != Kernel::csr ? Assembly::edges : Assembly::matrices;
}

}  // namespace

struct Simulation::Impl {
  Impl(Scene&& s, const SimulationOptions& options)
      : plan(s.time.accuracy != 0.0 ? std::optional(plan_accuracy(s, options)) : std::nullopt),
        scene(decided(std::move(s), plan)),
        model(validated(scene).mesh, scene.material, assembly_for(scene, options.kernel)),
        schedule(scene, model),
        spectrum(schedule.spectrum()),
        body(make_body(options.threads)),
        integrator(make_integrator(scene.time.integrator, body->size(), exponential_settings())),
        stride(options.energies ? 1 : unasked_stride),
        y(model.layout.size(), 0.0),
        zeros(model.layout.part, 0.0) {
    choose_step(options);
    const auto part = static_cast<Eigen::Index>(model.layout.part);
    base.setZero(part);
    jump.setZero(part);
    dv.setZero(part);
    momentum.setZero(part);
    owner.assign(model.layout.part, -1);
    enter(0);
  }

  // Refuses with the place in the scene file where there is one.
  [[noreturn]] void refuse_step(const std::string& text) const {
    const std::string& where = scene.time.where;
    throw Error(Error::Kind::input, where.empty() ? text : where + " " + text);
  }

  bool exponential() const { return scene.time.integrator == IntegratorKind::exponential; }

  // The tolerance is that of the run: errors of its steps add up at worst.
  ExponentialSettings exponential_settings() const {
    const TimeSettings& settings = scene.time;
    if (exponential() && has_columns(scene)) {
      throw Error(Error::Kind::input,
                  "integrator = \"exponential\" needs constraints = \"auto\" without [[constraint]]: use "
                  "\"rk4\"");
    }
    const double rate =
        settings.step > 0.0 ? std::max(settings.frame_rate, 1.0 / settings.step) : settings.frame_rate;
    const double steps = std::ceil(settings.duration * rate) + static_cast<double>(schedule.interval_count());
    return {
        spectrum.omega_max,
        std::max(spectrum.lambda_on ? spectrum.lambda_rate : 0.0, spectrum.mu_on ? spectrum.mu_rate : 0.0),
        settings.tolerance / steps};
  }

  // Whether the quadrature over a step gives all of the work: steps of the exponential integrator are long,
  // and the loads' part alone, by parts, is exact for constant loads.
  bool books_work() const {
    return !exponential() ||
           (scene.moves.empty() && std::all_of(scene.tractions.begin(), scene.tractions.end(),
                                               [](const Traction& t) { return t.keys.size() == 1; }));
  }
  // Likewise what is dissipated: nothing, or unknown.
  bool books_dissipated() const {
    return !exponential() || ((!spectrum.lambda_on || spectrum.lambda_rate == 0.0) &&
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
    // The exponential integrator goes from event to event and output to output.
    bound = given ? settings.step : exponential() ? limit : auto_fraction * limit;
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
    const bool first = i == 0;
    Interval next = schedule.interval(i);
    // Base: u - key at the hold's beginning, so that b = base + key.
    bool begins = first;
    std::vector<int> next_owner(owner.size(), -1);
    for (const HeldDof& h : next.held) {
      next_owner[h.dof] = h.owner;
      const Polynomial& course = next.course[h.owner][h.dof % 2];
      const double after = course.derivative(next.begin, 1);
      if (owner[h.dof] != h.owner) {
        base[h.dof] = u()[h.dof] - course.value(next.begin);
        jump[h.dof] = after - v()[h.dof];
        begins = true;
      } else {
        const double before = interval.course[h.owner][h.dof % 2].derivative(next.begin, 1);
        // The same velocity from two polynomials differs by rounding.
        const bool jumps = std::abs(after - before) > 1e-12 * (std::abs(after) + std::abs(before));
        jump[h.dof] = jumps ? after - before : 0.0;
        begins = begins || jumps;
      }
    }
    owner = std::move(next_owner);
    const bool other_constraints = next.solver != interval.solver;
    interval = std::move(next);
    index = i;
    body->enter(interval, base);
    if (begins && project_velocity(first)) body->load(y);
    body->impose_prescribed(time);
    changed();
    if (begins || other_constraints) note_violations();
  }

  // v+ = v + M^-1 A L: an impulse, whose energy is work. A constraint that begins takes A^T v to b'; one that
  // goes on changes A^T v by the jump of its b' only, so that Baumgarte's decay of what it had is left alone.
  bool project_velocity(bool first) {
    const ConstraintSolver& solver = *interval.solver;
    const std::size_t columns = solver.columns().size();
    bool any = false;
    for (const HeldDof& h : interval.eliminated) {
      dv[h.dof] = jump[h.dof];
      any = any || dv[h.dof] != 0.0;
    }
    Vector target(static_cast<Eigen::Index>(columns)), impulse;
    for (std::size_t j = 0; j < columns; ++j) {
      const Column& column = solver.columns()[j];
      if (column.owner >= 0) {
        target[j] = jump[column.entries.front().first];
      } else {
        target[j] = first ? -solver.row_times(j, v().data()) : 0.0;
      }
      any = any || target[j] != 0.0;
    }
    if (!any) return false;
    solver.solve(Vector::Zero(dv.size()), dv, target, impulse);
    model.multiply_mass(dv.data(), momentum.data());
    const double work = momentum.dot(v()) + 0.5 * momentum.dot(dv);
    v() += dv;
    book.book_impulse(work);
    ++body->counters().projections;
    return true;
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
    sampled = false;
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
    sample = body->sample(time);
    ++body->counters().energy_samples;
    sample_time = time;
    sampled = true;
  }

  void know_reaction() {
    if (reaction_known) return;
    body->reaction(time, reaction);
    external = body->external_force(time);
    reaction_known = true;
  }

  // Nothing acts, nothing is moved, and what is left of the energy is nothing beside what went in.
  bool at_rest() {
    if (interval.moving || interval.force_rate.size() > 0 || !interval.solver->columns().empty())
      return false;
    if (!(interval.force.array() == 0.0).all()) return false;
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

  Divergence divergence_now() {
    Divergence d{time, 0, sample.kinetic + sample.stored, book.work() + book.turnover(), limit};
    double fastest = -1.0;
    for (int node = 0; node < scene.mesh.node_count(); ++node) {
      const double speed = std::hypot(v()[2 * node], v()[2 * node + 1]);
      if (!std::isfinite(speed)) {
        d.node = node;
        break;
      }
      if (speed > fastest) {
        fastest = speed;
        d.node = node;
      }
    }
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
  Interval interval;
  std::vector<double> y, zeros;
  bool y_current = true;
  Vector base, jump, dv, momentum;
  std::vector<int> owner;  // by degree of freedom: who holds it, -1: nobody
  std::vector<double> allowed_violation;
  EnergySample sample;
  double sample_time = 0.0;
  bool sampled = false;
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
  const TimeSettings& settings = impl_->scene.time;
  std::int64_t steps = 0;
  double t = 0.0;
  std::size_t interval = 0;
  const auto run_to = [&](double target) {
    while (t < target && !same_time(t, target)) {
      const double event = impl_->schedule.end(interval);
      const bool passes = event <= target || same_time(event, target);
      const double end = passes ? event : target;
      steps += steps_in(end - t, settings.refinement, impl_->bound);
      t = end;
      if (passes) ++interval;
    }
  };
  for (std::int64_t k = 0; k < output_count(settings); ++k) run_to(output_time(settings, k));
  run_to(settings.duration);
  return steps;
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
    reading.force.x += impl_->reaction[2 * node] + impl_->external[2 * node];
    reading.force.y += impl_->reaction[2 * node + 1] + impl_->external[2 * node + 1];
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
