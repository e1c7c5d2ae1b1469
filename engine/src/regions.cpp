#include "regions.hpp"

#include <algorithm>

namespace rheo {

Regions regions_of(const Scene& scene) {
  constexpr std::int32_t unknown = -1;
  Regions result;
  std::vector<std::int32_t> number(1 + scene.regions.size(), unknown);  // by material of the scene
  const auto number_of = [&](std::size_t k) {
    if (number[k] != unknown) return number[k];
    const Material& material = material_of(scene, k);
    const auto known = std::find(result.materials.begin(), result.materials.end(), material);
    number[k] = static_cast<std::int32_t>(known - result.materials.begin());
    if (known == result.materials.end()) result.materials.push_back(material);
    return number[k];
  };
  if (scene.region_of_triangle.empty()) number_of(0);
  result.of_triangle.reserve(scene.region_of_triangle.size());
  for (const std::int32_t region : scene.region_of_triangle)
    result.of_triangle.push_back(number_of(static_cast<std::size_t>(region)));
  if (!result.several()) result.of_triangle.clear();
  return result;
}

std::vector<SharedRelaxation> relaxations_of(const std::vector<Material>& materials) {
  struct Springs {
    Relaxation relaxation;
    std::size_t region;
  };
  std::vector<Springs> all;
  for (std::size_t r = 0; r < materials.size(); ++r)
    for (const Relaxation& each : relaxations_of(materials[r])) all.push_back({each, r});
  std::stable_sort(all.begin(), all.end(),
                   [](const Springs& a, const Springs& b) { return a.relaxation.rate < b.relaxation.rate; });
  std::vector<SharedRelaxation> distinct;
  for (const auto& [each, region] : all) {
    if (distinct.empty() || !same_rate(distinct.back().rate, each.rate))
      distinct.push_back({each.rate, std::vector<Moduli>(materials.size())});
    Moduli& moduli = distinct.back().moduli[region];
    moduli.lambda += each.moduli.lambda;
    moduli.mu += each.moduli.mu;
  }
  return distinct;
}

}  // namespace rheo
