// A scene as the text of a scene file: all numbers and names resolved, 17 significant digits, so that reading
// it gives the same scene and running it the same bits.
//
// Errors   Error::Kind::input for what the file has no words for: several regions
// Not here the comments, presets and data that the scene was made from
#pragma once

#include <string>

#include "rheo/scene.hpp"

namespace rheo {

std::string scene_text(const Scene& scene);

}  // namespace rheo
