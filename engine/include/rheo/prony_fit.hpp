// A Prony series through measured relaxation: Maxwell branches, an elastic and a viscous part in parallel.
//
//   G(t)       = sum_k modulus_k exp(-t / time_k) + elastic, t > 0            (a viscous part is not seen by
//   it) G'(omega)  = sum_k modulus_k (omega time_k)^2 / (1 + (omega time_k)^2) + elastic G''(omega) = sum_k
//   modulus_k omega time_k / (1 + (omega time_k)^2) + omega viscous
//
// All moduli are >= 0. First a non-negative least squares problem over a logarithmic grid of times;
// neighbours on the grid become one term; times and moduli are refined together by Levenberg and Marquardt's
// method; then terms are merged or left out one by one, and the series of the lowest Bayesian information
// criterion
//
//   N ln(error^2) + (number of parameters) ln N        (error: rms as below, at least finest_fit)
//
// is the fit. The times stay where the data can tell of them: for G(t) from half the first time after 0 (a
// quarter, where there is a value at t = 0) to three times the last; for a sweep from 1 / (3 omega) of the
// highest to 3 / omega of the lowest frequency. What is slower is elastic, what is faster viscous.
//
// Error    of a point: |fit - measured| / scale, with relative weights scale = the measured value, at least
//          one hundredth of the largest modulus (of a sweep: of |G*| at that frequency); with absolute
//          weights scale = the largest modulus
// Source   Lawson and Hanson, Solving Least Squares Problems, 1974, chapter 23 (NNLS); Baumgaertel and
// Winter,
//          Determination of discrete relaxation and retardation time spectra from dynamic mechanical data,
//          Rheologica Acta 28, 1989; Moré, The Levenberg-Marquardt algorithm, 1978; Schwarz, Estimating the
//          dimension of a model, 1978
// Units    moduli [Pa], times [s], omega [rad/s], frequency [Hz], viscous [Pa s]
// Errors   Error::Kind::input: fewer than three points, a time < 0 or a frequency <= 0, a modulus below minus
// a
//          tenth of the largest one (noise about 0 is welcome), nothing above 0, all at one time
// Cost     more than 2000 points are averaged into so many logarithmic bins for the fit; the error is that of
//          all points
#pragma once

#include <span>
#include <vector>

namespace rheo {

struct PronyTerm {
  double modulus = 0.0;
  double time = 0.0;
};

struct PronySeries {
  std::vector<PronyTerm> terms;  // times rising
  double elastic = 0.0;
  double viscous = 0.0;
};

double prony_relaxation(const PronySeries& series, double t);
double prony_storage(const PronySeries& series, double omega);
double prony_loss(const PronySeries& series, double omega);

struct RelaxationPoint {
  double t = 0.0;
  double modulus = 0.0;
};

struct SweepPoint {
  double frequency = 0.0;  // [Hz]: omega = 2 pi frequency
  double storage = 0.0;
  double loss = 0.0;
};

enum class FitWeights { relative, absolute };

inline constexpr int most_prony_terms = 20;
inline constexpr double finest_fit = 1e-4;  // no rheometer is better

struct PronyOptions {
  int terms = 0;  // at most so many; 0: as many as the criterion finds, at most most_prony_terms
  FitWeights weights = FitWeights::relative;
};

struct PronyFit {
  PronySeries series;
  double rms = 0.0;  // of the points' errors; a sweep's storage and loss are two
  double largest = 0.0;
  double largest_at = 0.0;  // its time [s] or frequency [Hz]
};

// Points in any order, several at one time or frequency allowed.
PronyFit fit_relaxation(const std::vector<RelaxationPoint>& points, const PronyOptions& options = {});
PronyFit fit_sweep(const std::vector<SweepPoint>& points, const PronyOptions& options = {});

}  // namespace rheo
