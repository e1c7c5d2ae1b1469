#include "rheo/material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rheo/error.hpp"
#include "rheo/limits.hpp"

namespace rheo {

bool Material::is_one_branch() const {
  const auto is_off = [](const MaxwellBranch& b) { return b.lambda_ela == 0.0 && b.mu_ela == 0.0; };
  return std::all_of(more_branches.begin(), more_branches.end(), is_off) && elastic.lambda == 0.0 &&
         elastic.mu == 0.0 && viscous.lambda == 0.0 && viscous.mu == 0.0;
}

Moduli Material::instantaneous() const {
  Moduli sum = elastic;
  for (std::size_t k = 0; k < branch_count(); ++k) {
    sum.lambda += branch(k).lambda_ela;
    sum.mu += branch(k).mu_ela;
  }
  return sum;
}

bool same_rate(double a, double b) {
  return std::abs(a - b) <= 2.0 * std::numeric_limits<double>::epsilon() * std::max(a, b);
}

std::vector<Relaxation> relaxations_of(const Material& material) {
  std::vector<Relaxation> all;
  const auto add = [&](double rate, Moduli moduli) {
    if (moduli.lambda > 0.0 || moduli.mu > 0.0) all.push_back({rate, moduli});
  };
  add(0.0, material.elastic);
  for (std::size_t k = 0; k < material.branch_count(); ++k) {
    const MaxwellBranch b = material.branch(k);
    add(b.lambda_rate(), {b.lambda_ela, 0.0});
    add(b.mu_rate(), {0.0, b.mu_ela});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Relaxation& a, const Relaxation& b) { return a.rate < b.rate; });
  std::vector<Relaxation> distinct;
  for (const Relaxation& each : all) {
    if (distinct.empty() || !same_rate(distinct.back().rate, each.rate)) {
      distinct.push_back(each);
      continue;
    }
    distinct.back().moduli.lambda += each.moduli.lambda;
    distinct.back().moduli.mu += each.moduli.mu;
  }
  return distinct;
}

void Material::validate(const std::string& where) const {
  const auto check = [&](bool good, const char* name, double value, const char* allowed) {
    if (good) return;
    const std::string prefix = where.empty() ? where : where + " ";
    throw Error(Error::Kind::input, fmt::format("{}{} = {}: {}", prefix, name, value, allowed));
  };
  const auto usable = [&](const char* name, double value, const char* beside) {
    check(of_usable_size(value), name, value,
          fmt::format("{:g} to {:g} is allowed{}", smallest_size, largest_size, beside).c_str());
  };
  const auto modulus = [&](const char* name, double value) {
    check(value >= 0.0 && std::isfinite(value), name, value, "a finite number >= 0 (Pa) is needed");
    if (value != 0.0) usable(name, value, " (Pa), and 0");
  };
  const auto viscosity = [&](const char* name, double value) {
    check(value > 0.0, name, value, "a number > 0 (Pa s) is needed; inf: never relaxes");
    if (std::isfinite(value)) usable(name, value, " (Pa s), and inf");
  };
  for (std::size_t k = 0; k < branch_count(); ++k) {
    const MaxwellBranch b = branch(k);
    const std::string number = k == 0 ? "" : fmt::format("maxwell {}: ", k + 1);
    modulus((number + "lambda_ela").c_str(), b.lambda_ela);
    modulus((number + "mu_ela").c_str(), b.mu_ela);
    viscosity((number + "lambda_vis").c_str(), b.lambda_vis);
    viscosity((number + "mu_vis").c_str(), b.mu_vis);
  }
  modulus("elastic.lambda", elastic.lambda);
  modulus("elastic.mu", elastic.mu);
  const auto dashpot = [&](const char* name, double value) {
    check(value >= 0.0 && std::isfinite(value), name, value, "a finite number >= 0 (Pa s) is needed");
    if (value != 0.0) usable(name, value, " (Pa s), and 0");
  };
  dashpot("viscous.lambda", viscous.lambda);
  dashpot("viscous.mu", viscous.mu);
  check(density > 0.0 && std::isfinite(density), "density", density,
        "a finite number > 0 (kg/m^3) is needed");
  usable("density", density, " (kg/m^3)");
}

}  // namespace rheo
