// A scene as the text of a scene file: all numbers and names resolved, 17 significant digits, so that reading
// it gives the same scene and running it the same bits.
//
// Errors   none
// Not here the comments, presets and data that the scene was made from; which of the nodes are which body's:
// several
//          bodies are written as one mesh in pieces, with their materials as regions by triangles' numbers
#pragma once

#include <string>

#include "rheo/scene.hpp"

namespace rheo {

std::string scene_text(const Scene& scene);

}  // namespace rheo
