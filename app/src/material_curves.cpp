#include "material_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "rheo/relaxation.hpp"

namespace app {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

// Logarithmic from low to high, both ends included.
std::vector<double> spread(double low, double high) {
  constexpr double per_decade = 40.0;
  const double decades = std::log10(high / low);
  const int steps = std::clamp(static_cast<int>(std::ceil(per_decade * decades)), 100, 2000);
  std::vector<double> values;
  for (int k = 0; k < steps; ++k)
    values.push_back(low * std::pow(high / low, static_cast<double>(k) / steps));
  values.push_back(high);
  return values;
}

std::vector<double> times_of(const rheo::Scene& scene, const std::optional<rheo::Span>& times) {
  double low = times ? times->shortest / 100.0 : scene.time.duration / 1000.0;
  double high = times ? times->longest * 10.0 : scene.time.duration;
  if (scene.origin.measured) {
    for (const rheo::RelaxationPoint& point : scene.origin.measured->relaxation) {
      if (point.t > 0.0) low = std::min(low, point.t);
      high = std::max(high, point.t);
    }
  }
  std::vector<double> all{0.0};
  const std::vector<double> rest = spread(low, high);
  all.insert(all.end(), rest.begin(), rest.end());
  return all;
}

std::vector<double> frequencies_of(const rheo::Scene& scene, const std::optional<rheo::Span>& times) {
  const double shortest = times ? times->shortest : scene.time.duration;
  const double longest = times ? times->longest : scene.time.duration;
  double low = 0.01 / (two_pi * longest), high = 100.0 / (two_pi * shortest);
  if (scene.origin.measured) {
    for (const rheo::SweepPoint& point : scene.origin.measured->sweep) {
      low = std::min(low, point.frequency);
      high = std::max(high, point.frequency);
    }
  }
  return spread(low, high);
}

using Columns = std::vector<const std::vector<double>*>;

std::string csv_of(const char* header, const Columns& columns) {
  std::string text = header;
  for (std::size_t i = 0; i < columns.front()->size(); ++i)
    for (std::size_t k = 0; k < columns.size(); ++k)
      text += fmt::format("{}{:.17g}", k == 0 ? "\n" : ",", (*columns[k])[i]);
  return text + "\n";
}

}  // namespace

MaterialCurves curves_of(const rheo::Scene& scene) {
  MaterialCurves curves;
  const std::optional<rheo::Span> times = rheo::relaxation_times(scene.material);
  curves.t = times_of(scene, times);
  for (const double t : curves.t) {
    const rheo::Moduli r = rheo::relaxation(scene.material, t);
    curves.r_lambda.push_back(r.lambda);
    curves.r_mu.push_back(r.mu);
  }
  curves.frequency = frequencies_of(scene, times);
  for (const double frequency : curves.frequency) {
    const rheo::ComplexModuli g = rheo::complex_moduli(scene.material, two_pi * frequency);
    curves.lambda_storage.push_back(g.storage.lambda);
    curves.lambda_loss.push_back(g.loss.lambda);
    curves.mu_storage.push_back(g.storage.mu);
    curves.mu_loss.push_back(g.loss.mu);
  }
  return curves;
}

std::string relaxation_csv(const MaterialCurves& c) {
  return csv_of("t,r_lambda,r_mu", {&c.t, &c.r_lambda, &c.r_mu});
}

std::string moduli_csv(const MaterialCurves& c) {
  return csv_of("frequency,lambda_storage,lambda_loss,mu_storage,mu_loss",
                {&c.frequency, &c.lambda_storage, &c.lambda_loss, &c.mu_storage, &c.mu_loss});
}

FitCurves fit_curves_of(const rheo::MeasuredMaterial& measured) {
  constexpr double marks = 300.0;  // that a picture is wide enough for
  FitCurves curves;
  curves.sweep = !measured.sweep.empty();
  std::vector<std::array<double, 3>> points;
  for (const rheo::RelaxationPoint& p : measured.relaxation)
    if (p.t > 0.0) points.push_back({p.t, p.modulus, 0.0});
  for (const rheo::SweepPoint& p : measured.sweep) points.push_back({p.frequency, p.storage, p.loss});
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
  const double low = points.front()[0], high = points.back()[0];
  const bool many = static_cast<double>(points.size()) > marks;
  double last_place = -1.0;
  for (const auto& [x, value, loss] : points) {
    const double place = high > low ? std::floor(marks * std::log(x / low) / std::log(high / low)) : 0.0;
    if (many && place == last_place) continue;
    last_place = place;
    curves.data_x.push_back(x);
    curves.data.push_back(value);
    curves.data_loss.push_back(loss);
  }
  curves.x = spread(low, std::max(high, 1.01 * low));
  const rheo::PronySeries& series = measured.fit.series;
  for (const double x : curves.x) {
    curves.fit.push_back(curves.sweep ? rheo::prony_storage(series, two_pi * x)
                                      : rheo::prony_relaxation(series, x));
    curves.fit_loss.push_back(rheo::prony_loss(series, two_pi * x));
  }
  return curves;
}

}  // namespace app
