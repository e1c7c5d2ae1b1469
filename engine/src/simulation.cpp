#include "rheo/simulation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "body_choice.hpp"
#include "kernels/flush_denormals.hpp"
#include "model.hpp"
#include "rheo/deformation.hpp"
#include "rheo/error.hpp"
#include "rheo/io/bytes.hpp"
#include "rheo/memory_need.hpp"
#include "schedule.hpp"
#include "stepping.hpp"

namespace rheo {
namespace {

constexpr double not_asked = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t unasked_stride = 16;  // steps between looks at the energy where nobody asks for it

// Before anything is made of it.
Scene validated(Scene scene, const SimulationOptions& options) {
  validate(scene);
  require_memory(scene, options.memory);
  return scene;
}

// An integrator that is to be chosen without an accuracy is RK4.
Scene decided(Scene scene, const std::optional<AccuracyPlan>& plan) {
  if (plan) return with_plan(std::move(scene), *plan);
  if (scene.time.integrator == IntegratorKind::automatic) scene.time.integrator = IntegratorKind::rk4;
  return scene;
}

}  // namespace

struct Simulation::Impl {
  Impl(Scene&& s, const SimulationOptions& options)
      : plan(s.time.accuracy != 0.0 ? std::optional(plan_accuracy(s, options)) : std::nullopt),
        scene(decided(std::move(s), plan)),
        model(scene.mesh, regions_of(scene), assembly_for(scene, options.kernel)),
        asked(options),
        schedule(scene, model, options.memory, options.nearness, options.searching),
        spectrum(schedule.spectrum()),
        body(make_body(scene, model, options.threads)),
        integrator(make_integrator(scene.time.integrator, body->size(),
                                   integrator_settings(scene, spectrum, schedule.interval_count()))),
        w_lambda(Vector::Zero(static_cast<Eigen::Index>(model.layout.part))),
        w_mu(w_lambda),
        pull_lambda(w_lambda),
        pull_mu(w_lambda),
        branch_lambda(w_lambda),
        branch_mu(w_lambda),
        stepping(scene, model, schedule, *body, *integrator, limits(),
                 options.energies ? 1 : unasked_stride) {}

  StepLimits limits() const { return choose_step(scene, spectrum, integrator->name(), asked); }
  Readings& now() { return stepping.readings(); }
  std::span<const double> part_of_state(std::size_t offset) {
    return std::span<const double>(now().state()).subspan(offset, model.layout.part);
  }

  // The mean over the regions around a node, by their areas.
  void add_mean(const Patch& patch, const double* own, Vector& out) {
    patch.for_each_dof([&](std::size_t i, std::size_t j) { out[j] += patch.area_share[i / 2] * own[i]; });
  }
  std::span<const double> sum(Modulus modulus, PartSum parts, Vector& memory) {
    const std::span<const double> y = now().state();
    if (!model.has_several_materials()) {
      const ConstVectorMap result = sum_of_parts(model, 0, modulus, parts, y, memory);
      return {result.data(), static_cast<std::size_t>(result.size())};
    }
    memory.setZero();
    for (std::size_t r = 0; r < model.patches.size(); ++r)
      add_mean(model.patches[r], sum_of_parts(model, r, modulus, parts, y, work).data(), memory);
    return {memory.data(), static_cast<std::size_t>(memory.size())};
  }
  std::span<const double> branch(Modulus modulus, std::size_t number, Vector& memory) {
    assert(number < model.branch_count());
    memory.setZero();
    for (const BranchPart& part : model.layout.branches) {
      if (part.modulus != modulus || part.number != number) continue;
      if (!model.has_several_materials()) return part_of_state(part.offset);
      add_mean(model.patches[part.region], now().state().data() + part.offset, memory);
    }
    return {memory.data(), static_cast<std::size_t>(memory.size())};
  }
  // y, in the mesh's order.
  std::vector<double> state_from(const SavedState& saved) const {
    const Layout& layout = model.layout;
    assert(saved.u.size() == layout.part && saved.v.size() == layout.part);
    std::vector<double> y(layout.size(), 0.0);
    std::copy(saved.u.begin(), saved.u.end(), y.begin() + static_cast<std::ptrdiff_t>(layout.u()));
    std::copy(saved.v.begin(), saved.v.end(), y.begin() + static_cast<std::ptrdiff_t>(layout.v()));
    for (const BranchPart& branch : layout.branches) {
      const bool lambda = branch.modulus == Modulus::lambda;
      const auto own =
          std::find_if(saved.parts.begin(), saved.parts.end(), [&](const SavedState::Part& part) {
            return part.lambda == lambda && part.material == branch.region && part.branch == branch.number &&
                   part.w.size() == branch.size;
          });
      if (own != saved.parts.end()) {
        std::copy(own->w.begin(), own->w.end(), y.begin() + static_cast<std::ptrdiff_t>(branch.offset));
        continue;
      }
      const auto& all = lambda ? saved.w_lambda : saved.w_mu;
      if (branch.number >= all.size()) continue;
      const std::vector<double>& w = all[branch.number];
      model.patches[branch.region].for_each_dof(
          [&](std::size_t i, std::size_t j) { y[branch.offset + i] = w[j]; });
    }
    return y;
  }
  void find_stress(std::span<double> out) {
    if (!model.has_several_materials()) {
      rheo::stress(scene.mesh, sum(Modulus::lambda, PartSum::pull, pull_lambda),
                   sum(Modulus::mu, PartSum::pull, pull_mu), out);
      return;
    }
    const std::span<const double> y = now().state();
    const auto spread = [&](std::size_t region, Modulus modulus, Vector& memory) {
      const double* own = sum_of_parts(model, region, modulus, PartSum::pull, y, work).data();
      memory.setZero();
      model.patches[region].for_each_dof([&](std::size_t i, std::size_t j) { memory[j] = own[i]; });
      return std::span<const double>(memory.data(), static_cast<std::size_t>(memory.size()));
    };
    for (std::size_t r = 0; r < model.patches.size(); ++r) {
      const auto l = spread(r, Modulus::lambda, pull_lambda), m = spread(r, Modulus::mu, pull_mu);
      rheo::stress(scene.mesh, model.patches[r].triangles, l, m, out);
    }
  }

