// Parameters of an isotropic Maxwell material: one spring-dashpot branch for lambda, one for mu.
//
//   sigma(t) = integral of (r_lambda(t - t') I_lambda + r_mu(t - t') I_mu) d(epsilon)/dt' dt'
//   r_lambda(t) = lambda_ela exp(-(lambda_ela / lambda_vis) t), r_mu likewise
//
// Source   Hirai and Tomokuni, eq. (1), (2)
// Units    lambda_ela, mu_ela [Pa]; lambda_vis, mu_vis [Pa s]; density [kg/m^3]
// Errors   validate: Error::Kind::input, naming the parameter
#pragma once

#include <limits>
#include <string>

namespace rheo {

enum class Mass {
  lumped,     // a third of each triangle's mass to each corner
  consistent  // density h T / 12 * [2 1 1; 1 2 1; 1 1 2]
};

struct Material {
  double lambda_ela = 0.0;  // >= 0; zero switches the branch off
  double mu_ela = 0.0;
  double lambda_vis = std::numeric_limits<double>::infinity();  // > 0; infinite: never relaxes
  double mu_vis = std::numeric_limits<double>::infinity();
  double density = 0.0;  // > 0
  Mass mass = Mass::lumped;

  // Inverse relaxation times ela / vis [1/s]; 0 for a branch that is off or never relaxes.
  double lambda_rate() const { return rate(lambda_ela, lambda_vis); }
  double mu_rate() const { return rate(mu_ela, mu_vis); }

  void validate(const std::string& where = {}) const;

 private:
  static double rate(double ela, double vis) { return ela > 0.0 ? ela / vis : 0.0; }
};

}  // namespace rheo
