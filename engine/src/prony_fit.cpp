#include "rheo/prony_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "prony_problem.hpp"
#include "prony_selection.hpp"
#include "rheo/error.hpp"
#include "rheo/limits.hpp"
#include "rheo/relaxation.hpp"

namespace rheo {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::size_t most_rows = 2000;  // points of the fit
constexpr std::size_t least_points = 3;  // of the data
constexpr double smallest_scale = 0.01;  // relative weights
constexpr double most_negative = 0.1;    // of the largest modulus: noise

// A point of either kind: x is a time [s] or omega [rad/s]; of a relaxation function only value[0] is there.
struct Sample {
  double x = 0.0;
  std::array<double, 2> value{};
  std::array<double, 2> scale{1.0, 1.0};
};

struct Data {
  PronyProblem::Kind kind;
  std::vector<Sample> samples;  // x rising
  std::size_t values() const { return kind == PronyProblem::Kind::sweep ? 2 : 1; }
};

[[noreturn]] void refuse(const std::string& text) {
  throw Error(Error::Kind::input, text);
}

void check(const Data& data) {
  const bool sweep = data.kind == PronyProblem::Kind::sweep;
  const char* what = sweep ? "frequency" : "time";
  if (data.samples.size() < least_points)
    refuse(fmt::format("{} point{}: at least {} are needed for a fit", data.samples.size(),
                       data.samples.size() == 1 ? "" : "s", least_points));
  double largest = 0.0;
  for (const Sample& s : data.samples) {
    const double shown = sweep ? s.x / (2.0 * std::numbers::pi) : s.x;
    const bool good = sweep ? of_usable_size(s.x) : s.x == 0.0 || of_usable_size(s.x);
    if (!good)
      refuse(fmt::format("{} {:g}: {} {:g} to {:g} is allowed{}", what, shown, sweep ? "Hz," : "s,",
                         smallest_size, largest_size, sweep ? "" : ", and 0"));
    for (std::size_t k = 0; k < data.values(); ++k) {
      if (!within_size(s.value[k]))
        refuse(fmt::format("modulus {:g} at {} {:g}: at most {:g} is allowed", s.value[k], what, shown,
                           largest_size));
      largest = std::max(largest, s.value[k]);
    }
  }
  if (largest < smallest_size) refuse("no modulus above 0: moduli are positive, under compression too");
  for (const Sample& s : data.samples) {
    for (std::size_t k = 0; k < data.values(); ++k) {
      if (s.value[k] < -most_negative * largest)
        refuse(fmt::format("modulus {:g} at {} {:g}: moduli are positive, under compression too", s.value[k],
                           what, sweep ? s.x / (2.0 * std::numbers::pi) : s.x));
    }
  }
  if (!(data.samples.back().x > data.samples.front().x) && data.samples.size() > 1)
    refuse(fmt::format("all points at {} {:g}: a fit needs several", what, data.samples.front().x));
}

void set_scales(Data& data, FitWeights weights) {
  const auto size = [](const Sample& s) { return std::hypot(s.value[0], s.value[1]); };
  double largest = 0.0;
  for (const Sample& s : data.samples) largest = std::max(largest, size(s));
  for (Sample& s : data.samples) {
    const double whole = data.kind == PronyProblem::Kind::sweep ? size(s) : largest;
    for (std::size_t k = 0; k < data.values(); ++k) {
      s.scale[k] =
          weights == FitWeights::absolute ? largest : std::max(std::abs(s.value[k]), smallest_scale * whole);
      s.scale[k] = std::max(s.scale[k], 1e-6 * largest);
    }
  }
}

// The samples from `first` on that share a bin, as one row: the mean by the points' weights.
struct Bin {
  double x = 0.0;
  std::array<double, 2> value{}, weight{};
  double scatter = 0.0;  // squares of the scaled differences from the mean
};

Bin mean_of(std::span<const Sample> samples, std::size_t values) {
  Bin bin;
  for (const Sample& s : samples) {
    bin.x += s.x / static_cast<double>(samples.size());
    for (std::size_t k = 0; k < values; ++k) {
      const double w = 1.0 / (s.scale[k] * s.scale[k]);
      bin.value[k] += w * s.value[k];
      bin.weight[k] += w;
    }
  }
  for (std::size_t k = 0; k < values; ++k) {
    bin.value[k] /= bin.weight[k];
    bin.weight[k] = std::sqrt(bin.weight[k]);
    for (const Sample& s : samples) {
      const double difference = (s.value[k] - bin.value[k]) / s.scale[k];
      bin.scatter += difference * difference;
    }
  }
  return bin;
}

std::vector<Bin> binned(const Data& data) {
  std::vector<Bin> bins;
  const std::span<const Sample> all = data.samples;
  const auto first_positive = std::find_if(all.begin(), all.end(), [](const Sample& s) { return s.x > 0.0; });
  const double low = std::log(first_positive->x), span = std::log(all.back().x) - low;
  const auto bin_of = [&](const Sample& s) -> double {
    if (s.x == 0.0) return -1.0;
    return std::floor((std::log(s.x) - low) / span * static_cast<double>(most_rows - 1));
  };
  for (std::size_t first = 0; first < all.size();) {
    std::size_t end = first + 1;
    if (all.size() > most_rows)
      while (end < all.size() && bin_of(all[end]) == bin_of(all[first])) ++end;
    bins.push_back(mean_of(all.subspan(first, end - first), data.values()));
    first = end;
  }
  return bins;
}

PronyProblem problem_of(const Data& data, const std::vector<Bin>& bins) {
  const auto n = static_cast<Index>(bins.size()), rows = n * static_cast<Index>(data.values());
  VectorXd x(n), measured(rows), weights(rows);
  for (Index i = 0; i < n; ++i) {
    const Bin& bin = bins[static_cast<std::size_t>(i)];
    x[i] = bin.x;
    for (std::size_t k = 0; k < data.values(); ++k) {
      measured[static_cast<Index>(k) * n + i] = bin.value[k];
      weights[static_cast<Index>(k) * n + i] = bin.weight[k];
    }
  }
  return {data.kind, std::move(x), measured, std::move(weights)};
}

PronySeries series_of(const PronyProblem& problem, const PronyGuess& guess) {
  PronySeries series;
  Index next = 0;
  for (const double log_time : guess.shape.log_times)
    series.terms.push_back({guess.moduli[next++], std::exp(log_time)});
  if (guess.shape.elastic) series.elastic = guess.moduli[next++];
  if (guess.shape.viscous) series.viscous = guess.moduli[next++] / problem.highest_x();
  return series;
}

PronyFit fit(Data data, const PronyOptions& options) {
  std::stable_sort(data.samples.begin(), data.samples.end(),
                   [](const Sample& a, const Sample& b) { return a.x < b.x; });
  check(data);
  set_scales(data, options.weights);
  const bool sweep = data.kind == PronyProblem::Kind::sweep;
  const double count = static_cast<double>(data.samples.size() * data.values());
  const std::vector<Bin> bins = binned(data);
  double scatter = 0.0;
  for (const Bin& bin : bins) scatter += bin.scatter;
  const PronyProblem problem = problem_of(data, bins);
  PronyFit result;
  result.series = series_of(problem, select_terms(problem, count, scatter, options));
  double squares = 0.0;
  for (const Sample& s : data.samples) {
    const std::array<double, 2> fitted =
        sweep ? std::array{prony_storage(result.series, s.x), prony_loss(result.series, s.x)}
              : std::array{prony_relaxation(result.series, s.x), 0.0};
    for (std::size_t k = 0; k < data.values(); ++k) {
      const double error = std::abs(fitted[k] - s.value[k]) / s.scale[k];
      squares += error * error;
      if (error <= result.largest) continue;
      result.largest = error;
      result.largest_at = sweep ? s.x / (2.0 * std::numbers::pi) : s.x;
    }
  }
  result.rms = std::sqrt(squares / count);
  return result;
}

}  // namespace

