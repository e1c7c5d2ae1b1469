// Random bodies for stable steps: irregular, of any material.
#pragma once

#include <cmath>
#include <random>

#include "support/scenes.hpp"
#include "support/whole_materials.hpp"

namespace rheo::test {

// Irregular, every third one free; of one or of two materials, these in turns or in halves.
inline Scene random_body(std::mt19937& random, int k, int nx, int ny) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Scene scene;
  scene.mesh = rectangle({1.0, 0.3 + unit(random)}, nx, ny, Diagonal::alternating);
  for (Vec2& p : scene.mesh.points) {
    p.x += 0.1 * unit(random) / (nx - 1);
    p.y += 0.05 * unit(random) / (ny - 1);
  }
  prepare(scene.mesh);
  if (k % 3 != 0)
    scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, "left"});
  const double frequency = 4.0 * (nx - 1);  // about that of the fastest vibrations
  scene.material = random_material(random, 0.2, frequency, 30.0);
  if (k % 4 < 2) {
    const double contrast = std::pow(10.0, 2.0 * unit(random) - 1.0);
    scene.regions = {{"other", random_material(random, 0.3, frequency * contrast, 30.0), {}, "other"}};
    const int count = scene.mesh.triangle_count();
    for (int e = 0; e < count; ++e) scene.region_of_triangle.push_back(k % 8 < 4 ? e % 2 : e < count / 2);
  }
  scene.time.duration = 1e-11;
  scene.time.step = 1e-12;
  return scene;
}

inline void set_mass(Scene& scene, Mass mass) {
  scene.material.mass = mass;
  for (Region& region : scene.regions) region.material.mass = mass;
}

// Rates of lambda and mu up to `apart` from one another, beside vibrations of 50 to 300, of one material or
// of two that are up to three times as stiff as one another.
inline void set_rates_apart(Scene& scene, std::mt19937& random, int k, double apart, int materials) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto decades = [&](double low, double high) { return low * std::pow(high / low, unit(random)); };
  scene.regions.clear();
  scene.region_of_triangle.clear();
  const double slowest = 150.0 * decades(1e-3, 1.0);
  const auto material = [&](double mu) {
    Material m;
    m.density = 0.2;
    m.mu_ela = mu;
    m.lambda_ela = mu * decades(0.3, 10.0);
    m.mu_vis = m.mu_ela / (slowest * decades(1.0, apart));
    m.lambda_vis = m.lambda_ela / (slowest * decades(1.0, apart));
    if (k % 3 == 0) m.elastic = {0.5 * m.lambda_ela, 0.5 * m.mu_ela};
    return m;
  };
  scene.material = material(30.0);
  if (materials == 1) return;
  scene.regions = {{"other", material(30.0 * decades(0.3, 3.0)), {}, "other"}};
  const int triangles = scene.mesh.triangle_count();
  for (int e = 0; e < triangles; ++e)
    scene.region_of_triangle.push_back(k % 2 == 0 ? e % 2 : e < triangles / 2);
}

}  // namespace rheo::test
