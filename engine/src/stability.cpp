#include "rheo/stability.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "material_modes.hpp"
#include "mode_root.hpp"

namespace rheo {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
// Half a disk of this radius lies in RK4's region of stability (which narrows to 2.616 between the axes).
constexpr double rk4_inner_radius = 2.61;

bool has_no_limit(IntegratorKind integrator) {
  return integrator == IntegratorKind::exponential || integrator == IntegratorKind::implicit;
}

// |R(z)|^2 - 1 for the Taylor polynomial of degree 4.
double growth(std::complex<double> z) {
  const std::complex<double> r = 1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)));
  return std::norm(r) - 1.0;
}

// Where the ray from 0 in the direction of the unit number d leaves RK4's region of stability.
double rk4_radius(std::complex<double> d) {
  // On the imaginary axis |R(iy)|^2 = 1 - y^6/72 + y^8/576 exactly; rounding must not decide there.
  if (-d.real() < 1e-7) return 2.0 * std::numbers::sqrt2;
  double inside = rk4_inner_radius;
  double outside = inside;
  while (growth((outside += 0.1) * d) <= 0.0) inside = outside;
  for (int i = 0; i < 40; ++i) {  // to 1e-13
    const double middle = 0.5 * (inside + outside);
    (growth(middle * d) > 0.0 ? outside : inside) = middle;
  }
  return inside;
}

// Whether a step of this length may be too long for s; true where that is left to stable_step_of.
// (Within the left half plane the region's rays are whole: what is stable stays so with a shorter step.)
bool may_be_too_long(double step, std::complex<double> s, IntegratorKind integrator) {
  if (integrator != IntegratorKind::rk4 || !std::isfinite(step)) return true;
  const double size = std::abs(s);
  if (size * step < rk4_inner_radius) return false;
  const bool on_axis = -s.real() < 1e-7 * size;  // or beyond it: rk4_radius
  return on_axis || growth(step * s) > 0.0;
}

// Roots of s (s + p) (s + q) + W2 [a (s + q) + (1 - a) (s + p)] = 0: the modes with Rayleigh quotients a W2,
// (1 - a) W2.
Eigen::Vector3cd mode_roots(double w2, double a, double p, double q) {
  const double c2 = p + q;
  const double c1 = p * q + w2;
  const double c0 = w2 * (a * q + (1.0 - a) * p);
  // Scaled by the largest rate so that the companion matrix is balanced whatever the unit of time.
  const double scale = std::max({p, q, std::sqrt(w2)});
  Eigen::Matrix3d companion;
  companion << 0, 0, -c0 / (scale * scale * scale), 1, 0, -c1 / (scale * scale), 0, 1, -c2 / scale;
  return Eigen::EigenSolver<Eigen::Matrix3d>(companion, false).eigenvalues() * scale;
}

// Largest step that keeps all of `values` stable.
double step_of_eigenvalues(const std::vector<std::complex<double>>& values, IntegratorKind integrator) {
  double step = infinite;
  for (const std::complex<double> s : values) step = std::min(step, stable_step_of(s, integrator));
  return step;
}

}  // namespace

double stable_step_of(std::complex<double> s, IntegratorKind integrator) {
  const double size = std::abs(s);
  if (size == 0.0) return infinite;
  if (s.real() > 0.0) return 0.0;
  if (has_no_limit(integrator)) return infinite;
  const std::complex<double> direction = s / size;
  const double radius = integrator == IntegratorKind::euler ? -2.0 * direction.real() : rk4_radius(direction);
  return radius / size;
}

double Spectrum::largest_rate() const {
  double rate = viscous_max;
  for (const Relaxation& each : relaxations) rate = std::max(rate, each.rate);
  return std::max({rate, lambda_on ? lambda_rate : 0.0, mu_on ? mu_rate : 0.0});
}

