// Fits of made-up data: what is known is found again, within the noise.
#include "rheo/prony_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "io_error_of.hpp"

namespace rheo {
namespace {

using testing::error_of;
using ::testing::HasSubstr;

const PronySeries known{{{1000.0, 0.5}, {500.0, 8.0}, {300.0, 120.0}}, 200.0, 0.0};

// `count` values from low to high, equally far apart in their logarithms.
std::vector<double> spread(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(low * std::pow(high / low, i / (count - 1.0)));
  return values;
}

// With a relative error of that standard deviation.
std::vector<RelaxationPoint> relaxation_data(const PronySeries& series, const std::vector<double>& times,
                                             double noise) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::vector<RelaxationPoint> points;
  for (const double t : times)
    points.push_back({t, prony_relaxation(series, t) * (1.0 + noise * normal(random))});
  return points;
}

std::vector<SweepPoint> sweep_data(const PronySeries& series, const std::vector<double>& frequencies,
                                   double noise) {
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  std::vector<SweepPoint> points;
  for (const double f : frequencies) {
    const double omega = 2.0 * std::numbers::pi * f;
    points.push_back({f, prony_storage(series, omega) * (1.0 + noise * normal(random)),
                      prony_loss(series, omega) * (1.0 + noise * normal(random))});
  }
  return points;
}

void expect_series(const PronySeries& found, const PronySeries& expected, double tolerance) {
  ASSERT_EQ(found.terms.size(), expected.terms.size());
  for (std::size_t k = 0; k < found.terms.size(); ++k) {
    EXPECT_NEAR(found.terms[k].modulus, expected.terms[k].modulus, tolerance * expected.terms[k].modulus);
    EXPECT_NEAR(found.terms[k].time, expected.terms[k].time, tolerance * expected.terms[k].time);
  }
  EXPECT_NEAR(found.elastic, expected.elastic, tolerance * expected.elastic);
  EXPECT_NEAR(found.viscous, expected.viscous, tolerance * expected.viscous);
}

void expect_non_negative(const PronySeries& series) {
  for (const PronyTerm& term : series.terms) {
    EXPECT_GT(term.modulus, 0.0);
    EXPECT_GT(term.time, 0.0);
  }
  EXPECT_GE(series.elastic, 0.0);
  EXPECT_GE(series.viscous, 0.0);
}

// The method's own stop is at 1e-12; a sum of exponentials is worse conditioned than that by a few digits.
TEST(PronyFit, FindsTheSeriesBehindExactData) {
  const PronyFit fit = fit_relaxation(relaxation_data(known, spread(0.05, 500.0, 60), 0.0));
  expect_series(fit.series, known, 1e-8);
  EXPECT_LT(fit.rms, 1e-10);
  PronySeries flowing = known;
  flowing.viscous = 3.0;
  const PronyFit sweep = fit_sweep(sweep_data(flowing, spread(1e-3, 100.0, 30), 0.0));
  expect_series(sweep.series, flowing, 1e-8);
  EXPECT_LT(sweep.rms, 1e-10);
}

// Least squares with p of N parameters fitted lie off the truth by noise sqrt(p / N), root mean square.
TEST(PronyFit, LiesWithinTheNoiseOfTheTruth) {
  for (const double noise : {0.003, 0.01, 0.03}) {
    const std::vector<double> times = spread(0.05, 500.0, 200);
    const PronyFit fit = fit_relaxation(relaxation_data(known, times, noise));
    expect_non_negative(fit.series);
    const double parameters = 2.0 * static_cast<double>(fit.series.terms.size()) + 1.0;
    double squares = 0.0;
    for (const double t : times)
      squares += std::pow(prony_relaxation(fit.series, t) / prony_relaxation(known, t) - 1.0, 2);
    // Twice, for the luck of one draw.
    EXPECT_LT(std::sqrt(squares / 200.0), 2.0 * noise * std::sqrt(parameters / 200.0)) << noise;
    EXPECT_NEAR(fit.rms, noise,
                0.15 * noise);               // 200 values: 5 % standard deviation of a deviation, three times
    EXPECT_LE(fit.series.terms.size(), 4u);  // noise is not fitted
  }
}

TEST(PronyFit, OfASweepLiesWithinTheNoiseOfTheTruth) {
  PronySeries flowing = known;
  flowing.viscous = 3.0;
  for (const double noise : {0.003, 0.01, 0.03}) {
    const std::vector<double> frequencies = spread(1e-3, 100.0, 100);
    const PronyFit fit = fit_sweep(sweep_data(flowing, frequencies, noise));
    expect_non_negative(fit.series);
    const double parameters = 2.0 * static_cast<double>(fit.series.terms.size()) + 2.0;
    double squares = 0.0;
    for (const double f : frequencies) {
      const double omega = 2.0 * std::numbers::pi * f;
      squares += std::pow(prony_storage(fit.series, omega) / prony_storage(flowing, omega) - 1.0, 2) +
                 std::pow(prony_loss(fit.series, omega) / prony_loss(flowing, omega) - 1.0, 2);
    }
    EXPECT_LT(std::sqrt(squares / 200.0), 2.0 * noise * std::sqrt(parameters / 200.0)) << noise;
    EXPECT_NEAR(fit.rms, noise, 0.15 * noise);
    EXPECT_LE(fit.series.terms.size(), 5u);
  }
}

TEST(PronyFit, ManyPointsAreOneFitOfAllOfThem) {
  std::vector<double> times;
  for (int i = 0; i < 50'000; ++i) times.push_back(0.01 * (i + 1));
  const PronyFit exact = fit_relaxation(relaxation_data(known, times, 0.0));
  // 2000 bins over 4.7 decades are 0.5 % wide; a mean over one is off by a 24th of that squared, at most.
  expect_series(exact.series, known, 1e-4);
  EXPECT_LT(exact.rms, 2e-6);
  const PronyFit noisy = fit_relaxation(relaxation_data(known, times, 0.02));
  EXPECT_NEAR(noisy.rms, 0.02, 0.0004);
  EXPECT_LE(noisy.series.terms.size(), 4u);
  EXPECT_NEAR(noisy.series.elastic, known.elastic, 0.02 * known.elastic);
}

TEST(PronyFit, OfAPowerLawIsGoodWithFewTerms) {
  std::vector<RelaxationPoint> points;
  for (const double t : spread(1e-3, 1e3, 200)) points.push_back({t, 100.0 * std::pow(t, -0.3)});
  const PronyFit free = fit_relaxation(points);
  EXPECT_LT(free.rms, 10.0 * finest_fit);
  EXPECT_LE(free.series.terms.size(), static_cast<std::size_t>(most_prony_terms));
  double before = 1.0;
  for (int terms = 1; terms <= 6; ++terms) {
    const PronyFit fit = fit_relaxation(points, {.terms = terms});
    EXPECT_LE(fit.series.terms.size(), static_cast<std::size_t>(terms));
    expect_non_negative(fit.series);
    EXPECT_LT(fit.rms, before) << terms;  // each term helps
    before = fit.rms;
  }
  EXPECT_LT(before, 0.02);  // one term a decade
}

TEST(PronyFit, OfNoRelaxationIsElastic) {
  const PronyFit fit = fit_relaxation({{0.0, 50.0}, {1.0, 50.0}, {2.0, 50.0}, {3.0, 50.0}});
  EXPECT_TRUE(fit.series.terms.empty());
  EXPECT_NEAR(fit.series.elastic, 50.0, 1e-12);
  const PronyFit sweep = fit_sweep({{1.0, 0.0, 3.0}, {2.0, 0.0, 6.0}, {3.0, 0.0, 9.0}});
  EXPECT_TRUE(sweep.series.terms.empty());
  EXPECT_NEAR(sweep.series.viscous, 3.0 / (2.0 * std::numbers::pi), 1e-12);
}

// A modulus that is all relaxed, measured with one error for all values.
TEST(PronyFit, AbsoluteWeightsServeDataThatSinkIntoNoise) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<RelaxationPoint> points;
  for (int i = 0; i < 300; ++i)
    points.push_back({0.02 * i, 100.0 * std::exp(-0.02 * i / 0.3) + normal(random)});
  const PronyFit fit = fit_relaxation(points, {.weights = FitWeights::absolute});
  ASSERT_EQ(fit.series.terms.size(), 1u);
  // One percent of noise on about 15 values within a relaxation time, three standard deviations.
  EXPECT_NEAR(fit.series.terms[0].modulus, 100.0, 1.5);
  EXPECT_NEAR(fit.series.terms[0].time, 0.3, 0.01);
  EXPECT_NEAR(fit.rms, 0.01, 0.0015);
}

TEST(PronyFit, TellsTheLargestErrorAndWhere) {
  std::vector<RelaxationPoint> points = relaxation_data(known, spread(0.05, 500.0, 100), 0.0);
  points[40].modulus *= 1.5;
  const PronyFit fit = fit_relaxation(points);
  EXPECT_DOUBLE_EQ(fit.largest_at, points[40].t);
  const double fitted = prony_relaxation(fit.series, points[40].t);
  EXPECT_NEAR(fit.largest, 1.0 - fitted / points[40].modulus, 1e-12);
}

TEST(PronyFit, DoesNotMindOrderRepetitionAndUnits) {
  std::vector<RelaxationPoint> points = relaxation_data(known, spread(0.05, 500.0, 60), 0.0);
  std::shuffle(points.begin(), points.end(), std::mt19937(1));
  points.insert(points.end(), points.begin(), points.begin() + 20);
  expect_series(fit_relaxation(points).series, known, 1e-8);
  for (RelaxationPoint& p : points) {
    p.t *= 1e8;
    p.modulus *= 1e-8;
  }
  PronySeries scaled = known;
  for (PronyTerm& term : scaled.terms) term = {1e-8 * term.modulus, 1e8 * term.time};
  scaled.elastic *= 1e-8;
  expect_series(fit_relaxation(points).series, scaled, 1e-8);
}

// Of whatever sizes, in whatever order, rising as well as falling.
TEST(PronyFit, AnyDataGiveAUsableSeriesOrAnError) {
  std::mt19937 random(99);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int fits = 0;
  for (int repeat = 0; repeat < 300; ++repeat) {
    const double x_middle = std::pow(10.0, 40.0 * unit(random) - 20.0), x_decades = 12.0 * unit(random);
    const double size = std::pow(10.0, 40.0 * unit(random) - 20.0), decades = 6.0 * unit(random);
    const auto x = [&] { return x_middle * std::pow(10.0, x_decades * (unit(random) - 0.5)); };
    const auto modulus = [&] { return size * (std::pow(10.0, decades * (unit(random) - 1.0)) - 0.02); };
    const int count = 3 + static_cast<int>(40 * unit(random));
    PronyOptions options{.terms = static_cast<int>(4 * unit(random)),
                         .weights = unit(random) < 0.5 ? FitWeights::relative : FitWeights::absolute};
    try {
      PronyFit fit;
      if (unit(random) < 0.5) {
        std::vector<RelaxationPoint> points;
        for (int i = 0; i < count; ++i) points.push_back({unit(random) < 0.1 ? 0.0 : x(), modulus()});
        fit = fit_relaxation(points, options);
      } else {
        std::vector<SweepPoint> points;
        for (int i = 0; i < count; ++i) points.push_back({x(), modulus(), modulus()});
        fit = fit_sweep(points, options);
      }
      ++fits;
      expect_non_negative(fit.series);
      EXPECT_TRUE(std::isfinite(fit.rms) && std::isfinite(fit.largest)) << repeat;
      for (const PronyTerm& term : fit.series.terms)
        EXPECT_TRUE(std::isfinite(term.modulus) && std::isfinite(term.time)) << repeat;
      EXPECT_TRUE(std::isfinite(fit.series.elastic) && std::isfinite(fit.series.viscous)) << repeat;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(fits, 200);  // the others are too negative
}

TEST(PronyFit, RefusesWhatIsNoRelaxation) {
  const auto refusal = [](const std::vector<RelaxationPoint>& points) {
    return error_of([&] { fit_relaxation(points); });
  };
  EXPECT_THAT(refusal({{0.0, 1.0}, {1.0, 1.0}}), HasSubstr("2 points: at least 3 are needed"));
  EXPECT_THAT(refusal({{1.0, 1.0}, {1.0, 1.0}, {1.0, 2.0}}), HasSubstr("all points at time 1"));
  EXPECT_THAT(refusal({{-1.0, 1.0}, {1.0, 1.0}, {2.0, 2.0}}), HasSubstr("time -1"));
  EXPECT_THAT(refusal({{0.0, -5.0}, {1.0, -3.0}, {2.0, -2.0}}), HasSubstr("no modulus above 0"));
  EXPECT_THAT(refusal({{0.0, 5.0}, {1.0, -3.0}, {2.0, 2.0}}), HasSubstr("modulus -3 at time 1"));
  EXPECT_THAT(refusal({{0.0, 5.0}, {1.0, 1e31}, {2.0, 2.0}}), HasSubstr("modulus 1e+31"));
  EXPECT_THAT(error_of([] {
                fit_sweep({{0.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, {2.0, 1.0, 1.0}});
              }),
              HasSubstr("frequency 0"));
  EXPECT_NO_THROW(fit_relaxation({{0.0, 5.0}, {1.0, 0.1}, {2.0, -0.1}}));
}

}  // namespace
}  // namespace rheo
