// What the user should know about a run before it starts: the reader's notes, and times at which nothing is
// written.
//
// Units    s
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "rheo/simulation.hpp"

namespace app {

inline std::vector<std::string> run_notes(const rheo::Scene& scene) {
  std::vector<std::string> notes = scene.notes;
  const rheo::TimeSettings& time = scene.time;
  const double last = rheo::output_time(time, rheo::output_count(time) - 1);
  // A product and a quotient of the two settings round by some 1e-16.
  if (time.duration - last > 1e-9 * time.duration)
    notes.push_back(fmt::format("outputs end at t = {:.6g} s, state.csv is at the duration {:.6g} s", last,
                                time.duration));
  return notes;
}

}  // namespace app
