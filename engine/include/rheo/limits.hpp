// How large and how small the numbers of a scene may be.
//
// Any SI quantity that means something lies far inside; within these bounds the products that the engine
// forms (a modulus times a traction's square, a rate times a squared frequency) stay numbers of a double.
//
// Units    those of the quantity, SI
#pragma once

#include <cmath>

namespace rheo {

inline constexpr double smallest_size = 1e-30;
inline constexpr double largest_size = 1e30;

// Against slips of the pen that would fill a disk or never end.
inline constexpr double max_outputs =
    1e7;  // duration * frame_rate, unless the reader of a scene is told else
inline constexpr double bytes_an_output = 300.0;  // of memory, for the names of its files in lists

// For quantities of either sign and for times: 0 and tiny remainders of rounding are welcome.
inline bool within_size(double value) {
  return std::abs(value) <= largest_size;
}

// For positive quantities that others are divided by: density, thickness, moduli that are not 0.
inline bool of_usable_size(double value) {
  return value >= smallest_size && value <= largest_size;
}

}  // namespace rheo