double Spectrum::slowest_rate() const {
  if (!relaxations.empty()) return relaxations.front().rate;
  return std::min(lambda_on ? lambda_rate : infinite, mu_on ? mu_rate : infinite);
}

bool stable_step_is_bound(const Spectrum& spectrum, IntegratorKind integrator) {
  if (has_no_limit(integrator) || !spectrum.eigenvalues.empty()) return false;
  if (integrator == IntegratorKind::euler && spectrum.near_euler_step > 0.0) return false;
  if (spectrum.viscous_max > 0.0 || spectrum.several_materials) return true;
  if (integrator != IntegratorKind::euler) return false;
  return spectrum.relaxations.size() > 1 ||
         (spectrum.lambda_on && spectrum.mu_on && spectrum.lambda_rate != spectrum.mu_rate);
}

namespace {

// The modes of materials in parallel, by the quotients a and b that they may have (stability.hpp).
class ParallelModes {
 public:
  ParallelModes(const Spectrum& spectrum, IntegratorKind integrator)
      : spectrum_(spectrum),
        integrator_(integrator),
        parts_(static_cast<Eigen::Index>(spectrum.relaxations.size())),
        mode_(1 + parts_, 1 + parts_),
        solver_(1 + parts_),
        spacing_(parts_ > few_rates ? 1.0 / 3 : 1.0 / 8) {
    for (const Relaxation& each : spectrum.relaxations) {
      springs_.lambda += each.moduli.lambda;
      springs_.mu += each.moduli.mu;
      fastest_rate_ = std::max(fastest_rate_, each.rate);
    }
  }

  // The largest step that is stable for all of them.
  double limit() {
    for (const Relaxation& each : spectrum_.relaxations)
      if (each.rate > 0.0) step_ = std::min(step_, stable_step_of(-each.rate, integrator_));
    const double fastest = std::max({fastest_rate_, spectrum_.omega_max, spectrum_.viscous_max});
    const std::vector<double> ratios = sample_ratios();
    // From the largest down. Below a small part of the fastest rate no root can be the one that limits RK4;
    // Euler's limit 2 |Re s| / |s|^2 only grows downwards.
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      for (int k = 0; k < most_magnitudes; ++k) {
        const Mode mode = mode_at(ratios[i], k * spacing_);
        if (!(mode.b > 0.0)) break;
        if (k > 0 && std::max(mode.omega, mode.damping) < 0.02 * fastest) break;
        if (can_not_limit(mode)) break;
        if (!include(mode)) continue;
        best_ratio_ = ratios[i];
        best_decline_ = k * spacing_;
        span_ = ratios[std::min(i + 1, ratios.size() - 1)] - ratios[i > 0 ? i - 1 : 0];
      }
    }
    refine();
    return step_;
  }

 private:
  static constexpr int most_magnitudes = 128;
  static constexpr Eigen::Index few_rates =
      6;  // a mode's roots cost the cube of the rates: fewer samples beyond
  struct Mode {
    double ratio = 0.0;  // a / b
    double b = 0.0;
    double omega = 0.0, damping = 0.0;
  };

  // Even shares of lambda in the springs' quotient, and in the viscous part's.
  std::vector<double> sample_ratios() const {
    const int shares = parts_ > few_rates ? 6 : 16;
    std::vector<double> ratios{0.0, 1.0};
    for (const Moduli& moduli : {springs_, spectrum_.viscous}) {
      if (moduli.lambda == 0.0 || moduli.mu == 0.0) continue;
      const double highest = moduli.lambda / (moduli.lambda + moduli.mu);
      for (int i = 1; i < shares; ++i) {
        const double share = highest * i / shares;
        ratios.push_back(share / moduli.lambda / ((1.0 - share) / moduli.mu));
      }
    }
    std::sort(ratios.begin(), ratios.end());
    return ratios;
  }

