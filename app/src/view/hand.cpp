#include "view/hand.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace app::view {

std::vector<rheo::Edge> edges_at(const Display& display, const render::PlaneInPicture& plane,
                                 std::array<double, 2> cursor, double radius, std::size_t most) {
  struct Found {
    double distance;
    rheo::Edge edge;
  };
  std::vector<Found> within;
  std::optional<Found> nearest;
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
    const double middle = std::hypot(px - dx / 2, py - dy / 2);
    if (middle <= radius) within.push_back({middle, edge});
    if (distance <= radius && (!nearest || distance < nearest->distance)) nearest = Found{distance, edge};
  }
  std::vector<rheo::Edge> edges;
  if (within.empty()) {
    if (nearest) edges.push_back(nearest->edge);
    return edges;
  }
  std::sort(within.begin(), within.end(),
            [](const Found& a, const Found& b) { return a.distance < b.distance; });
  for (std::size_t i = 0; i < std::min(most, within.size()); ++i) edges.push_back(within[i].edge);
  return edges;
}

rheo::Vec2 middle_of(const std::vector<rheo::Edge>& edges, std::span<const double> positions) {
  rheo::Vec2 sum;
  for (const rheo::Edge& edge : edges) {
    for (const int node : edge) {
      sum.x += positions[2 * static_cast<std::size_t>(node)];
      sum.y += positions[2 * static_cast<std::size_t>(node) + 1];
    }
  }
  const double count = std::max<double>(1.0, 2.0 * static_cast<double>(edges.size()));
  return {sum.x / count, sum.y / count};
}

double default_push(const rheo::Scene& scene) {
  rheo::Vec2 low{rheo::forever, rheo::forever}, high{-rheo::forever, -rheo::forever};
  for (const rheo::Vec2& p : scene.mesh.points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const rheo::Moduli moduli = scene.material.instantaneous();
  const double stiffness = moduli.lambda + 2.0 * moduli.mu;
  const double size = std::hypot(high.x - low.x, high.y - low.y);
  return 0.5 * (stiffness > 0.0 ? stiffness : 1.0) / size;
}

}  // namespace app::view
