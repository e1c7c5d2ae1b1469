// The stress of a running simulation against the hereditary integral over the strain that it went through:
// an independent path from displacements to stress.
//
//   sigma(t) = integral from 0 to t of (r_lambda(t - t') I_lambda + r_mu(t - t') I_mu) d(epsilon)/dt' dt'
//
// Source   Hirai and Tomokuni, eq. (1), (2)

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "rheo/deformation.hpp"
#include "rheo/shapes.hpp"
#include "rheo/simulation.hpp"
#include "support/whole_materials.hpp"

namespace rheo::test {
namespace {

// Strain and its rate of all triangles at equal distances of time.
struct History {
  double distance = 0.0;
  std::vector<std::vector<double>> strain, rate;
};

// Relaxation moduli at time t after a sudden strain; delta parts apart.
Moduli relaxed(const Material& m, double t) {
  Moduli r = m.elastic;
  for (std::size_t k = 0; k < m.branch_count(); ++k) {
    const MaxwellBranch b = m.branch(k);
    r.lambda += b.lambda_ela * std::exp(-b.lambda_rate() * t);
    r.mu += b.mu_ela * std::exp(-b.mu_rate() * t);
  }
  return r;
}

// By Gauss's rule of five points in each stretch, the strain between its ends the cubic with the recorded
// strains and rates (Hermite).
std::vector<double> stress_by_history(const Material& material, const History& history) {
  constexpr std::array<double, 5> node{-0.906179845938664, -0.538469310105683, 0.0, 0.538469310105683,
                                       0.906179845938664};
  constexpr std::array<double, 5> weight{0.236926885056189, 0.478628670499366, 0.568888888888889,
                                         0.478628670499366, 0.236926885056189};
  const std::size_t size = history.strain.front().size();
  const double d = history.distance, end = d * static_cast<double>(history.strain.size() - 1);
  std::vector<double> sigma(size, 0.0), rate(size);
  const auto add = [&](const Moduli& r, double factor, const std::vector<double>& e) {
    for (std::size_t i = 0; i < size; i += 3) {
      const double trace = r.lambda * (e[i] + e[i + 1]);
      sigma[i] += factor * (trace + 2 * r.mu * e[i]);
      sigma[i + 1] += factor * (trace + 2 * r.mu * e[i + 1]);
      sigma[i + 2] += factor * r.mu * e[i + 2];
    }
  };
  for (std::size_t k = 0; k + 1 < history.strain.size(); ++k) {
    for (std::size_t g = 0; g < node.size(); ++g) {
      const double s = 0.5 * (1 + node[g]);
      const double t = d * (static_cast<double>(k) + s);
      for (std::size_t i = 0; i < size; ++i) {
        const double jump = (history.strain[k + 1][i] - history.strain[k][i]) / d;
        rate[i] = 6 * s * (1 - s) * jump + (1 - s) * (1 - 3 * s) * history.rate[k][i] +
                  s * (3 * s - 2) * history.rate[k + 1][i];
      }
      add(relaxed(material, end - t), 0.5 * d * weight[g], rate);
    }
  }
  add(material.viscous, 1.0, history.rate.back());
  return sigma;
}

Mesh disk_with_sides() {
  Mesh mesh = disk(0.5, 2);
  for (const Edge& edge : std::vector<Edge>(mesh.edge_groups.at("rim"))) {
    const double x = 0.5 * (mesh.points[edge[0]].x + mesh.points[edge[1]].x);
    const double y = 0.5 * (mesh.points[edge[0]].y + mesh.points[edge[1]].y);
    if (std::abs(x) > 0.3) mesh.edge_groups[x < 0.0 ? "left" : "right"].push_back(edge);
    if (std::abs(x) < 0.2 && y > 0.0) mesh.edge_groups["top"].push_back(edge);
  }
  return mesh;
}

TEST(Hereditary, IntegralOverTheStrainGivesTheStress) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int k = 0; k < 8; ++k) {
    Scene scene;
    scene.mesh = k % 3 == 2 ? disk_with_sides() : rectangle({1.0, 0.6}, 4 + k % 3, 3, Diagonal::alternating);
    for (Vec2& p : scene.mesh.points) p.x += 0.04 * unit(random), p.y += 0.04 * unit(random);
    prepare(scene.mesh);
    scene.mesh.thickness = 0.3;
    scene.material = random_material(random, 0.2, 4.0, 10.0);
    if (k % 4 >= 2) {  // two materials, strewn
      scene.regions = {{"other", random_material(random, 0.3, 4.0, 10.0), {}, "other"}};
      for (int e = 0; e < scene.mesh.triangle_count(); ++e)
        scene.region_of_triangle.push_back(unit(random) > 0.0 ? 1 : 0);
    }
    scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, "left"});
    // Rising from nothing: no sudden load whose wave the records would have to resolve.
    scene.tractions.push_back(
        {scene.mesh.edge_groups.at("right"),
         {{0.0, {}}, {0.2, {unit(random), unit(random)}}, {0.5, {unit(random), unit(random)}}},
         {0.0, 0.5},
         "pull"});
    if (k % 2 == 1) {  // and gripped on the other side of it for a while
      const std::vector<int> gripped = nodes_of(scene.mesh.edge_groups.at("top"));
      scene.moves.push_back({{gripped[gripped.size() / 2]},
                             Axis::both,
                             {0.1, std::numeric_limits<double>::infinity()},
                             {{0.1, {}, {}}, {0.3, {0.05 * unit(random), 0.05 * unit(random)}, {}}},
                             Profile::smooth,
                             "grip"});
    }
    scene.time.duration = 0.6;
    scene.time.integrator = k % 2 == 0 ? IntegratorKind::exponential : IntegratorKind::rk4;
    scene.time.tolerance = 1e-11;
    // A thousandth of the fastest vibration's period, so that Hermite's error h^4 / 384 and that at jumps of
    // the acceleration (h^2) are small.
    const int records = 6000;
    scene.time.frame_rate = records / scene.time.duration;
    Simulation simulation(scene, {.energies = false});
    History history{scene.time.duration / records, {}, {}};
    double largest = 0.0;
    std::vector<double> e(3 * scene.mesh.triangles.size()), now(e.size());
    for (int i = 0; i <= records; ++i) {
      ASSERT_FALSE(simulation.advance(i == records ? scene.time.duration : i * history.distance));
      strain(scene.mesh, simulation.u(), e);
      history.strain.push_back(e);
      strain(scene.mesh, simulation.v(), e);
      history.rate.push_back(e);
      simulation.stress(now);
      for (const double s : now) largest = std::max(largest, std::abs(s));
      if (i % 2000 != 0 || i == 0) continue;
      std::vector<double> expected = stress_by_history(scene.material, history);
      if (!scene.regions.empty()) {
        const std::vector<double> other = stress_by_history(scene.regions[0].material, history);
        for (std::size_t j = 0; j < now.size(); ++j)
          if (scene.region_of_triangle[j / 3] == 1) expected[j] = other[j];
      }
      double worst = 0.0;
      for (std::size_t j = 0; j < now.size(); ++j) worst = std::max(worst, std::abs(now[j] - expected[j]));
      EXPECT_LT(worst, 1e-6 * largest) << "scene " << k << " at " << simulation.time() << " s";
    }
  }
}

}  // namespace
}  // namespace rheo::test
