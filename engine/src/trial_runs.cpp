#include "trial_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "rheo/error.hpp"
#include "rheo/integrator.hpp"
#include "timeline.hpp"

namespace rheo {
namespace {

constexpr double safety = 1.5;    // the accuracy over the error that may be estimated
constexpr int most_levels = 10;   // of trial runs: steps 2^10 times shorter than the coarsest
constexpr int most_halvings = 4;  // of the coarsest step, where the trial runs diverge with it
constexpr double finer = 1.02;    // from one refinement that is considered to the next
constexpr double confirmed =
    0.85;  // of the order: what neighbouring levels must show for it to be carried on
constexpr double unconfirmed = 0.5;  // of the order: assumed where one difference is all there is
constexpr double most_kept = 128e6;  // bytes of a run's states

[[noreturn]] void refuse(const Scene& scene, const std::string& text) {
  const std::string& where = scene.time.where;
  throw Error(Error::Kind::input, where.empty() ? text : where + " " + text);
}

using Blocks = std::array<std::span<const double>, 4>;

Blocks blocks_of(const Simulation& s) {
  return {s.u(), s.v(), s.w_lambda(), s.w_mu()};
}

// The largest difference of two runs of one scene, as the error is defined.
class Comparison {
 public:
  void include(const Blocks& a, const Blocks& b) {
    for (std::size_t k = 0; k < a.size(); ++k) {
      double difference = 0.0, size = 0.0;
      for (std::size_t i = 0; i < a[k].size(); ++i) {
        difference += (a[k][i] - b[k][i]) * (a[k][i] - b[k][i]);
        size += b[k][i] * b[k][i];
      }
      difference_[k] = std::max(difference_[k], std::sqrt(difference));
      size_[k] = std::max(size_[k], std::sqrt(size));
    }
  }

  // Of blocks that move at all.
  double relative() const {
    double largest = 0.0;
    for (std::size_t k = 0; k < size_.size(); ++k) {
      if (size_[k] > 0.0) largest = std::max(largest, difference_[k] / size_[k]);
    }
    return largest;
  }

 private:
  std::array<double, 4> difference_{}, size_{};
};

// A run that can be had several times: once computed, its states at the outputs are kept where they are few.
class Course {
 public:
  Course(Scene scene, SimulationOptions options) : scene_(std::move(scene)), options_(std::move(options)) {
    const double nodes = scene_.mesh.node_count();
    keeps_ = 64.0 * nodes * static_cast<double>(output_count(scene_.time) + 1) <= most_kept;
  }

  void rewind() {
    next_ = 0;
    if (complete_) {
      simulation_.reset();
    } else {
      record_.clear();
      simulation_.emplace(scene_, options_);
    }
  }

  // To the next output; false where the run diverges.
  bool advance(double t) {
    ++next_;
    return complete_ || !simulation_->advance(t);
  }

  Blocks blocks() {
    if (!complete_) {
      const Blocks now = blocks_of(*simulation_);
      if (keeps_) {
        for (const auto& block : now) record_.insert(record_.end(), block.begin(), block.end());
      }
      return now;
    }
    const std::size_t part = 2 * static_cast<std::size_t>(scene_.mesh.node_count());
    const double* begin = record_.data() + (next_ - 1) * 4 * part;
    return {std::span(begin, part), std::span(begin + part, part), std::span(begin + 2 * part, part),
            std::span(begin + 3 * part, part)};
  }

  // All outputs were passed; returns the evaluations that it took.
  double finish() {
    if (complete_) return 0.0;
    complete_ = keeps_;
    return static_cast<double>(simulation_->counters().force_evaluations);
  }

 private:
  Scene scene_;
  SimulationOptions options_;
  std::optional<Simulation> simulation_;
  std::vector<double> record_;
  std::size_t next_ = 0;
  bool keeps_ = false;
  bool complete_ = false;
};

// The trial runs: level k has 2^k steps for each of the coarsest.
class Trials {
 public:
  Trials(const Scene& scene, const SimulationOptions& options, double coarsest)
      : scene_(scene), options_(options), planning_(options.planning) {
    scene_.time.step = coarsest;
    options_.energies = false;
    options_.planning = {};
  }

