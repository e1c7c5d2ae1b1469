#include "rheo/material.hpp"

#include <fmt/format.h>

#include <cmath>

#include "rheo/error.hpp"
#include "rheo/limits.hpp"

namespace rheo {

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
  modulus("lambda_ela", lambda_ela);
  modulus("mu_ela", mu_ela);
  viscosity("lambda_vis", lambda_vis);
  viscosity("mu_vis", mu_vis);
  check(density > 0.0 && std::isfinite(density), "density", density,
        "a finite number > 0 (kg/m^3) is needed");
  usable("density", density, " (kg/m^3)");
}

}  // namespace rheo
