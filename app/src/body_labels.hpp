// The names of a scene's bodies for its pictures; none where there is one body.
//
// Errors   none
#pragma once

#include <vector>

#include "render/mesh_picture.hpp"
#include "rheo/scene.hpp"

namespace app {

inline std::vector<render::BodyLabel> body_labels(const rheo::Scene& scene) {
  std::vector<render::BodyLabel> labels;
  for (const rheo::BodyPart& body : scene.bodies)
    labels.push_back({body.name, body.first_node, body.node_count});
  return labels;
}

}  // namespace app
