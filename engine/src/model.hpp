// What never changes in a run: connection matrices, mass, and where the state's parts lie.
//
//   J_lambda = sum h T B^T I_lambda B,  J_mu = sum h T B^T I_mu B        (6 x 6 a triangle, assembled)
//   with (b_i, c_i) = (y_j - y_k, x_k - x_j) the 2 x 2 blocks are
//   J_lambda,ij = h / (4 T) [b_i b_j, b_i c_j; c_i b_j, c_i c_j]
//   J_mu,ij     = h / (4 T) [2 b_i b_j + c_i c_j, c_i b_j; b_i c_j, 2 c_i c_j + b_i b_j]
//
// Source   Hirai and Tomokuni, eq. (2), (3); B: the constant strain triangle with engineering shear
// Units    J [m] (thickness included), so that J w is in N for w in Pa m; mass [kg]
// Shapes   J: 2n x 2n; node_mass: n; mass: n x n, the same for x and y (empty when lumped)
#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <memory>

#include "kernels/edge_force.hpp"
#include "kernels/element_force.hpp"
#include "rheo/scene.hpp"

namespace rheo {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;
using VectorMap = Eigen::Map<Eigen::VectorXd>;

// The flat state y = (u, v, w_lambda, w_mu), each 2n numbers; a branch with a zero modulus has no part.
struct Layout {
  std::size_t part = 0;  // 2n
  bool lambda = true;
  bool mu = true;

  std::size_t u() const { return 0; }
  std::size_t v() const { return part; }
  std::size_t w_lambda() const { return 2 * part; }
  std::size_t w_mu() const { return (lambda ? 3 : 2) * part; }
  std::size_t size() const { return (2 + (lambda ? 1 : 0) + (mu ? 1 : 0)) * part; }
};

// Whether J_lambda and J_mu are assembled, or left to the edge or the element form.
enum class Assembly { matrices, edges, elements };

struct Model {
  Model(const Mesh& mesh, const Material& material, Assembly assembly = Assembly::matrices);

  // out = M x for x of 2n numbers.
  void multiply_mass(const double* x, double* out) const;
  // (lambda J_lambda + mu J_mu) x
  Vector stiffness(double lambda, double mu, const Vector& x) const;

  Material material;
  Layout layout;
  SparseMatrix j_lambda;  // empty where lambda_ela = 0, and without Assembly::matrices
  SparseMatrix j_mu;
  std::unique_ptr<EdgeForce> edges;        // with Assembly::edges
  std::unique_ptr<ElementForce> elements;  // with Assembly::elements
  Vector node_mass;
  SparseMatrix mass;

  // Largest natural frequency of a single triangle: an upper bound for the mesh [rad/s].
  double element_omega = 0.0;
};

}  // namespace rheo
