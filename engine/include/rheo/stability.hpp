// The largest stable step of the explicit integrators.
//
// Every eigenvalue s of the full operator satisfies, with Rayleigh quotients A, B >= 0 of its own
// eigenvector,
//
//   s + A / (s + r_lambda) + B / (s + r_mu) = 0
//   A + B <= omega_max^2,   A <= (A + B) lambda_ela / (lambda_ela + mu_ela)
//
// With branches k (the elastic part is one of rate 0) and a viscous part in parallel, a and b the quotients
// of M^-1 J_lambda and M^-1 J_mu,
//
//   s + sum over k of (a lambda_k + b mu_k) / (s + r_k) + a viscous_lambda + b viscous_mu = 0,   0 <= a <= b
//   a sum lambda_k + b sum mu_k <= omega_max^2,   a viscous_lambda + b viscous_mu <= viscous_max
//
// so the step that keeps all such s inside the integrator's stability region is stable for the scene;
// relaxation rates and Baumgarte's double pole -omega belong to the spectrum too.
//
// Several materials in one mesh: each rate k has a quotient c_k >= 0 of its own, and the viscous part d,
//
//   s + sum over k of c_k / (s + r_k) + d = 0,   sum c_k <= omega_max^2,   d <= viscous_max
//
// On bodies too large for all their eigenvalues the numerical range of the whole operator says more
// (src/numerical_range.hpp), and Euler's limit is told by those that it hangs on
// (src/nearby_eigenvalues.hpp).
//
// Source   design: Lanczos in the inner product of M for omega_max^2 = largest eigenvalue of
//          M^-1 (lambda_ela J_lambda + mu_ela J_mu) (of all springs, viscous_max likewise) on what the
//          constraints leave free, bounded from above (src/lanczos.hpp), capped by the largest element
//          eigenvalue (Irons and Treharne, 1971)
// Units    rates and omega [1/s], steps [s]
#pragma once

#include <complex>
#include <vector>

#include "rheo/scene.hpp"

namespace rheo {

struct Spectrum {
  double omega_max = 0.0;      // upper bound of the largest natural frequency used below [rad/s]
  double element_bound = 0.0;  // the bound by single elements [rad/s]
  double lambda_share = 0.0;   // lambda_ela / (lambda_ela + mu_ela): lambda's largest share in a mode
  double lambda_rate = 0.0;    // the largest of its branches
  double mu_rate = 0.0;
  bool lambda_on = false;
  bool mu_on = false;
  double baumgarte = 0.0;  // omega; 0 where no constraint needs it
  int lanczos_steps = 0;
  // More than one: any share of the springs may be that of any rate in a mode; the moduli below are then the
  // largest of the materials.
  bool several_materials = false;
  // Then what each of them has in every mode: springs by their rate, and the viscous part.
  struct Part {
    std::vector<Relaxation> relaxations;
    Moduli viscous;
  };
  std::vector<Part> materials;
  // Beyond one branch, else empty and 0: all springs by their rate, and the viscous part with an upper bound
  // of the largest eigenvalue of M^-1 (viscous_lambda J_lambda + viscous_mu J_mu) [1/s].
  std::vector<Relaxation> relaxations;
  Moduli viscous;
  double viscous_max = 0.0;
  // Of the full operator, under every set of constraints, where the scene is small: for Euler, whose limit
  // hangs on the damping of single modes, where not everything relaxes at one rate. Else empty, and the limit
  // a safe bound.
  std::vector<std::complex<double>> eigenvalues;
  // By the numerical range of such a scene that is too large for them, under every set of constraints: a
  // stable step of its integrator [s]; 0 where it was not looked for, or is not beyond what the rest says.
  double rk4_step = 0.0, euler_step = 0.0;
  // Euler's by the eigenvalues that it hangs on, likewise [s]: at least 95 % of the limit. 0 where it was not
  // looked for, or takes too long.
  double near_euler_step = 0.0;

  // No eigenvalue's real part is below -largest_rate(): of the branches and the viscous part [1/s].
  double largest_rate() const;
  // Of the branch that remembers longest; 0 where something never forgets, infinite where nothing remembers.
  double slowest_rate() const;
};

// Largest h with |R(h s)| <= 1 for every s that `spectrum` allows; 0 where no step is stable (Euler without
// damping in some mode), infinite where every step is (exponential, implicit: always).
double stable_step(const Spectrum& spectrum, IntegratorKind integrator);

// Whether that is only a safe bound, the true limit possibly larger: Euler where the eigenvalues that it
// hangs on take too long to find, and RK4 with a viscous part or several materials, on scenes too large for
// all.
bool stable_step_is_bound(const Spectrum& spectrum, IntegratorKind integrator);

// The same for one eigenvalue s (Re s <= 0), used above and by the tests on exact spectra.
double stable_step_of(std::complex<double> s, IntegratorKind integrator);

}  // namespace rheo
