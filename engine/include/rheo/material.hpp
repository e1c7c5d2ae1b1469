// Parameters of a linear isotropic rheological material: for lambda and mu each, any number of Maxwell
// branches (a spring in series with a dashpot), an elastic part and a viscous part, all in parallel.
//
//   sigma(t) = integral of (r_lambda(t - t') I_lambda + r_mu(t - t') I_mu) d(epsilon)/dt' dt'
//   r_lambda(t) = sum_k lambda_ela,k exp(-(lambda_ela,k / lambda_vis,k) t) + lambda_elastic
//               + lambda_viscous delta(t), r_mu likewise
//
// One branch alone is the paper's material: it stands in the first four numbers; further ones follow in
// `more_branches`.
//
// Source   Hirai and Tomokuni, eq. (1), (2); the parallel parts: Wang and Hirai's models, generalised
// Units    lambda_ela, mu_ela, elastic [Pa]; lambda_vis, mu_vis, viscous [Pa s]; density [kg/m^3]
// Errors   validate: Error::Kind::input, naming the parameter
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace rheo {

enum class Mass {
  lumped,     // a third of each triangle's mass to each corner
  consistent  // density h T / 12 * [2 1 1; 1 2 1; 1 1 2]
};

// A number each for lambda and mu.
struct Moduli {
  double lambda = 0.0;
  double mu = 0.0;
  friend bool operator==(const Moduli&, const Moduli&) = default;
};

// A spring and a dashpot in series, for lambda and mu each.
struct MaxwellBranch {
  double lambda_ela = 0.0;  // [Pa] >= 0; zero switches the branch off
  double mu_ela = 0.0;
  double lambda_vis = std::numeric_limits<double>::infinity();  // [Pa s] > 0; infinite: never relaxes
  double mu_vis = std::numeric_limits<double>::infinity();

  // Inverse relaxation times ela / vis [1/s]; 0 for a branch that is off or never relaxes.
  double lambda_rate() const { return rate(lambda_ela, lambda_vis); }
  double mu_rate() const { return rate(mu_ela, mu_vis); }
  friend bool operator==(const MaxwellBranch&, const MaxwellBranch&) = default;

 private:
  static double rate(double ela, double vis) { return ela > 0.0 ? ela / vis : 0.0; }
};

struct Material {
  double lambda_ela = 0.0;  // the first branch, as in MaxwellBranch
  double mu_ela = 0.0;
  double lambda_vis = std::numeric_limits<double>::infinity();
  double mu_vis = std::numeric_limits<double>::infinity();
  double density = 0.0;  // > 0
  Mass mass = Mass::lumped;
  std::vector<MaxwellBranch> more_branches{};
  Moduli elastic{};  // [Pa] >= 0
  Moduli viscous{};  // [Pa s] >= 0

  std::size_t branch_count() const { return 1 + more_branches.size(); }
  MaxwellBranch branch(std::size_t k) const {
    return k == 0 ? MaxwellBranch{lambda_ela, mu_ela, lambda_vis, mu_vis} : more_branches[k - 1];
  }

  // Whether the first branch is all there is: the paper's material.
  bool is_one_branch() const;
  // Response to a sudden strain: springs of all branches and the elastic part [Pa].
  Moduli instantaneous() const;

  // Of the first branch.
  double lambda_rate() const { return branch(0).lambda_rate(); }
  double mu_rate() const { return branch(0).mu_rate(); }

  void validate(const std::string& where = {}) const;
  friend bool operator==(const Material&, const Material&) = default;
};

// Whether two rates differ by rounding only.
bool same_rate(double a, double b);

// All springs that relax at one rate, for lambda and mu together; those that never relax have rate 0.
struct Relaxation {
  double rate = 0.0;  // [1/s]
  Moduli moduli;      // [Pa]
};
// By rising rate, each once (rates that differ by rounding are one); the elastic part included.
std::vector<Relaxation> relaxations_of(const Material& material);

}  // namespace rheo
