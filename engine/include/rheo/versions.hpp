// The libraries that the numbers of this build hang on.
//
// Errors   none
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rheo {

// Name and version, as the engine was built with them.
std::vector<std::pair<std::string, std::string>> library_versions();

}  // namespace rheo
