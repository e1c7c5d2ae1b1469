#include "bench_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "option_values.hpp"
#include "rheo/error.hpp"

namespace app {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

enum class Knob {
  step,      // halved from the largest stable one
  tolerance  // tightened by decades
};

// The candidates: an integrator a line. The cheap ones come first, for the budget.
struct Family {
  rheo::IntegratorKind integrator;
  Knob knob;
  int most;  // settings
};
constexpr std::array families{
    Family{rheo::IntegratorKind::exponential, Knob::tolerance, 11},
    Family{rheo::IntegratorKind::implicit, Knob::step, 8},
    Family{rheo::IntegratorKind::rk4, Knob::step, 16},
    Family{rheo::IntegratorKind::euler, Knob::step, 6},
};

constexpr double accurate_enough = 1e-11;  // no finer settings beyond it
constexpr double share_of_rest = 0.3;      // of the budget's rest, for one run
constexpr double share_of_repeats = 0.3;   // of the budget, kept for them
constexpr double coarsest = 1e-2;          // tolerance
constexpr double order_shows = 1e-4;       // errors below it follow the order
constexpr double longest_reach = 60.0;     // seconds, for a run to the finest error wanted
constexpr double share_of_reach = 0.5;     // of the budget's rest, likewise
// Short runs are repeated, in turn with all others, until they have taken so long together.
constexpr int most_repeats = 9;
constexpr double worth_repeating = 0.5;  // seconds

// Three digits, so that it can be typed; downwards, so that it stays stable.
double rounded_down(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 2.0);
  return std::stod(fmt::format("{:.2e}", std::floor(x / unit * (1.0 + 1e-12)) * unit));
}

std::string first_line(std::string text) {
  return text.substr(0, text.find('\n'));
}

enum class Outcome {
  row,
  diverged,
  stop  // nothing finer is worth a try
};

class Bench {
 public:
  Bench(const rheo::Scene& scene, rheo::SimulationOptions options, const Reference& reference, double budget,
        Progress& progress)
      : scene_(scene),
        options_(options),
        reference_(reference),
        progress_(progress),
        budget_((1.0 - share_of_repeats) * budget),
        whole_budget_(budget),
        start_(Clock::now()) {
    options_.energies = false;
  }

