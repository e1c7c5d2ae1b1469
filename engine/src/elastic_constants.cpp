#include "rheo/elastic_constants.hpp"

namespace rheo {

Moduli moduli_of(const ElasticConstants& constants, Plane plane) {
  const auto [young, nu] = constants;
  const double mu = young / (2.0 * (1.0 + nu));
  if (nu == 0.0) return {0.0, mu};
  // Twice mu times a ratio that depends on nu alone.
  const double share = plane == Plane::strain ? nu / (1.0 - 2.0 * nu) : nu / (1.0 - nu);
  return {2.0 * mu * share, mu};
}

ElasticConstants elastic_constants_of(const Moduli& moduli, Plane plane) {
  const auto [lambda, mu] = moduli;
  const double nu = plane == Plane::strain ? lambda / (2.0 * (lambda + mu)) : lambda / (lambda + 2.0 * mu);
  return {2.0 * mu * (1.0 + nu), nu};
}

}  // namespace rheo