  std::optional<AccuracyPlan> plan;
  Scene scene;
  Model model;
  SimulationOptions asked;
  Schedule schedule;
  Spectrum spectrum;
  std::unique_ptr<Body> body;
  std::unique_ptr<Integrator> integrator;
  // 2n each, where they are sums or means.
  Vector w_lambda, w_mu, pull_lambda, pull_mu, branch_lambda, branch_mu;
  Vector work;
  Stepping stepping;
};

Simulation::Simulation(Scene scene, SimulationOptions options)
    : impl_(std::make_unique<Impl>(validated(std::move(scene), options), options)) {}
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
  return impl_->stepping.limits().stable;
}
double Simulation::step_bound() const {
  return impl_->stepping.limits().bound / impl_->scene.time.refinement;
}
double Simulation::largest_step() const {
  return impl_->stepping.largest_step();
}
double Simulation::time() const {
  return impl_->stepping.time();
}
std::optional<Divergence> Simulation::advance(double t) {
  return impl_->stepping.advance(t);
}
const Counters& Simulation::counters() const {
  return impl_->body->counters();
}

std::int64_t Simulation::planned_steps() const {
  return impl_->schedule.planned_steps(impl_->stepping.limits().bound);
}

void Simulation::attach(Hands& hands) {
  // Beside the scene's constraints only more are held, and a held body's frequencies interlace with the
  // free one's: the limit stands. Eigenvalues of the scene's own sets say nothing of others.
  impl_->spectrum.eigenvalues.clear();
  impl_->spectrum.near_euler_step = 0.0;
  impl_->stepping.attach(hands, impl_->limits());
}

void Simulation::hands_changed() {
  const FlushDenormals flush;
  impl_->stepping.enter_now();
}

std::span<const double> Simulation::reaction_at(std::span<const HeldDof> held) {
  return impl_->now().reaction_at(time(), held);
}

SavedState Simulation::save() const {
  const auto copy = [](std::span<const double> x) { return std::vector<double>(x.begin(), x.end()); };
  SavedState saved{time(), copy(u()), copy(v()), {}, {}, {}, {}};
  if (impl_->model.has_several_materials()) {
    for (const BranchPart& branch : impl_->model.layout.branches) {
      const double* const w = impl_->now().state().data() + branch.offset;
      saved.parts.push_back(
          {branch.modulus == Modulus::lambda, branch.region, branch.number, {w, w + branch.size}});
    }
  }
  for (std::size_t k = 0; k < impl_->model.branch_count(); ++k) {
    saved.w_lambda.push_back(copy(w_lambda(k)));
    saved.w_mu.push_back(copy(w_mu(k)));
  }
  return saved;
}

void Simulation::resume(const SavedState& saved) {
  const FlushDenormals flush;
  impl_->stepping.resume(saved.t, impl_->state_from(saved), saved.energies);
}

Snapshot Simulation::snapshot() const {
  ByteWriter course;
  course.put_text(kernel());
  course.put(static_cast<std::uint64_t>(impl_->asked.energies ? 1 : 0));
  course.put(step_bound());
  impl_->stepping.put_course(course);
  return {save(), course.take()};
}

