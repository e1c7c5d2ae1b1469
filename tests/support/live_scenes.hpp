// A block of tissue under hands, and what they do in it tick by tick.
#pragma once

#include <cmath>

#include "rheo/live.hpp"
#include "rheo/shapes.hpp"

namespace rheo::test {

constexpr int push_handle = 0, grab_handle = 1, brush_handle = 2;

// 0.1 m x 0.05 m, soft, fixed at the bottom and for a while on the left, its own weight and a pulse of
// pressure on top.
inline Scene live_block(Mass mass, int nx = 11, int ny = 7) {
  Scene scene;
  scene.mesh = rectangle({0.1, 0.05}, nx, ny, Diagonal::alternating);
  scene.mesh.thickness = 0.05;
  scene.material = {400.0, 150.0, 400.0, 60.0, 1000.0, mass};
  scene.body_acceleration = {0.0, -0.1};
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("bottom")), Axis::both, {}, "floor"});
  // Let go between two ticks.
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::x, {0.0, 0.0615}, "clamp"});
  Traction pulse;
  pulse.edges = scene.mesh.edge_groups.at("top");
  pulse.keys = {{0.0, {0.0, 0.0}}, {0.023, {0.0, -4.0}}, {0.05, {0.0, 0.0}}};
  pulse.window = {0.0, 0.1};
  scene.tractions.push_back(pulse);
  scene.time.duration = 10.0;
  scene.time.step = 1e-3;
  return scene;
}

inline LiveSettings live_settings(const Scene& scene) {
  LiveSettings settings;
  settings.rate = 250.0;
  const Mesh& mesh = scene.mesh;
  settings.handles.resize(3);
  settings.handles[push_handle] = {"tool", {}, mesh.edge_groups.at("top")};
  settings.handles[grab_handle] = {"fingers", {}, mesh.edge_groups.at("right")};
  settings.handles[brush_handle] = {"brush", {}, {}, Axis::both, 20};
  settings.record = 5000;
  return settings;
}

// Pushes twice, grabs and drags a body that moves, and works with a picked brush at the same time.
inline void act(Live& live, int k) {
  if (k == 3) live.push(push_handle, {5.0, -20.0});
  if (k == 20) live.push(push_handle, {});
  if (k == 15) live.grab(grab_handle);
  if (k > 15 && k < 35) live.drag(grab_handle, {1e-4 * (k - 15), -2e-4 * std::sin(0.3 * (k - 15))});
  if (k == 40) live.release(grab_handle);
  if (k == 40) live.grab(grab_handle);  // let go and taken again at once
  if (k == 41) live.drag(grab_handle, {1e-3, 0.0}, {0.02, 0.0});
  if (k == 45) live.release(grab_handle);
  if (k == 22) {
    const Mesh& mesh = live.simulation().scene().mesh;
    const int n = mesh.node_count();
    const std::array<int, 2> nodes{n - 1, n - 2};
    live.pick(brush_handle, nodes, std::span(mesh.edge_groups.at("left")).first(2));
    live.push(brush_handle, {10.0, 0.0});
  }
  if (k == 25) live.grab(brush_handle);
  if (k == 28) live.drag(brush_handle, {5e-4, 5e-4});
  if (k == 30) live.push(brush_handle, {0.0, 3.0});
  if (k == 33) live.release(brush_handle);
  if (k == 34) live.push(brush_handle, {});
  if (k == 60) live.push(push_handle, {0.0, -10.0});
  if (k == 90) live.push(push_handle, {});
}

}  // namespace rheo::test
