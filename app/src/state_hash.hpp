// A state's bits in one word of text: equal for equal runs (README, Reliability), of u, v, w_lambda and w_mu.
//
// Errors   none
#pragma once

#include <fmt/format.h>

#include <string>

#include "rheo/fingerprint.hpp"
#include "rheo/simulation.hpp"

namespace app {

inline std::string state_hash(const rheo::Simulation& simulation) {
  rheo::Fingerprint fingerprint;
  for (const auto part : {simulation.u(), simulation.v(), simulation.w_lambda(), simulation.w_mu()})
    for (const double x : part) fingerprint.add(x);
  return fmt::format("{:016x}", fingerprint.value());
}

}  // namespace app
