// Small scenes that several tests share.
#pragma once

#include "rheo/scene.hpp"
#include "rheo/shapes.hpp"

namespace rheo::test {

// The paper's beam (Figure 2): 1 m x 0.25 m, 5 x 2 nodes, left edge fixed, P = [10, 0] Pa on the right for 1
// s.
inline Scene paper_beam(Mass mass) {
  Scene scene;
  scene.title = "paper's beam";
  scene.mesh = rectangle({1.0, 0.25}, 5, 2);
  scene.material = {7.0, 5.0, 4.0, 2.0, 0.2, mass};
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, "left"});
  scene.tractions.push_back({scene.mesh.edge_groups.at("right"), {{0.0, {10.0, 0.0}}}, {0.0, 1.0}, "right"});
  scene.time.duration = 5.0;
  return scene;
}

}  // namespace rheo::test
