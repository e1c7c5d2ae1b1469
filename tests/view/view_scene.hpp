// A soft block on a table for the tests of the window.
#pragma once

#include "rheo/scene.hpp"
#include "rheo/shapes.hpp"

namespace view_tests {

// 0.1 m x 0.05 m, held at the bottom; relaxes within a fifth of a second.
inline rheo::Scene block() {
  rheo::Scene scene;
  scene.title = "Block";
  scene.mesh = rheo::rectangle({0.1, 0.05}, 9, 5, rheo::Diagonal::alternating);
  scene.mesh.thickness = 0.05;
  scene.material = {.lambda_ela = 4000, .mu_ela = 1500, .lambda_vis = 800, .mu_vis = 300, .density = 1000};
  scene.fixes.emplace_back().nodes = rheo::nodes_of(scene.mesh.edge_groups.at("bottom"));
  scene.time.duration = 5.0;
  return scene;
}

}  // namespace view_tests
