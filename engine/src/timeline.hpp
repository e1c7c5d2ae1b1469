// When a scene changes: starts, ends and keys of loads and constraints, and its outputs.
//
// Between two neighbouring times every load and prescribed motion is one polynomial and the set of
// constraints stays: steps end on these times, so that none straddles a jump.
#pragma once

#include <cstdint>
#include <vector>

#include "rheo/scene.hpp"

namespace rheo {

// Rising times, the first 0; times that differ by rounding only are one.
std::vector<double> event_times(const Scene& scene);

// Whether two times are the same but for rounding.
bool same_time(double a, double b);

// Equal steps that divide a stretch of time: `refinement` times those of at most `bound`.
std::int64_t steps_in(double length, double refinement, double bound);

inline bool is_active(const Window& window, double t) {
  return window.from <= t && t < window.until;
}

}  // namespace rheo