  void sweep(const Family& family) {
    Setting setting{family.integrator, 0.0, 0.0};
    if (family.knob == Knob::tolerance) {
      setting.tolerance = coarsest;
    } else if (const double step = largest_step(family.integrator); step > 0.0) {
      setting.step = rounded_down(step);
    } else {
      return;
    }
    double cost = 0.0;  // seconds a step, where some were timed
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; k < family.most; ++k) {
      if (reference_.by_exponential() && setting.tolerance > 0.0 &&
          setting.tolerance <= 2.0 * rheo::finest_tolerance)
        return;  // the reference itself
      progress_.update(done_++);
      const Outcome outcome = run(setting, cost);
      if (outcome == Outcome::stop) return;
      if (outcome == Outcome::row) {
        const double error = result_.rows.back().error;
        // Beyond both, rounding rules. (Tolerances have no order: neighbours may happen to err alike.)
        const bool stalled = family.knob == Knob::step && error <= 1e-8 && error > 0.7 * before;
        if (error <= accurate_enough || stalled) return;
        before = error;
      }
      if (family.knob == Knob::tolerance)
        setting.tolerance = std::stod(fmt::format("{:.0e}", setting.tolerance * 0.1));
      else
        setting.step = rounded_down(0.5 * setting.step);
    }
  }

  void repeat() {
    budget_ = whole_budget_;
    done_ = 0;
    progress_.begin("repeats", static_cast<std::int64_t>(result_.rows.size()) * (most_repeats - 1));
    for (int round = 1; round < most_repeats; ++round) {
      for (Row& row : result_.rows) {
        progress_.update(done_++);
        const double once = row.seconds.front();
        if (once * round > worth_repeating || once > share_of_rest * left()) continue;
        rheo::Simulation simulation(scene_with(scene_, row.setting), options_);
        if (const auto seconds = timed_run(simulation)) row.seconds.push_back(*seconds);
      }
    }
    // The first run of several warmed up.
    for (Row& row : result_.rows)
      if (row.seconds.size() > 1) row.seconds.erase(row.seconds.begin());
  }

  // To the finest error wanted by the order, where halving the step did not come to it.
  void reach(rheo::IntegratorKind integrator, int order) {
    const Row* finest = nullptr;
    for (const Row& row : result_.rows)
      if (row.setting.integrator == integrator && (finest == nullptr || row.error < finest->error))
        finest = &row;
    if (finest == nullptr || finest->error <= finest_wanted || finest->error > order_shows) return;
    // A little beyond it: the order is not exact.
    const double shorter = std::pow(0.8 * finest_wanted / finest->error, 1.0 / order);
    const Setting setting{integrator, rounded_down(shorter * finest->setting.step), 0.0};
    const std::string what = fmt::format("{} {}", name_of(integrator), knob_of(setting));
    const double seconds = finest->median() / shorter;
    const std::string forecast =
        fmt::format("{}: an error of {} would take about {:.2g} s, by its order from the error at {}", what,
                    short_number(finest_wanted), seconds, knob_of(finest->setting));
    if (seconds <= std::min(longest_reach, share_of_reach * left())) {
      double cost = finest->median() / std::max(1.0, planned_steps(finest->setting));
      share_of_rest_ = 1.0;
      const Outcome outcome = run(setting, cost);
      share_of_rest_ = share_of_rest;
      if (outcome == Outcome::row && result_.rows.back().error <= finest_wanted) return;
    }
    result_.forecasts.push_back(forecast);
  }

  Rows take() { return std::move(result_); }

 private:
  double planned_steps(const Setting& setting) const {
    return static_cast<double>(rheo::Simulation(scene_with(scene_, setting), options_).planned_steps());
  }

  double left() const { return budget_ - since(start_); }

  void leave_out(const std::string& what, const std::string& why) { result_.left_out.push_back({what, why}); }

  std::string over_budget(double forecast) const {
    return fmt::format("would take about {:.2g} s, this and finer ones are left out (--budget)", forecast);
  }

  // 0 where there is none; why is noted.
  double largest_step(rheo::IntegratorKind integrator) {
    rheo::SimulationOptions any_step = options_;
    any_step.allow_unstable = true;
    try {
      const rheo::Simulation probe(scene_with(scene_, {integrator, scene_.time.duration, 0.0}), any_step);
      const double limit = probe.stable_step();
      if (limit == 0.0)
        leave_out(name_of(integrator), "no step of it is stable here, some vibrations are not damped");
      return std::min({limit, 1.0 / scene_.time.frame_rate, scene_.time.duration});
    } catch (const rheo::Error& error) {
      leave_out(name_of(integrator), first_line(error.what()));
      return 0.0;
    }
  }

  // Only what advances the state is timed; nullopt where it diverges.
  std::optional<double> timed_run(rheo::Simulation& simulation) const {
    double seconds = 0.0;
    for (const double t : reference_.exact.times) {
      const Clock::time_point start = Clock::now();
      if (simulation.advance(t)) return std::nullopt;
      seconds += since(start);
    }
    return seconds;
  }

  // A first run with its error.
  Outcome run(const Setting& setting, double& cost) {
    const std::string what = fmt::format("{} {}", name_of(setting.integrator), knob_of(setting));
    try {
      return run_simulation(setting, what, cost);
    } catch (const rheo::Error& error) {
      leave_out(what, first_line(error.what()));
      return Outcome::stop;
    }
  }

  Outcome run_simulation(const Setting& setting, const std::string& what, double& cost) {
    rheo::Simulation simulation(scene_with(scene_, setting), options_);
    const auto planned = static_cast<double>(simulation.planned_steps());
    if (cost == 0.0 && setting.tolerance > 0.0 && reference_.by_exponential()) {
      cost = reference_.exponential_seconds / planned;  // at most: that was to a finer tolerance
    } else if (cost == 0.0) {
      rheo::Simulation probe(scene_with(scene_, setting), options_);
      cost = seconds_per_step(probe);
    }
    const double most = share_of_rest_ * left();
    if (cost * planned > most) {
      leave_out(what, over_budget(cost * planned));
      return Outcome::stop;
    }
    Row row{setting, std::string(simulation.kernel()), simulation.threads(), 0.0, 0, {0.0}, 0.0};
    ErrorMeter meter(reference_.exact);
    std::vector<double> state;
    const std::vector<double>& times = reference_.exact.times;
    for (std::size_t k = 0; k < times.size(); ++k) {
      const Clock::time_point start = Clock::now();
      const auto divergence = simulation.advance(times[k]);
      row.seconds.front() += since(start);
      if (divergence) {
        leave_out(what, fmt::format("diverges, noticed at t = {:.4g} s", divergence->t));
        return setting.tolerance > 0.0 ? Outcome::stop : Outcome::diverged;
      }
      copy_state(simulation, state);
      meter.include(k, state);
      // The forecast was wrong.
      if (times[k] > 0.0 && row.seconds.front() > 2.0 * most && k + 1 < times.size()) {
        leave_out(what, over_budget(row.seconds.front() / times[k] * times.back()));
        return Outcome::stop;
      }
    }
    row.error = meter.error();
    row.largest_step = simulation.largest_step();
    row.force_evaluations = simulation.counters().force_evaluations;
    if (planned > 0.0) cost = row.seconds.front() / planned;
    result_.rows.push_back(std::move(row));
    return Outcome::row;
  }

  const rheo::Scene& scene_;
  rheo::SimulationOptions options_;
  const Reference& reference_;
  Progress& progress_;
  double budget_, whole_budget_;
  double share_of_rest_ = share_of_rest;
  Clock::time_point start_;
  std::int64_t done_ = 0;
  Rows result_;
};

}  // namespace

double Row::median() const {
  std::vector<double> sorted = seconds;
  std::ranges::sort(sorted);
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

double Row::spread() const {
  const auto [fastest, slowest] = std::ranges::minmax(seconds);
  return median() > 0.0 ? (slowest - fastest) / median() : 0.0;
}

Rows bench_runs(const rheo::Scene& scene, const rheo::SimulationOptions& options, const Reference& reference,
                std::optional<rheo::IntegratorKind> only, double budget, Progress& progress) {
  Bench bench(scene, options, reference, budget, progress);
  std::int64_t most = 0;
  for (const Family& family : families) most += family.most;
  progress.begin("runs", most);
  for (const Family& family : families)
    if (!only || *only == family.integrator) bench.sweep(family);
  bench.repeat();
  if (!only || *only == rheo::IntegratorKind::rk4) bench.reach(rheo::IntegratorKind::rk4, 4);
  progress.end();
  return bench.take();
}

}  // namespace app
