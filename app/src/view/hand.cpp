#include "view/hand.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace app::view {
namespace {

// Of the triangle that has the edge.
const rheo::Material& material_at(const rheo::Scene& scene, const rheo::Edge& edge) {
  if (scene.region_of_triangle.empty()) return scene.material;
  const auto& triangles = scene.mesh.triangles;
  const auto found = std::ranges::find_if(triangles, [&](const auto& triangle) {
    return std::ranges::count(triangle, edge[0]) > 0 && std::ranges::count(triangle, edge[1]) > 0;
  });
  if (found == triangles.end()) return scene.material;
  const auto number = scene.region_of_triangle[static_cast<std::size_t>(found - triangles.begin())];
  return rheo::material_of(scene, static_cast<std::size_t>(number));
}

}  // namespace

rheo::Vec2 place_of(const Grip& grip, std::span<const double> positions) {
  const auto i = 2 * static_cast<std::size_t>(grip.edge[0]), j = 2 * static_cast<std::size_t>(grip.edge[1]);
  if (std::max(i, j) + 1 >= positions.size()) return {};
  return {positions[i] + grip.along * (positions[j] - positions[i]),
          positions[i + 1] + grip.along * (positions[j + 1] - positions[i + 1])};
}

Reach reach_at(const Display& display, const std::vector<int>& pieces, const render::PlaneInPicture& plane,
               std::array<double, 2> cursor, double radius, std::size_t most) {
  struct Found {
    double middle, distance;  // of it from the cursor
    Grip grip;
  };
  std::vector<Found> found;
  for (const rheo::Edge& edge : display.scene->mesh.edge_groups.at("boundary")) {
    const auto at = [&](int node) {
      const auto i = 2 * static_cast<std::size_t>(node);
      return plane.pixel(display.positions[i], display.positions[i + 1]);
    };
    const auto [ax, ay] = at(edge[0]);
    const auto [bx, by] = at(edge[1]);
    const double dx = bx - ax, dy = by - ay, px = cursor[0] - ax, py = cursor[1] - ay;
    const double s = std::clamp((px * dx + py * dy) / std::max(dx * dx + dy * dy, 1e-12), 0.0, 1.0);
    const double distance = std::hypot(px - s * dx, py - s * dy);
    if (distance <= radius) found.push_back({std::hypot(px - dx / 2, py - dy / 2), distance, {edge, s}});
  }
  if (found.empty()) return {};
  const auto piece_of = [&](const Found& f) { return pieces[static_cast<std::size_t>(f.grip.edge[0])]; };
  const Found nearest = *std::ranges::min_element(found, {}, &Found::distance);
  std::erase_if(found, [&](const Found& f) { return f.middle > radius || piece_of(f) != piece_of(nearest); });
  if (found.empty()) found.push_back(nearest);
  std::ranges::sort(found, {}, &Found::middle);
  found.resize(std::min(most, found.size()), nearest);
  Reach reach;
  for (const Found& f : found) reach.edges.push_back(f.grip.edge);
  reach.nearest = std::ranges::min_element(found, {}, &Found::distance)->grip;
  return reach;
}

double default_push(const rheo::Scene& scene, const std::vector<int>& pieces, const rheo::Edge& edge) {
  rheo::Vec2 low{rheo::forever, rheo::forever}, high{-rheo::forever, -rheo::forever};
  for (std::size_t i = 0; i < scene.mesh.points.size(); ++i) {
    if (pieces[i] != pieces[static_cast<std::size_t>(edge[0])]) continue;
    const rheo::Vec2 p = scene.mesh.points[i];
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const rheo::Moduli moduli = material_at(scene, edge).instantaneous();
  const double stiffness = moduli.lambda + 2.0 * moduli.mu;
  const double size = std::hypot(high.x - low.x, high.y - low.y);
  return 0.5 * (stiffness > 0.0 ? stiffness : 1.0) / size;
}

}  // namespace app::view