void Simulation::restore(const Snapshot& snapshot) {
  const FlushDenormals flush;
  ByteReader course(snapshot.course, "its course");
  const auto refuse = [](const std::string& text) { throw Error(Error::Kind::input, text); };
  if (const std::string kernel_then = course.get_text(); kernel_then != kernel())
    refuse("was made with kernel " + kernel_then + ", this run has " + std::string(kernel()) +
           ": name that kernel");
  if ((course.get<std::uint64_t>() != 0) != impl_->asked.energies)
    refuse("was made with other columns of energy: both with --no-energies, or both without");
  if (course.get<double>() != step_bound())
    refuse("was made with another largest step: name the same, with the same build");
  const SavedState& state = snapshot.state;
  if (state.u.size() != impl_->model.layout.part || state.v.size() != state.u.size())
    refuse("is of a mesh with another number of nodes: take one of this scene");
  impl_->stepping.get_course(course, impl_->state_from(state));
  course.expect_end();
}

std::span<const double> Simulation::u() const {
  return impl_->part_of_state(impl_->model.layout.u());
}
std::span<const double> Simulation::v() const {
  return impl_->part_of_state(impl_->model.layout.v());
}
std::span<const double> Simulation::w_lambda() const {
  return impl_->sum(Modulus::lambda, PartSum::residual, impl_->w_lambda);
}
std::span<const double> Simulation::w_mu() const {
  return impl_->sum(Modulus::mu, PartSum::residual, impl_->w_mu);
}
std::span<const double> Simulation::w_lambda(std::size_t branch) const {
  return impl_->branch(Modulus::lambda, branch, impl_->branch_lambda);
}
std::span<const double> Simulation::w_mu(std::size_t branch) const {
  return impl_->branch(Modulus::mu, branch, impl_->branch_mu);
}
std::span<const double> Simulation::pull_lambda() const {
  return impl_->sum(Modulus::lambda, PartSum::pull, impl_->pull_lambda);
}
std::span<const double> Simulation::pull_mu() const {
  return impl_->sum(Modulus::mu, PartSum::pull, impl_->pull_mu);
}

void Simulation::stress(std::span<double> out) const {
  impl_->find_stress(out);
}

Energies Simulation::energies() const {
  const FlushDenormals flush;  // as steps do: they may go on from these numbers
  const Stepping& stepping = impl_->stepping;
  const EnergySample& now = impl_->now().sample(time());
  const bool asked = impl_->asked.energies;
  return {now.kinetic, now.stored,
          asked && stepping.books_dissipated() ? stepping.book().all_dissipated() : not_asked,
          asked && stepping.books_work() ? stepping.book().all_work() : not_asked};
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
  const FlushDenormals flush;
  return impl_->now().reaction(time());
}

std::span<const double> Simulation::external_force() {
  const FlushDenormals flush;
  return impl_->now().external_force(time());
}

std::span<const double> Simulation::multipliers() {
  const FlushDenormals flush;
  return impl_->body->multipliers(time()).first(impl_->scene.constraints.size());
}

ProbeReading Simulation::read(const Probe& probe) {
  const std::span<const double> held = reaction(), loads = external_force();
  ProbeReading reading;
  if (probe.nodes.empty()) return reading;
  for (int node : probe.nodes) {
    reading.displacement.x += u()[2 * node];
    reading.displacement.y += u()[2 * node + 1];
    // Of the external force the tractions alone: what touches the body there.
    const double mass = impl_->model.node_mass[node];
    const Vec2& g = impl_->scene.body_acceleration;
    reading.force.x += held[2 * node] + loads[2 * node] - mass * g.x;
    reading.force.y += held[2 * node + 1] + loads[2 * node + 1] - mass * g.y;
  }
  reading.displacement.x /= static_cast<double>(probe.nodes.size());
  reading.displacement.y /= static_cast<double>(probe.nodes.size());
  return reading;
}

std::vector<Simulation::ActiveTraction> Simulation::active_tractions() const {
  std::vector<ActiveTraction> tractions;
  active_tractions(tractions);
  return tractions;
}

void Simulation::active_tractions(std::vector<ActiveTraction>& out) const {
  impl_->schedule.active_tractions(impl_->stepping.interval_index(), time(), out);
}

std::vector<int> Simulation::held_dofs() const {
  std::vector<int> dofs;
  held_dofs(dofs);
  return dofs;
}

void Simulation::held_dofs(std::vector<int>& out) const {
  out.clear();
  for (const HeldDof& h : impl_->stepping.interval().held) out.push_back(h.dof);
}

}  // namespace rheo
