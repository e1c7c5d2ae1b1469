#include "run_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "option_values.hpp"

namespace app {
namespace {

// `item` is what the scene's text calls it, with its place in the file.
void note_window(const std::string& item, const rheo::Window& window, double duration,
                 std::vector<std::string>& notes) {
  if (window.from >= duration) {
    notes.push_back(fmt::format("{} never acts: from = {:g} s is not before the duration, {:g} s", item,
                                window.from, duration));
  }
}

// Keys of which the run sees only one end.
template <typename Key>
void note_keys(const std::string& item, const std::vector<Key>& keys, const rheo::Window& window,
               double duration, std::vector<std::string>& notes) {
  const double end = std::min(window.until, duration);
  if (keys.size() < 2 || window.from >= duration) return;
  if (keys.back().t <= window.from || keys.front().t >= end) {
    notes.push_back(
        fmt::format("{} is constant while it acts, from {:g} s to {:g} s: its keys lie from {:g} s to {:g} s",
                    item, window.from, end, keys.front().t, keys.back().t));
  }
}

bool resists_nothing(const rheo::Material& m) {
  bool nothing =
      m.elastic.lambda == 0.0 && m.elastic.mu == 0.0 && m.viscous.lambda == 0.0 && m.viscous.mu == 0.0;
  for (std::size_t k = 0; k < m.branch_count(); ++k)
    nothing = nothing && m.branch(k).lambda_ela == 0.0 && m.branch(k).mu_ela == 0.0;
  return nothing;
}

}  // namespace

std::vector<std::string> run_notes(const rheo::Scene& scene) {
  std::vector<std::string> notes = scene.notes;
  const rheo::TimeSettings& time = scene.time;
  if (const int pieces = rheo::piece_count(scene.mesh);
      pieces > std::max(1, static_cast<int>(scene.bodies.size())))
    notes.push_back(
        fmt::format("the mesh is {} pieces that share no node: they do not feel each other", pieces));
  for (std::size_t k = 0; k <= scene.regions.size(); ++k) {
    if (!resists_nothing(rheo::material_of(scene, k))) continue;
    const std::string& name = k == 0 ? scene.material_name : scene.regions[k - 1].name;
    notes.push_back(fmt::format("{} resists nothing: its moduli are zero, its nodes fly freely",
                                name.empty() ? "the material" : "the material of " + name));
  }
  for (const rheo::Fix& fix : scene.fixes) note_window(fix.where, fix.window, time.duration, notes);
  for (const rheo::Move& move : scene.moves) {
    note_window(move.where, move.window, time.duration, notes);
    note_keys(move.where, move.keys, move.window, time.duration, notes);
  }
  for (const rheo::Traction& traction : scene.tractions) {
    note_window(traction.where, traction.window, time.duration, notes);
    note_keys(traction.where, traction.keys, traction.window, time.duration, notes);
  }
  const double last = rheo::output_time(time, rheo::output_count(time) - 1);
  // A product and a quotient of the two settings round by some 1e-16.
  if (time.duration - last > 1e-9 * time.duration)
    notes.push_back(fmt::format("outputs end at t = {:.6g} s, state.csv is at the duration {:.6g} s", last,
                                time.duration));
  return notes;
}

std::string stiffness_advice(const rheo::Scene& scene, const rheo::Spectrum& spectrum) {
  constexpr double many_times = 10.0;
  const double step = rheo::stable_step(spectrum, rheo::IntegratorKind::rk4);
  if (scene.time.integrator == rheo::IntegratorKind::exponential ||
      scene.time.integrator == rheo::IntegratorKind::implicit || !(step > 0.0) || std::isinf(step))
    return {};
  constexpr double rk4_imaginary_limit = 2.8284271247461903;  // of RK4's stability region
  const double vibrations =
      spectrum.omega_max > 0.0 ? rk4_imaginary_limit / spectrum.omega_max : scene.time.duration;
  if (vibrations < many_times * step || scene.time.duration < 1e4 * step) return {};
  return fmt::format(
      "the {} alone makes explicit steps so short, vibrations would allow {:.3g} s: try --integrator "
      "exponential or implicit",
      spectrum.viscous_max > 0.0 ? "viscous part or relaxation" : "relaxation", vibrations);
}

std::string plan_text(const rheo::AccuracyPlan& plan) {
  const std::string setting = plan.step > 0.0
                                  ? fmt::format("steps of at most {:.4g} s", plan.step / plan.refinement)
                                  : fmt::format("tolerance {:.3g}", plan.tolerance);
  const std::string trials =
      plan.trial_evaluations > 0.0
          ? fmt::format("; trial runs took {:.0f} force evaluations", plan.trial_evaluations)
          : "";
  return fmt::format("{:g} asked for: {} ({}), {}, estimated error {:.2g}, about {:.0f} force evaluations{}",
                     plan.accuracy, name_of(plan.integrator), plan.why, setting, plan.estimate,
                     plan.evaluations, trials);
}

std::vector<std::string> plan_notes(const rheo::Simulation& simulation,
                                    const rheo::SimulationOptions& options) {
  std::vector<std::string> notes;
  if (const std::string advice = stiffness_advice(simulation.scene(), simulation.spectrum()); !advice.empty())
    notes.push_back(advice);
  if (!simulation.plan()) return notes;
  notes.push_back("accuracy " + plan_text(*simulation.plan()));
  const rheo::Energies energies = simulation.energies();
  const bool no_work = std::isnan(energies.work), no_dissipated = std::isnan(energies.dissipated);
  if (options.energies && (no_work || no_dissipated)) {
    notes.push_back(
        fmt::format("history.csv's {} of energy stay{} empty with the integrator {}; integrator rk4 fills "
                    "them",
                    no_work && no_dissipated ? "columns dissipated and work"
                    : no_work                ? "column work"
                                             : "column dissipated",
                    no_work && no_dissipated ? "" : "s", name_of(simulation.plan()->integrator)));
  }
  return notes;
}

}  // namespace app
