#include "scene_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

namespace app {
namespace {

std::size_t material_at(const rheo::Scene& scene, std::int64_t triangle) {
  return scene.region_of_triangle.empty()
             ? 0
             : static_cast<std::size_t>(scene.region_of_triangle[static_cast<std::size_t>(triangle)]);
}

}  // namespace

std::vector<MaterialPart> materials_of(const rheo::Scene& scene) {
  std::vector<MaterialPart> parts;
  parts.push_back(
      {0, scene.material_name.empty() ? "material" : scene.material_name, &scene.material, &scene.origin});
  for (const rheo::Region& region : scene.regions)
    parts.push_back({static_cast<int>(parts.size()), region.name, &region.material, &region.origin});
  for (int t = 0; t < scene.mesh.triangle_count(); ++t) {
    MaterialPart& part = parts[material_at(scene, t)];
    ++part.triangles;
    const double area = rheo::signed_area(scene.mesh, t);
    part.area += area;
    part.volume += area * scene.mesh.thickness_of(scene.mesh.triangles[static_cast<std::size_t>(t)]);
  }
  return parts;
}

std::vector<int> materials_in(const rheo::Scene& scene, const rheo::BodyPart& body) {
  std::set<int> numbers;
  for (std::int64_t t = body.first_triangle; t < body.first_triangle + body.triangle_count; ++t)
    numbers.insert(static_cast<int>(material_at(scene, t)));
  return {numbers.begin(), numbers.end()};
}

std::vector<int> interfaces_of(const rheo::Scene& scene) {
  if (scene.region_of_triangle.empty()) return {};
  struct Side {
    rheo::Edge sorted, directed;
    std::size_t material;
  };
  std::vector<Side> sides;
  sides.reserve(3 * scene.mesh.triangles.size());
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int i = scene.mesh.triangles[t][k], j = scene.mesh.triangles[t][(k + 1) % 3];
      sides.push_back({{std::min(i, j), std::max(i, j)}, {i, j}, material_at(scene, static_cast<int>(t))});
    }
  std::ranges::sort(sides, [](const Side& a, const Side& b) {
    return std::tie(a.sorted, a.material) < std::tie(b.sorted, b.material);
  });
  std::vector<int> edges;
  for (std::size_t s = 0; s + 1 < sides.size(); ++s)
    if (sides[s].sorted == sides[s + 1].sorted && sides[s].material != sides[s + 1].material)
      edges.insert(edges.end(), sides[s].directed.begin(), sides[s].directed.end());
  return edges;
}

std::string node_text(const rheo::Scene& scene, int node) {
  for (const rheo::BodyPart& body : scene.bodies)
    if (node >= body.first_node && node < body.first_node + body.node_count)
      return fmt::format("node {} of {}", node - body.first_node, body.name);
  return fmt::format("node {}", node);
}

}  // namespace app