double prony_relaxation(const PronySeries& series, double t) {
  double r = series.elastic;
  for (const PronyTerm& term : series.terms) r += branch_relaxation(term.modulus, 1.0 / term.time, t);
  return r;
}

double prony_storage(const PronySeries& series, double omega) {
  double storage = series.elastic;
  for (const PronyTerm& term : series.terms) storage += branch_storage(term.modulus, 1.0 / term.time, omega);
  return storage;
}

double prony_loss(const PronySeries& series, double omega) {
  double loss = omega * series.viscous;
  for (const PronyTerm& term : series.terms) loss += branch_loss(term.modulus, 1.0 / term.time, omega);
  return loss;
}

PronyFit fit_relaxation(const std::vector<RelaxationPoint>& points, const PronyOptions& options) {
  Data data{PronyProblem::Kind::relaxation, {}};
  data.samples.reserve(points.size());
  for (const RelaxationPoint& p : points) data.samples.push_back({.x = p.t, .value = {p.modulus, 0.0}});
  return fit(std::move(data), options);
}

PronyFit fit_sweep(const std::vector<SweepPoint>& points, const PronyOptions& options) {
  Data data{PronyProblem::Kind::sweep, {}};
  data.samples.reserve(points.size());
  for (const SweepPoint& p : points)
    data.samples.push_back({.x = 2.0 * std::numbers::pi * p.frequency, .value = {p.storage, p.loss}});
  return fit(std::move(data), options);
}

}  // namespace rheo