  double coarsest() const { return scene_.time.step; }
  void halve_coarsest() {
    scene_.time.step *= 0.5;
    fine_.reset();
  }
  double evaluations() const { return evaluations_; }

  // Of levels k and k + 1; empty where one of them diverges.
  std::optional<double> difference(int k) {
    if (fine_level_ == k && fine_) {
      coarse_ = std::move(fine_);
    } else {
      coarse_.emplace(at_level(k), options_);
    }
    fine_.emplace(at_level(k + 1), options_);
    fine_level_ = k + 1;
    return compare(*coarse_, *fine_);
  }

  // Of level k to the exponential integrator's run.
  std::optional<double> error(int k, double tolerance) {
    if (!exact_) {
      Scene exact = scene_;
      exact.time.step = 0.0;
      exact.time.integrator = IntegratorKind::exponential;
      exact.time.tolerance = tolerance;
      exact_.emplace(std::move(exact), options_);
    }
    coarse_.emplace(at_level(k), options_);
    return compare(*coarse_, *exact_);
  }

 private:
  Scene at_level(int k) const {
    Scene scene = scene_;
    scene.time.refinement = std::ldexp(1.0, k);
    return scene;
  }

  std::optional<double> compare(Course& coarse, Course& fine) {
    ++trial_;
    coarse.rewind();
    fine.rewind();
    Comparison comparison;
    const TimeSettings& time = scene_.time;
    const std::int64_t outputs = output_count(time);
    for (std::int64_t i = 0; i <= outputs; ++i) {
      const double t = i < outputs ? output_time(time, i) : time.duration;
      if (!coarse.advance(t) || !fine.advance(t)) return std::nullopt;
      comparison.include(coarse.blocks(), fine.blocks());
      if (planning_) planning_(trial_, t / time.duration);
    }
    evaluations_ += coarse.finish() + fine.finish();
    const double result = comparison.relative();
    return std::isfinite(result) ? std::optional(result) : std::nullopt;
  }

  Scene scene_;
  SimulationOptions options_;
  std::function<void(int, double)> planning_;
  std::optional<Course> coarse_, fine_, exact_;
  int fine_level_ = 0;
  double evaluations_ = 0.0;
  int trial_ = 0;
};

// The error as a function of the step: measured at levels 0, 1, ... of the trial runs, log-linear between
// them, by the order beyond the finest.
class ErrorCurve {
 public:
  ErrorCurve(std::vector<double> errors, double order) : errors_(std::move(errors)), order_(order) {}

  // From the differences of levels k and k + 1; ratio: of the finest level's error to the next one's.
  static ErrorCurve from_differences(const std::vector<double>& differences, double ratio, double order) {
    std::vector<double> errors(differences.size() + 1);
    errors.back() = differences.back() / (ratio - 1.0);
    for (std::size_t k = differences.size(); k-- > 0;) errors[k] = differences[k] + errors[k + 1];
    return {std::move(errors), order};
  }

  // Everywhere at least `refinement` >= 1 times the steps of level 0.
  double at(double refinement) const {
    const double level = std::log2(refinement);
    const double last = static_cast<double>(errors_.size() - 1);
    if (level >= last) return errors_.back() * std::exp2(order_ * (last - level));
    const auto k = static_cast<std::size_t>(std::max(level, 0.0));
    const double part = std::max(level, 0.0) - static_cast<double>(k);
    if (errors_[k + 1] <= 0.0) return errors_[k];
    return errors_[k] * std::pow(errors_[k + 1] / errors_[k], part);
  }

