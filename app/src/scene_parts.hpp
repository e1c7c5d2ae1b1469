// The materials and bodies of a scene, one by one, for reports.
//
// Errors   none
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rheo/scene.hpp"

namespace app {

// Material `number` of the scene (Scene::region_of_triangle).
struct MaterialPart {
  int number = 0;
  std::string name;  // of its region or body; "material" where it has none
  const rheo::Material* material = nullptr;
  const rheo::MaterialOrigin* origin = nullptr;
  std::int64_t triangles = 0;
  double area = 0.0;    // [m^2]
  double volume = 0.0;  // [m^3]
};

// Views of `scene`.
std::vector<MaterialPart> materials_of(const rheo::Scene& scene);

// Numbers of the materials in a body, rising.
std::vector<int> materials_in(const rheo::Scene& scene, const rheo::BodyPart& body);

// k x 2, the edges between triangles of different materials, the lower number on the left.
std::vector<int> interfaces_of(const rheo::Scene& scene);

// A node in words: "node 7", with several bodies by its number there: "node 3 of block".
std::string node_text(const rheo::Scene& scene, int node);

}  // namespace app
