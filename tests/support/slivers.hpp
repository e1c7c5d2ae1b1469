// A beam with slivers, which make every explicit step tiny and that no load needs resolved.
#pragma once

#include <cmath>
#include <numbers>
#include <utility>

#include "support/event_scenes.hpp"

namespace rheo::test {

// The scene of an off_grid_beam (or ramped) with a row of triangles so flat that their small angles are
// `degrees`, between two of ordinary ones.
inline Scene with_slivers(Scene scene, double degrees) {
  const double flat = std::tan(degrees * std::numbers::pi / 180);
  Mesh mesh;
  for (const double y : {0.0, 0.5, 0.5 + flat, 1.0}) {
    for (int column = 0; column < 3; ++column) mesh.points.push_back({1.0 * column, y});
  }
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 2; ++column) {
      const int a = 3 * row + column;
      mesh.triangles.push_back({a, a + 1, a + 3});
      mesh.triangles.push_back({a + 4, a + 3, a + 1});
    }
    mesh.edge_groups["left"].push_back({3 * row, 3 * row + 3});
    mesh.edge_groups["right"].push_back({3 * row + 2, 3 * row + 5});
  }
  prepare(mesh);
  scene.mesh = mesh;
  scene.fixes[0].nodes = nodes_of(mesh.edge_groups.at("left"));
  scene.tractions[0].edges = mesh.edge_groups.at("right");
  return scene;
}

}  // namespace rheo::test