 private:
  std::vector<double> errors_;
  double order_;
};

// The least that comes to the wish, or some that is beyond `most`.
double refinement_for(const ErrorCurve& curve, double wish, double most) {
  double refinement = 1.0;
  while (curve.at(refinement) > wish && refinement <= most) refinement *= finer;
  return refinement;
}

}  // namespace

std::vector<Stretch> stretches_of(const Scene& scene) {
  std::vector<double> events = event_times(scene);
  std::map<std::int64_t, Stretch> found;  // by length, in billionths of an output interval
  const double unit = 1e-9 / scene.time.frame_rate;
  double t = 0.0;
  std::size_t next = 1;
  const auto run_to = [&](double target) {
    while (t < target && !same_time(t, target)) {
      const double event = next < events.size() ? events[next] : forever;
      const bool passes = event <= target || same_time(event, target);
      const double end = passes ? event : target;
      const double in_units = std::min((end - t) / unit, 9e18);
      Stretch& stretch = found[std::llround(in_units)];
      stretch.length = std::max(stretch.length, end - t);
      ++stretch.count;
      t = end;
      if (passes) ++next;
    }
  };
  for (std::int64_t k = 0; k < output_count(scene.time); ++k) run_to(output_time(scene.time, k));
  run_to(scene.time.duration);
  std::vector<Stretch> stretches;
  for (const auto& [key, stretch] : found) stretches.push_back(stretch);
  return stretches;
}

double steps_at(const std::vector<Stretch>& stretches, double step, double refinement) {
  constexpr double slack = 1.0 - 1e-12;
  double steps = 0.0;
  for (const Stretch& s : stretches) {
    const double coarse = std::max(1.0, std::ceil(s.length / step * slack));
    steps += static_cast<double>(s.count) * std::ceil(refinement * coarse * slack);
  }
  return steps;
}

StepChoice choose_step_for(const Scene& scene, const SimulationOptions& options, double coarsest,
                           double accuracy, Yardstick yardstick, double most_evaluations) {
  const double wish = accuracy / safety;
  const auto integrator = make_integrator(scene.time.integrator, 1);
  const int order = integrator->order();
  const double gain = std::exp2(order), enough = std::exp2(confirmed * order);
  const bool measured = yardstick == Yardstick::exponential;
  Trials trials(scene, options, coarsest);
  const auto choice = [&](double refinement, double estimate) {
    return StepChoice{trials.coarsest(), refinement, estimate, trials.evaluations()};
  };

  std::vector<double> found;  // errors of levels 0, 1, ..., or differences of neighbouring ones
  int level = 0;
  for (int halvings = 0; level < most_levels && trials.evaluations() <= most_evaluations;) {
    const auto next = measured ? trials.error(level, std::max(reference_share * wish, finest_tolerance))
                               : trials.difference(level);
    if (!next && level == 0 && halvings < most_halvings) {
      trials.halve_coarsest();
      ++halvings;
      continue;
    }
    if (!next) {
      refuse(scene,
             fmt::format("accuracy = {:g}: its trial runs diverge, with steps of {:.4g} s too: check the "
                         "scene's loads and motions",
                         accuracy, std::ldexp(trials.coarsest(), -level)));
    }
    found.push_back(*next);
    ++level;
    const double ratio = level > 1 ? found[found.size() - 2] / found.back() : 0.0;
    const auto curve = [&](double factor, double beyond) {
      return measured ? ErrorCurve(found, beyond) : ErrorCurve::from_differences(found, factor, beyond);
    };
    if (ratio >= enough || (measured && found.back() <= wish)) {
      const ErrorCurve confirmed_curve = curve(std::min(ratio, gain), order);
      const double refinement = refinement_for(confirmed_curve, wish, forever);
      return choice(refinement, confirmed_curve.at(refinement));
    }
    // Without the order, with half of it or the less that shows: finer steps than those needed, where they
    // cost no more than another trial run and the run that it might allow (which the full order puts at
    // best). Beyond the finest level only where two levels show something; errors of one level tell nothing
    // of it.
    if (level > 1 ? ratio <= 1.0 : measured) continue;
    const double shown = level > 1 ? std::min(unconfirmed * order, std::log2(ratio)) : unconfirmed * order;
    const ErrorCurve careful = curve(std::exp2(shown), shown);
    const double next_trial = std::exp2(measured ? level : level + 1);
    const double fine = refinement_for(careful, wish, level > 1 ? 2.0 * next_trial : std::exp2(level));
    const double hoped = refinement_for(curve(gain, order), wish, 2.0 * next_trial);
    if (careful.at(fine) <= wish && fine <= next_trial + hoped) return choice(fine, careful.at(fine));
  }
  refuse(
      scene,
      fmt::format("accuracy = {:g}: {} does not come to it here, runs with steps of {:.3g} s and of half of "
                  "it still differ by {:.2g}",
                  accuracy, integrator->name(), std::ldexp(trials.coarsest(), 1 - level),
                  found.empty() ? 0.0 : found.back()));
}

}  // namespace rheo