  // b: 2^-decline of the largest that there may be.
  Mode mode_at(double ratio, double decline) const {
    const double spring = ratio * springs_.lambda + springs_.mu;
    const double dashpot = ratio * spectrum_.viscous.lambda + spectrum_.viscous.mu;
    double largest = infinite;
    if (spring > 0.0) largest = std::min(largest, spectrum_.omega_max * spectrum_.omega_max / spring);
    if (dashpot > 0.0) largest = std::min(largest, spectrum_.viscous_max / dashpot);
    if (!std::isfinite(largest)) return {};
    const double b = largest * std::exp2(-decline);
    return {ratio, b, std::sqrt(b * spring), b * dashpot};
  }

  // No root is larger than the numerical range.
  bool can_not_limit(const Mode& mode) const {
    const double largest = std::max(fastest_rate_, mode.damping) + mode.omega;
    return integrator_ == IntegratorKind::rk4 && largest * step_ < rk4_inner_radius;
  }

  // Whether the mode's roots want a shorter step.
  bool include(const Mode& mode) {
    const double before = step_;
    const auto take = [&](std::complex<double> s) {
      if (may_be_too_long(step_, s, integrator_)) step_ = std::min(step_, stable_step_of(s, integrator_));
    };
    const double size = std::max(fastest_rate_, mode.damping);
    if (size < 1e-8 * mode.omega) {
      // To first order: a general solver would lose the real part.
      double decay = mode.damping;
      for (const Relaxation& each : spectrum_.relaxations)
        decay += mode.b * stiffness(each, mode.ratio) * each.rate / (mode.omega * mode.omega);
      take({-0.5 * decay, mode.omega});
      return step_ < before;
    }
    springs_of_mode_.clear();
    mode_.setZero();  // on v and sqrt(stiffness) q of each rate: nearly normal
    mode_(0, 0) = -mode.damping;
    for (Eigen::Index i = 0; i < parts_; ++i) {
      const Relaxation& each = spectrum_.relaxations[static_cast<std::size_t>(i)];
      springs_of_mode_.push_back({mode.b * stiffness(each, mode.ratio), each.rate});
      const double coupling = std::sqrt(springs_of_mode_.back().stiffness);
      mode_(0, 1 + i) = -coupling;
      mode_(1 + i, 0) = coupling;
      mode_(1 + i, 1 + i) = -each.rate;
    }
    solver_.compute(mode_, false);
    // A real part that is rounding is none: the true one is never positive.
    for (const std::complex<double> s : solver_.eigenvalues()) {
      if (std::abs(s) > 1e-13 * (size + mode.omega)) take(sharpened_root(s, springs_of_mode_, mode.damping));
    }
    return step_ < before;
  }

  static double stiffness(const Relaxation& each, double ratio) {
    return ratio * each.moduli.lambda + each.moduli.mu;
  }

  // Between the samples: downhill from the best of them, in steps that halve.
  void refine() {
    if (best_ratio_ < 0.0) return;
    double decline_step = 0.5 * spacing_, ratio_step = 0.25 * span_;
    for (int halvings = 0; halvings < 10;) {
      bool better = false;
      for (const auto& [dr, dd] :
           {std::pair{ratio_step, 0.0}, {-ratio_step, 0.0}, {0.0, decline_step}, {0.0, -decline_step}}) {
        const double ratio = std::clamp(best_ratio_ + dr, 0.0, 1.0);
        const double decline = std::max(best_decline_ + dd, 0.0);
        const Mode mode = mode_at(ratio, decline);
        if (!(mode.b > 0.0) || !include(mode)) continue;
        best_ratio_ = ratio;
        best_decline_ = decline;
        better = true;
      }
      if (better) continue;
      ++halvings;
      decline_step *= 0.5;
      ratio_step *= 0.5;
    }
  }

