// Small scenes in which everything begins, changes and ends at times that no output or round step meets.
#pragma once

#include <vector>

#include "support/scenes.hpp"

namespace rheo::test {

// A short beam of large triangles (so that many steps are quick), with a pull that begins and ends at times
// no output or round step meets.
inline Scene off_grid_beam(Mass mass) {
  Scene scene = paper_beam(mass);
  scene.mesh = rectangle({2.0, 1.0}, 3, 2);
  scene.fixes[0].nodes = nodes_of(scene.mesh.edge_groups.at("left"));
  scene.tractions[0].edges = scene.mesh.edge_groups.at("right");
  scene.tractions[0].window = {0.1234567, 0.7654321};
  scene.time.duration = 1.0;
  return scene;
}

inline Scene with_material(Scene scene, double lambda_ela, double mu_ela, double lambda_vis, double mu_vis,
                           double density = 0.2) {
  scene.material = {lambda_ela, mu_ela, lambda_vis, mu_vis, density, scene.material.mass};
  return scene;
}

inline std::vector<int> right_nodes(const Scene& scene) {
  return nodes_of(scene.mesh.edge_groups.at("right"));
}

inline Scene ramped(Mass mass) {
  Scene scene = off_grid_beam(mass);
  scene.tractions[0].keys = {{0.2, {0, 0}}, {0.4567, {10, -3}}, {0.7, {-5, 2}}};
  return scene;
}

inline Scene moved(Mass mass, Profile profile) {
  Scene scene = off_grid_beam(mass);
  scene.tractions.clear();
  scene.moves.push_back(
      {right_nodes(scene),
       Axis::both,
       {0.05, 0.6180339},
       {{0.0, {0, 0}, {0, 0}}, {0.3217, {0.1, 0.02}, {0.3, -0.1}}, {0.55, {0.05, 0}, {0, 0}}},
       profile,
       "grip"});
  return scene;
}

inline Scene baumgarte(Scene scene) {
  scene.time.constraints = ConstraintMethod::baumgarte;
  return scene;
}

inline Scene tied(Mass mass) {  // the two right corners move alike in x: one general constraint
  Scene scene = off_grid_beam(mass);
  scene.constraints.push_back({{{5, Axis::x, 1.0}, {2, Axis::x, -1.0}}, 0.0, "tie"});
  return scene;
}

inline Scene pulled_together(
    Mass mass) {  // begins violated: Baumgarte's own dynamics is part of the solution
  Scene scene = tied(mass);
  scene.constraints[0].value = 0.02;
  return scene;
}

inline Scene roller(Mass mass) {  // different free sets in x and y, a roller that lets go
  Scene scene = off_grid_beam(mass);
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("bottom")), Axis::y, {0.0, 0.54321}, "bottom"});
  return scene;
}

inline Scene caught(Mass mass) {  // a fix that begins while its nodes move: an impulse
  Scene scene = off_grid_beam(mass);
  scene.fixes.push_back({right_nodes(scene), Axis::both, {0.4321, 0.8}, "catch"});
  return scene;
}

}  // namespace rheo::test
