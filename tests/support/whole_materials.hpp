// Materials of several branches, an elastic and a viscous part: the models that have names, and random ones.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "rheo/material.hpp"

namespace rheo::test {

// What one modulus is made of.
struct Response {
  std::vector<std::pair<double, double>> branches;  // ela [Pa], rate [1/s]
  double elastic = 0.0;                             // [Pa]
  double viscous = 0.0;                             // [Pa s]

  // With all rates times `faster`, all stresses times `factor`.
  Response scaled(double factor, double faster = 1.0) const {
    Response result{{}, factor * elastic, factor * viscous};
    for (const auto& [ela, rate] : branches) result.branches.emplace_back(factor * ela, faster * rate);
    return result;
  }
  // In parallel; branches of one rate become one.
  Response beside(const Response& other) const {
    Response result = *this;
    result.elastic += other.elastic;
    result.viscous += other.viscous;
    for (const auto& [ela, rate] : other.branches) {
      bool known = false;
      for (auto& [sum, its_rate] : result.branches) {
        if (!same_rate(its_rate, rate)) continue;
        sum += ela;
        known = true;
      }
      if (!known) result.branches.emplace_back(ela, rate);
    }
    return result;
  }
};

inline Material material_of(const Response& lambda, const Response& mu, double density = 1.0) {
  Material m;
  m.density = density;
  m.elastic = {lambda.elastic, mu.elastic};
  m.viscous = {lambda.viscous, mu.viscous};
  const std::size_t count = std::max(lambda.branches.size(), mu.branches.size());
  for (std::size_t k = 0; k < count; ++k) {
    MaxwellBranch b;
    if (k < lambda.branches.size()) {
      b.lambda_ela = lambda.branches[k].first;
      b.lambda_vis = b.lambda_ela / lambda.branches[k].second;
    }
    if (k < mu.branches.size()) {
      b.mu_ela = mu.branches[k].first;
      b.mu_vis = b.mu_ela / mu.branches[k].second;
    }
    if (k > 0) {
      m.more_branches.push_back(b);
      continue;
    }
    m.lambda_ela = b.lambda_ela, m.mu_ela = b.mu_ela, m.lambda_vis = b.lambda_vis, m.mu_vis = b.mu_vis;
  }
  return m;
}

// Burgers' model, Maxwell (e1, n1) and Kelvin-Voigt (e2, n2) in series, as two Maxwell branches in parallel:
//   p1 = n1/e1 + n1/e2 + n2/e2, p2 = n1 n2/(e1 e2), rates r = (p1 +- a) / (2 p2), a = sqrt(p1^2 - 4 p2)
//   relaxation [(n1 - n1 n2/e2 r1) exp(-r1 t) - (n1 - n1 n2/e2 r2) exp(-r2 t)] / a,  r1 < r2
// (Findley, Lai and Onaran, Creep and Relaxation of Nonlinear Viscoelastic Materials, 1976, table 5.1)
struct Burgers {
  double e1 = 5.0, n1 = 6.0, e2 = 3.0, n2 = 1.5;

  Response parallel() const {
    const double p1 = n1 / e1 + n1 / e2 + n2 / e2, p2 = n1 * n2 / (e1 * e2), q2 = n1 * n2 / e2;
    const double a = std::sqrt(p1 * p1 - 4 * p2);
    const double r1 = (p1 - a) / (2 * p2), r2 = (p1 + a) / (2 * p2);
    return {{{(n1 - q2 * r1) / a, r1}, {(q2 * r2 - n1) / a, r2}}};
  }
};

struct Preset {
  std::string name;
  Response mu;
};

inline std::vector<Preset> presets() {
  return {{"elastic", {{}, 5.0}},
          {"kelvin_voigt", {{}, 5.0, 0.6}},
          {"maxwell", {{{5.0, 2.5}}}},
          {"zener", {{{4.0, 3.0}}, 2.0}},
          {"burgers", Burgers{}.parallel()},
          {"five_element", {{{4.0, 5.0}, {2.0, 0.4}}, 0.0, 0.3}},
          {"plastic", {{}, 0.0, 2.0}},
          {"whole", {{{4.0, 5.0}, {2.0, 0.4}, {3.0, 40.0}}, 1.0, 0.1}}};
}

// Up to three branches, some of one modulus only, with or without the other parts; rates over four decades
// about `frequency`.
inline Material random_material(std::mt19937& random, double density, double modulus, double frequency) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto decades = [&](double lo, double hi) { return lo * std::pow(hi / lo, unit(random)); };
  const auto response = [&](int most) {
    Response r;
    const int count = static_cast<int>(unit(random) * (most + 1));
    for (int k = 0; k < count; ++k) {
      const double rate =
          frequency * decades(1e-2, 1e2);  // drawn by itself: compilers order arguments differently
      r.branches.emplace_back(modulus * decades(0.1, 3.0), rate);
    }
    if (unit(random) < 0.6) r.elastic = modulus * decades(0.1, 3.0);
    if (unit(random) < 0.6) r.viscous = modulus / frequency * decades(1e-3, 1.0);
    return r;
  };
  Response mu = response(3);
  if (mu.branches.empty() && mu.elastic == 0.0) mu.elastic = modulus;
  return material_of(response(3), mu, density);
}

}  // namespace rheo::test
