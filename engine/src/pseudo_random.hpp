// Numbers that are the same on every machine, to start iterations from.
//
// Source   Steele, Lea and Flood, OOPSLA 2014 (splitmix64)
#pragma once

#include <cstdint>

namespace rheo {

// In [-1, 1).
inline double pseudo_random(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>(static_cast<std::int64_t>(z ^ (z >> 31))) * 0x1p-63;
}

// The sum of three: of variance 1.
inline double nearly_normal(std::uint64_t& state) {
  const double first = pseudo_random(state), second = pseudo_random(state);
  return first + second + pseudo_random(state);
}

}  // namespace rheo
