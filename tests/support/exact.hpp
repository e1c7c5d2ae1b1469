// The exact solution of a scene by matrix exponentials, independent of the engine's kernels, constraints and
// schedule.
//
// Everything is dense and written from the equations: B matrices by finite-element textbook, the KKT matrix
// of equation (4) as it stands, loads and prescribed motions as polynomials in an augmented state. For small
// meshes.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "rheo/scene.hpp"

namespace rheo::test {

struct ExactState {
  double t = 0.0;
  Eigen::VectorXd u, v, w_lambda, w_mu;  // 2n each; w: of all branches and the viscous part, the mean over
                                         // a node's materials by the areas of their triangles
};

// Dense J_lambda, J_mu, M (2n x 2n) of a mesh and material.
struct DenseMatrices {
  Eigen::MatrixXd j_lambda, j_mu, mass;
};
DenseMatrices dense_matrices(const Mesh& mesh, const Material& material);

// The full operator on (u, v, w_lambda, w_mu of each branch), (4 + 4 branches) n square, with
// A^T v' = -2 omega A^T v - omega^2 A^T u for the columns of `constraints` (2n x m).
Eigen::MatrixXd full_operator(const DenseMatrices& matrices, const Material& material,
                              const Eigen::MatrixXd& constraints, double omega);

// The materials of a scene: its own, then those of its regions.
std::vector<Material> materials_of(const Scene& scene);
// Of the triangles of each material alone, on all nodes.
std::vector<DenseMatrices> matrices_by_region(const Scene& scene);
// Several materials: on (u, v, and region by region w_lambda and w_mu of each branch).
Eigen::MatrixXd full_operator(const std::vector<DenseMatrices>& matrices,
                              const std::vector<Material>& materials, const Eigen::MatrixXd& constraints,
                              double omega);

class ExactSolution {
 public:
  explicit ExactSolution(const Scene& scene);

  // States at rising times.
  std::vector<ExactState> at(const std::vector<double>& times) const;

 private:
  Scene scene_;
  std::vector<Material> materials_;
  std::vector<DenseMatrices> matrices_;  // by material
  Eigen::MatrixXd mass_;
};

// design: the largest, over the times and over u, v, w_lambda, w_mu, of |difference| / (largest |block| over
// the run).
double run_error(const std::vector<ExactState>& exact, const std::vector<ExactState>& run);

// The engine's states at the same times.
std::vector<ExactState> simulate(const Scene& scene, const std::vector<double>& times);

}  // namespace rheo::test
