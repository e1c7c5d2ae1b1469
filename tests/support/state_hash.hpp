// FNV-1a, 64 bits, of all that a simulation's state consists of: u, v, w of each branch, and of each material
// where there are several, bit by bit. -0 and 0 count as two.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

#include "rheo/simulation.hpp"

namespace rheo::test {

class StateHash {
 public:
  void add(std::span<const double> x) {
    for (const double value : x) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      for (int byte = 0; byte < 8; ++byte) value_ = (value_ ^ (bits >> 8 * byte & 0xffu)) * 0x100000001b3u;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

inline std::uint64_t state_hash(const Simulation& simulation) {
  const SavedState state = simulation.save();
  StateHash hash;
  hash.add(state.u);
  hash.add(state.v);
  if (!state.parts.empty()) {
    for (const SavedState::Part& part : state.parts) hash.add(part.w);
    return hash.value();
  }
  for (const auto& w : state.w_lambda) hash.add(w);
  for (const auto& w : state.w_mu) hash.add(w);
  return hash.value();
}

}  // namespace rheo::test