  const Spectrum& spectrum_;
  IntegratorKind integrator_;
  Eigen::Index parts_;
  Eigen::MatrixXd mode_;
  std::vector<ModeSpring> springs_of_mode_;
  Eigen::EigenSolver<Eigen::MatrixXd> solver_;
  Moduli springs_;
  double spacing_;  // of magnitudes, in octaves
  double fastest_rate_ = 0.0;
  double step_ = infinite;
  double best_ratio_ = -1.0, best_decline_ = 0.0, span_ = 0.0;  // of the sample that limits; -1: none
};

// The modes of several materials under RK4, by the shares that rates may have in them (stability.hpp). For a
// given s the sum of c_k / (s + r_k) is a point in the hull of points on an arc of a circle, in the order of
// the rates: what is on the hull's edge, where the limiting s are, has two neighbouring rates or the first
// and the last.
class FreeModes {
 public:
  explicit FreeModes(const Spectrum& spectrum) : spectrum_(spectrum) {
    for (const Relaxation& each : spectrum.relaxations) rates_.push_back(each.rate);
  }

  double limit() {
    for (const double rate : rates_)
      if (rate > 0.0) take(-rate);
    if (rates_.empty()) {
      if (spectrum_.viscous_max > 0.0) take(-spectrum_.viscous_max);
      return step_;
    }
    pair(rates_.front(), rates_.back());
    for (std::size_t k = 0; k + 1 < rates_.size(); ++k) pair(rates_[k], rates_[k + 1]);
    return step_;
  }

 private:
  void take(std::complex<double> s) {
    if (may_be_too_long(step_, s, IntegratorKind::rk4))
      step_ = std::min(step_, stable_step_of(s, IntegratorKind::rk4));
  }

  void pair(double p, double q) {
    constexpr int shares = 8, dampings = 8;
    const int last = p == q ? 0 : shares;
    const double omega_max = spectrum_.omega_max, viscous_max = spectrum_.viscous_max;
    const double fastest = std::max({p, q, omega_max, viscous_max});
    for (int octave = 0; octave < 48; ++octave) {
      const double omega = omega_max * std::exp2(-octave / 8.0);
      if (octave > 0 && omega < 0.02 * fastest) break;
      for (int k = 0; k <= (viscous_max > 0.0 ? dampings : 0); ++k) {
        const double d = viscous_max * k / dampings;
        if ((std::max({p, q, d}) + omega) * step_ < rk4_inner_radius) continue;
        for (int i = 0; i <= last; ++i) mode(omega, static_cast<double>(i) / shares, p, q, d);
      }
    }
  }

  // s + d + omega^2 (a / (s + p) + (1 - a) / (s + q)) = 0
  void mode(double omega, double a, double p, double q, double d) {
    const double size = std::max({p, q, d});
    if (size < 1e-8 * omega) {
      // To first order: a general solver would lose the real part.
      take({-0.5 * (d + a * p + (1.0 - a) * q), omega});
      return;
    }
    const double first = omega * std::sqrt(a), second = omega * std::sqrt(1.0 - a);
    Eigen::Matrix3d m;
    m << -d, -first, -second, first, -p, 0, second, 0, -q;
    const Eigen::Vector3cd values = Eigen::EigenSolver<Eigen::Matrix3d>(m, false).eigenvalues();
    for (const std::complex<double> s : values) {
      if (std::abs(s) > 1e-13 * (size + omega)) take({std::min(s.real(), 0.0), s.imag()});
    }
  }

  const Spectrum& spectrum_;
  std::vector<double> rates_;
  double step_ = infinite;
};

}  // namespace

