// The jittered meshes that the benchmarks of a step share, with a state and what acts on it.
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "body.hpp"
#include "rheo/shapes.hpp"

namespace bench {

// A square of about `triangles` triangles, its inner nodes moved at random, fixed at the left and pulled at
// the right.
inline rheo::Scene jittered_square(int triangles) {
  rheo::Scene scene;
  const int n = std::max(2, static_cast<int>(std::lround(std::sqrt(triangles / 2.0))) + 1);
  scene.mesh = rheo::rectangle({1, 1}, n, n, rheo::Diagonal::alternating);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-0.25 / n, 0.25 / n);
  for (int row = 1; row + 1 < n; ++row) {
    for (int column = 1; column + 1 < n; ++column) {
      scene.mesh.points[row * n + column].x += unit(random);
      scene.mesh.points[row * n + column].y += unit(random);
    }
  }
  rheo::prepare(scene.mesh);
  scene.material = {7, 5, 4, 2, 0.2, rheo::Mass::lumped};
  scene.fixes.push_back({rheo::nodes_of(scene.mesh.edge_groups.at("left")), rheo::Axis::both, {}, ""});
  scene.tractions.push_back({scene.mesh.edge_groups.at("right"), {{0, {1, 0}}}, {}, ""});
  scene.time.duration = 1.0;
  return scene;
}

// With a state and what acts on it. The step is far below the stable limit: many steps from a random state
// stay of one size.
struct Case {
  explicit Case(int triangles) : scene(jittered_square(triangles)) {
    model = std::make_unique<rheo::Model>(scene.mesh, scene.material);
    solver = std::make_shared<rheo::ConstraintSolver>(*model, held(), std::vector<rheo::Column>{});
    interval.force.setZero(static_cast<Eigen::Index>(model->layout.part));
    const std::vector<int> pulled = rheo::nodes_of(scene.mesh.edge_groups.at("right"));
    for (int node : pulled) interval.force[2 * node] = 1.0 / static_cast<double>(pulled.size());
    interval.eliminated = interval.held = held();
    interval.course.resize(1);
    interval.solver = solver;
    base.setZero(static_cast<Eigen::Index>(model->layout.part));
    step = 1e-3 / model->element_omega;
    y.resize(model->layout.size());
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-1, 1);
    for (double& x : y) x = any(random);
    for (const rheo::HeldDof& h : held()) y[model->layout.v() + h.dof] = 0.0;
  }

  std::vector<rheo::HeldDof> held() const {
    std::vector<rheo::HeldDof> dofs;
    for (int node : scene.fixes[0].nodes) {
      dofs.push_back({2 * node, 0});
      dofs.push_back({2 * node + 1, 0});
    }
    return dofs;
  }

  rheo::Scene scene;
  std::unique_ptr<rheo::Model> model;
  std::shared_ptr<const rheo::ConstraintSolver> solver;
  rheo::Interval interval;
  rheo::Vector base;
  std::vector<double> y;
  double step = 0.0;
};

inline const Case& case_of(int triangles) {
  static std::map<int, std::unique_ptr<Case>> cases;
  auto& one = cases[triangles];
  if (!one) one = std::make_unique<Case>(triangles);
  return *one;
}

}  // namespace bench
