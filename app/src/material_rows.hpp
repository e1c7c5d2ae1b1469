// A material in words: its parts, and how they came from what the scene gives.
//
// Errors   none
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rheo/scene.hpp"

namespace app {

// Names of at most 13 letters and texts: for a report of one line each.
std::vector<std::pair<std::string, std::string>> material_rows(const rheo::Material& material,
                                                               const rheo::MaterialOrigin& origin);

}  // namespace app
