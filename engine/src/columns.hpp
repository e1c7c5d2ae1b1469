// Which constraints are columns of equation (4) instead of being eliminated.
#pragma once

#include "rheo/scene.hpp"

namespace rheo {

// Whether some constraint of the scene is not eliminated but solved for: [[constraint]], and by Baumgarte's
// method for all whatever holds.
bool has_columns(const Scene& scene);

}  // namespace rheo