double stable_step(const Spectrum& spectrum, IntegratorKind integrator) {
  if (has_no_limit(integrator)) return infinite;
  double step = infinite;
  const bool rk4 = integrator == IntegratorKind::rk4;
  const bool parallel =
      spectrum.several_materials || !spectrum.relaxations.empty() || spectrum.viscous_max > 0.0;
  const auto include = [&](std::complex<double> s) {
    if (may_be_too_long(step, s, integrator)) step = std::min(step, stable_step_of(s, integrator));
  };

  const double p = spectrum.lambda_on ? spectrum.lambda_rate : 0.0;
  const double q = spectrum.mu_on ? spectrum.mu_rate : 0.0;
  if (spectrum.several_materials) {
    // (What lies between the samples moves the limit by less than the factors.)
    step = rk4 ? 0.995 * FreeModes(spectrum).limit() : 0.98 * euler_step_of_materials(spectrum);
  } else if (parallel) {
    step = ParallelModes(spectrum, integrator).limit();
  } else {
    // Deformations that leave a residual force without force decay by its own rate alone.
    if (p > 0.0) include(-p);
    if (q > 0.0) include(-q);
  }
  if (!parallel && spectrum.omega_max > 0.0) {
    const double fastest = std::max({p, q, spectrum.omega_max});
    const double damping = std::max(p, q);
    // Shares of lambda from none to the largest possible; magnitudes from the largest down. Below a small
    // part of the fastest rate no root can be the one that limits RK4; Euler's limit 2 |Re s| / |s|^2 only
    // grows downwards.
    constexpr int shares = 16;
    constexpr int magnitudes = 48;
    const double lowest_share = spectrum.mu_on ? 0.0 : 1.0;
    const double highest_share = spectrum.lambda_on ? spectrum.lambda_share : 0.0;
    for (int i = 0; i <= shares; ++i) {
      const double a = lowest_share + (highest_share - lowest_share) * i / shares;
      for (int k = 0; k < magnitudes; ++k) {
        const double omega = spectrum.omega_max * std::exp2(-k / 8.0);
        if (k > 0 && omega < 0.02 * fastest) break;
        // No root is larger than p + q + omega: |s (s + p) (s + q)| >= |s| (q + omega) (p + omega) then,
        // beyond omega^2 (|s| + max(p, q)).
        if (rk4 && (p + q + omega) * step < rk4_inner_radius) break;
        if (damping < 1e-8 * omega) {
          // Roots -(a p + (1 - a) q) / 2 +- i omega to first order: a general solver would lose the real
          // part.
          include({-0.5 * (a * p + (1.0 - a) * q), omega});
          continue;
        }
        for (std::complex<double> s : mode_roots(omega * omega, a, p, q)) {
          // A real part that is rounding is none: the true one is never positive.
          const double floor = 1e-13 * fastest;
          if (std::abs(s) <= floor || (rk4 && std::abs(s) * step < 0.99 * rk4_inner_radius)) continue;
          const ModeSpring springs[] = {{a * omega * omega, p}, {(1.0 - a) * omega * omega, q}};
          include(sharpened_root(s, springs, 0.0));
        }
      }
    }
  }
  // Between the samples the limit moves by less than this (checked against exact spectra in the tests).
  step *= 0.998;
  if (!spectrum.eigenvalues.empty()) {
    double exact = step_of_eigenvalues(spectrum.eigenvalues, integrator);
    // What was left at nodes that are held now decays by its rate alone.
    for (const Relaxation& each : spectrum.relaxations)
      if (each.rate > 0.0) exact = std::min(exact, stable_step_of(-each.rate, integrator));
    for (const double rate : {p, q})
      if (rate > 0.0) exact = std::min(exact, stable_step_of(-rate, integrator));
    // Where damping is lost in what rounding may have made of the eigenvalues, the samples know more of it.
    step = std::max(step, 0.998 * exact);
  }
  step = std::max(step, rk4 ? spectrum.rk4_step : std::max(spectrum.euler_step, spectrum.near_euler_step));
  // The double pole of a constraint: at the very edge it grows linearly, hence strictly inside.
  if (spectrum.baumgarte > 0.0)
    step = std::min(step, 0.998 * stable_step_of(-spectrum.baumgarte * (1.0 + 1e-6), integrator));
  return step;
}

}  // namespace rheo
