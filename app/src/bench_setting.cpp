#include "bench_setting.hpp"

#include <fmt/format.h>

#include "option_values.hpp"

namespace app {

std::string short_number(double x) {
  std::string text = fmt::format("{:g}", x);
  if (const std::size_t at = text.find("e-0"); at != std::string::npos) text.erase(at + 2, 1);
  return text;
}

std::string knob_of(const Setting& setting) {
  if (setting.tolerance > 0.0) return "--tolerance " + short_number(setting.tolerance);
  return setting.step > 0.0 ? "--step " + short_number(setting.step) : "--step auto";
}

std::string options_of(const Setting& setting) {
  return fmt::format("--integrator {} {}", name_of(setting.integrator), knob_of(setting));
}

}  // namespace app
