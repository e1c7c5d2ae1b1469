#include "rheo/material.hpp"

#include <fmt/format.h>

#include <cmath>

#include "rheo/error.hpp"

namespace rheo {

void Material::validate(const std::string& where) const {
  const auto check = [&](bool good, const char* name, double value, const char* allowed) {
    if (good) return;
    const std::string prefix = where.empty() ? where : where + " ";
    throw Error(Error::Kind::input, fmt::format("{}{} = {}: {}", prefix, name, value, allowed));
  };
  const auto modulus = [&](const char* name, double value) {
    check(value >= 0.0 && std::isfinite(value), name, value, "a finite number >= 0 (Pa) is needed");
  };
  const auto viscosity = [&](const char* name, double value) {
    check(value > 0.0, name, value, "a number > 0 (Pa s) is needed; inf: never relaxes");
  };
  modulus("lambda_ela", lambda_ela);
  modulus("mu_ela", mu_ela);
  viscosity("lambda_vis", lambda_vis);
  viscosity("mu_vis", mu_vis);
  check(density > 0.0 && std::isfinite(density), "density", density,
        "a finite number > 0 (kg/m^3) is needed");
  const auto rate_is_finite = [&](const char* name, double value, const char* vis_name, double vis) {
    check(std::isfinite(value), vis_name, vis,
          fmt::format("so far below {} that the relaxation rate is no finite number", name).c_str());
  };
  rate_is_finite("lambda_ela", lambda_rate(), "lambda_vis", lambda_vis);
  rate_is_finite("mu_ela", mu_rate(), "mu_vis", mu_vis);
}

}  // namespace rheo
