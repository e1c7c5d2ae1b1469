#include "rheo/stability.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

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
  double inside = 0.0;
  double outside = 0.0;
  for (double r = 0.1; r < 4.0; r += 0.1) {
    if (growth(r * d) > 0.0) {
      outside = r;
      break;
    }
    inside = r;
  }
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (inside + outside);
    (growth(middle * d) > 0.0 ? outside : inside) = middle;
  }
  return inside;
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

// Largest step that keeps all of `values` stable, whatever rounding did to them.
double step_of_eigenvalues(const std::vector<std::complex<double>>& values, IntegratorKind integrator) {
  constexpr double rounding = 1e-12;   // of the largest eigenvalue
  constexpr double unlimiting = 1e-6;  // rigid motion: zeros in Jordan blocks, moved by the rounding's root
  double largest = 0.0;
  for (const std::complex<double> s : values) largest = std::max(largest, std::abs(s));
  double step = infinite;
  for (const std::complex<double> s : values) {
    if (std::abs(s) < unlimiting * largest) continue;
    const double damped = std::min(s.real() + rounding * largest, 0.0);
    step = std::min(step, stable_step_of({damped, s.imag()}, integrator));
  }
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

bool stable_step_is_bound(const Spectrum& spectrum, IntegratorKind integrator) {
  return integrator == IntegratorKind::euler && spectrum.eigenvalues.empty() && spectrum.lambda_on &&
         spectrum.mu_on && spectrum.lambda_rate != spectrum.mu_rate;
}

double stable_step(const Spectrum& spectrum, IntegratorKind integrator) {
  if (has_no_limit(integrator)) return infinite;
  double step = infinite;
  const bool rk4 = integrator == IntegratorKind::rk4;
  const auto include = [&](std::complex<double> s) {
    if (rk4 && std::abs(s) * step < rk4_inner_radius) return;  // stable as it is
    step = std::min(step, stable_step_of(s, integrator));
  };

  const double p = spectrum.lambda_on ? spectrum.lambda_rate : 0.0;
  const double q = spectrum.mu_on ? spectrum.mu_rate : 0.0;
  // Deformations that leave a residual force without force decay by its own rate alone.
  if (p > 0.0) include(-p);
  if (q > 0.0) include(-q);
  if (spectrum.omega_max > 0.0) {
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
          if (std::abs(s) <= floor) continue;
          include({std::min(s.real(), 0.0), s.imag()});
        }
      }
    }
  }
  // Between the samples the limit moves by less than this (checked against exact spectra in the tests).
  step *= 0.998;
  // Both are safe.
  if (!spectrum.eigenvalues.empty())
    step = std::max(step, 0.998 * step_of_eigenvalues(spectrum.eigenvalues, integrator));
  // The double pole of a constraint: at the very edge it grows linearly, hence strictly inside.
  if (spectrum.baumgarte > 0.0)
    step = std::min(step, 0.998 * stable_step_of(-spectrum.baumgarte * (1.0 + 1e-6), integrator));
  return step;
}

}  // namespace rheo
