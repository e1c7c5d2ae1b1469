// The few parameters of a scene that the panels change: a copy, applied between steps.
//
// Units    SI
// Errors   none: values are checked where the scene is taken
#pragma once

#include <vector>

#include "rheo/scene.hpp"

namespace app::view {

struct Draft {
  rheo::Material material;
  std::vector<rheo::Material> regions;  // of the others in the mesh
  rheo::Vec2 acceleration;
  rheo::TimeSettings time;
  std::vector<rheo::Vec2> tractions;  // of those with one value; others stay

  explicit Draft(const rheo::Scene& scene);
  rheo::Scene on(const rheo::Scene& scene) const;
};

}  // namespace app::view
