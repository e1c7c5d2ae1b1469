// A block of gel with a mesh that becomes ten thousand times finer towards the corner where it is pulled: its
// smallest triangles, and those a thousand times as long as wide along its sides, make every explicit step
// tiny.
#pragma once

#include <algorithm>
#include <vector>

#include "rheo/scene.hpp"
#include "rheo/shapes.hpp"

namespace rheo::test {

// From 0 to `length`: pieces of at most `coarse`, shrinking by `ratio` from one to the next down to `fine` at
// the end.
inline std::vector<double> graded_points(double length, double coarse, double fine, double ratio) {
  std::vector<double> from_end{0.0};
  for (double piece = fine; from_end.back() + piece < length; piece = std::min(coarse, piece * ratio))
    from_end.push_back(from_end.back() + piece);
  // The last point stands for the side itself.
  from_end.back() = length;
  std::vector<double> points;
  for (auto it = from_end.rbegin(); it != from_end.rend(); ++it) points.push_back(length - *it);
  return points;
}

// 0.1 m x 0.04 m, held at the left, pulled at the right and let go, within 0.3 s; pieces from 5 mm down to
// `fine`.
inline Scene graded_block(double fine) {
  const double width = 0.1, height = 0.04;
  const std::vector<double> xs = graded_points(width, 5e-3, fine, 1.6);
  const std::vector<double> ys = graded_points(height, 5e-3, fine, 1.6);
  Scene scene;
  scene.mesh = rectangle({width, height}, static_cast<int>(xs.size()), static_cast<int>(ys.size()),
                         Diagonal::alternating);
  for (std::size_t row = 0; row < ys.size(); ++row) {
    for (std::size_t column = 0; column < xs.size(); ++column)
      scene.mesh.points[row * xs.size() + column] = {xs[column], ys[row]};
  }
  prepare(scene.mesh);
  scene.material = {4000.0, 1500.0, 4000.0, 750.0, 1000.0, Mass::lumped};
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, "left"});
  scene.tractions.push_back({scene.mesh.edge_groups.at("right"),
                             {{0.0, {0, 0}}, {0.1, {100.0, 30.0}}, {0.2, {100.0, 30.0}}, {0.3, {0, 0}}},
                             {},
                             "right"});
  scene.time.duration = 0.5;
  return scene;
}

}  // namespace rheo::test
