// Random bodies, and what a kernel makes of them, for comparing kernels.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "body.hpp"
#include "rheo/shapes.hpp"

namespace rheo::test {

// An irregular mesh with a hole and, where two cut-out cells touch, a node at which the boundary meets
// itself.
inline Mesh random_mesh(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const int nx = 7 + static_cast<int>(2 * (1 + unit(random)));
  const int ny = 6 + static_cast<int>(2 * (1 + unit(random)));
  const double size = std::pow(10.0, 3 * unit(random));
  Mesh mesh = rectangle({size, 0.7 * size}, nx, ny, Diagonal::alternating);
  for (Vec2& p : mesh.points) {
    p.x += 0.25 * size / nx * unit(random);
    p.y += 0.25 * 0.7 * size / ny * unit(random);
  }
  std::vector<Triangle> kept;
  for (const Triangle& t : mesh.triangles) {
    const auto cell = [&](int column, int row) {
      int inside = 0;
      for (int node : t) {
        const int c = node % nx, r = node / nx;
        inside += c >= column && c <= column + 1 && r >= row && r <= row + 1;
      }
      return inside == 3;
    };
    if (!cell(2, 2) && !cell(3, 3)) kept.push_back(t);
  }
  mesh.triangles = kept;
  mesh.edge_groups.clear();
  mesh.thickness = std::pow(10.0, unit(random));
  prepare(mesh);
  return mesh;
}

// A round mesh around a hub that many triangles share.
inline Mesh random_wheel(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const int spokes = 13 + static_cast<int>(8 * (1 + unit(random)));
  const double size = std::pow(10.0, 3 * unit(random));
  Mesh mesh;
  mesh.points.push_back({0.0, 0.0});
  for (int ring = 1; ring <= 2; ++ring) {
    for (int k = 0; k < spokes; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.3 * unit(random)) / spokes;
      const double radius = size * (ring + 0.2 * unit(random));
      mesh.points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
  }
  for (int k = 0; k < spokes; ++k) {
    const int next = (k + 1) % spokes;
    mesh.triangles.push_back({0, 1 + k, 1 + next});
    mesh.triangles.push_back({1 + k, 1 + spokes + k, 1 + spokes + next});
    mesh.triangles.push_back({1 + k, 1 + spokes + next, 1 + next});
  }
  mesh.thickness = std::pow(10.0, unit(random));
  prepare(mesh);
  return mesh;
}

// One kind, or a third each of random_mesh, random_wheel and a disk.
enum class Shapes { rectangles, all };

inline Scene random_scene(unsigned seed, Shapes shapes = Shapes::rectangles) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto decades = [&](double n) { return std::pow(10.0, n * unit(random)); };
  Scene scene;
  if (shapes == Shapes::all && seed % 3 == 1) {
    scene.mesh = random_wheel(random);
  } else if (shapes == Shapes::all && seed % 3 == 2) {
    scene.mesh = disk(std::pow(10.0, 3 * unit(random)), 5);
  } else {
    scene.mesh = random_mesh(random);
  }
  Material& m = scene.material;
  m = {decades(4), decades(4), decades(4), decades(4), decades(3), Mass::lumped};
  if (seed % 5 == 1) m.lambda_ela = 0.0;
  if (seed % 5 == 2) m.mu_ela = 0.0;
  if (seed % 5 == 3) m.lambda_vis = forever;
  scene.body_acceleration = {unit(random), unit(random)};
  scene.fixes.push_back({{0, 1, 2}, Axis::both, {}, ""});
  scene.fixes.push_back({{4}, Axis::y, {}, ""});
  scene.moves.push_back(
      {{6, 7}, Axis::x, {}, {{0, {0, 0}, {}}, {2, {unit(random), 0}, {}}}, Profile::smooth, ""});
  scene.tractions.push_back(
      {scene.mesh.edge_groups.at("boundary"), {{0, {unit(random), 1}}, {3, {0, unit(random)}}}, {}, ""});
  scene.time.duration = 1.0;
  return scene;
}

// One sweep and one energy sample of a body at a state and time.
struct Outcome {
  std::vector<double> swept;
  EnergySample sample;
  Vector reaction;
};

inline Outcome outcome(Body& body, const Interval& interval, const Vector& base, const std::vector<double>& y,
                       double t) {
  body.enter(interval, base);
  body.load(y);
  body.impose_prescribed(t);
  Outcome result;
  result.sample = body.sample(t);
  body.reaction(t, result.reaction);
  std::vector<double> out(body.size());
  const std::vector<double> zero(body.size(), 0.0);
  body.fma(1.0, body.state(), zero, {t, {1.0, 0.3, 0.02, 0.001}}, out, Result::step);
  std::copy(out.begin(), out.end(), body.state().begin());
  result.swept.resize(y.size());
  body.store(result.swept);
  return result;
}

// Largest difference of a part over the part's largest entry.
inline double difference(const std::vector<double>& a, const std::vector<double>& b, std::size_t begin,
                         std::size_t count) {
  double worst = 0.0, largest = 0.0;
  for (std::size_t i = begin; i < begin + count; ++i) {
    worst = std::max(worst, std::abs(a[i] - b[i]));
    largest = std::max(largest, std::abs(a[i]));
  }
  return largest > 0.0 ? worst / largest : worst;
}

// A state of random numbers.
inline std::vector<double> random_state(const Model& model, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<double> y(model.layout.size());
  for (double& x : y) x = unit(random);
  return y;
}

// Everything that both say of a state, to 1e-12 of the largest number of its kind: some hundred roundings of
// 1e-16, and what is lost in differences of numbers of one size on the irregular triangles of these meshes.
inline void expect_alike(const Outcome& a, const Outcome& b, const Scene& scene, std::size_t part,
                         const std::string& which) {
  for (std::size_t begin = 0; begin < a.swept.size(); begin += part)
    EXPECT_LT(difference(a.swept, b.swept, begin, part), 1e-12) << which << " part " << begin;
  const auto near = [&](double x, double z, double scale, const char* what) {
    EXPECT_NEAR(x, z, 1e-12 * std::abs(scale)) << which << ": " << what;
  };
  const EnergySample& e = a.sample;
  near(e.kinetic, b.sample.kinetic, e.kinetic, "kinetic");
  near(e.stored, b.sample.stored, e.stored, "stored");
  near(e.dissipated, b.sample.dissipated, e.dissipated, "dissipated");
  // Sums over nodes of both signs.
  const double nodes = scene.mesh.node_count();
  near(e.load, b.sample.load, nodes * e.load, "load");
  near(e.load_power, b.sample.load_power, nodes * e.load_power, "power of the loads");
  near(e.load_slope, b.sample.load_slope, nodes * e.load_slope, "slope of the loads");
  const double r = a.reaction.lpNorm<Eigen::Infinity>();
  EXPECT_LT((a.reaction - b.reaction).lpNorm<Eigen::Infinity>(), 1e-12 * r) << which;
  near(e.constraints, b.sample.constraints, r, "constraints");
  near(e.dissipated_rate, b.sample.dissipated_rate, 100 * (std::abs(e.dissipated_rate) + e.dissipated),
       "slope of what is dissipated");
}

}  // namespace rheo::test
