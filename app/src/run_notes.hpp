// What the user should know about a run before it starts: the reader's notes, a mesh in pieces, holds and
// loads that never act, and times at which nothing is written.
//
// Units    s
#pragma once

#include <string>
#include <vector>

#include "rheo/scene.hpp"

namespace app {

std::vector<std::string> run_notes(const rheo::Scene& scene);

}  // namespace app
