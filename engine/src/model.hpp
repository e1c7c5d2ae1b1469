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
#include <span>
#include <vector>

#include "kernels/edge_force.hpp"
#include "kernels/element_force.hpp"
#include "rheo/scene.hpp"

namespace rheo {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;
using VectorMap = Eigen::Map<Eigen::VectorXd>;

enum class Modulus { lambda, mu };

// A Maxwell branch of one modulus and the part w of the state that is its own: w' = ela v - rate w.
struct BranchPart {
  Modulus modulus = Modulus::lambda;
  std::size_t number = 0;  // Material::branch
  double ela = 0.0, vis = 0.0, rate = 0.0;
  std::size_t offset = 0;  // in the state
};

// The flat state y = (u, v, w_lambda of each branch, w_mu of each branch), each 2n numbers; a branch with a
// zero modulus has no part.
struct Layout {
  Layout() = default;
  Layout(const Mesh& mesh, const Material& material);

  std::size_t part = 0;              // 2n
  bool lambda = true;                // whether any force hangs on J_lambda
  bool mu = true;                    // likewise
  std::vector<BranchPart> branches;  // in the state's order

  std::size_t u() const { return 0; }
  std::size_t v() const { return part; }
  // Of the first branch of either that is on.
  std::size_t w_lambda() const { return 2 * part; }
  std::size_t w_mu() const { return first_mu; }
  std::size_t size() const { return (2 + branches.size()) * part; }

 private:
  std::size_t first_mu = 0;
};

// Whether J_lambda and J_mu are assembled, or left to the edge or the element form.
enum class Assembly { matrices, edges, elements };

struct Model {
  Model(const Mesh& mesh, const Material& material, Assembly assembly = Assembly::matrices);

  // out = M x for x of 2n numbers.
  void multiply_mass(const double* x, double* out) const;
  const SparseMatrix& j(Modulus modulus) const { return modulus == Modulus::lambda ? j_lambda : j_mu; }
  // (lambda J_lambda + mu J_mu) x
  Vector stiffness(double lambda, double mu, const Vector& x) const;

  Material material;
  Layout layout;
  SparseMatrix j_lambda;  // empty where no force hangs on it, and without Assembly::matrices
  SparseMatrix j_mu;
  std::unique_ptr<EdgeForce> edges;        // with Assembly::edges
  std::unique_ptr<ElementForce> elements;  // with Assembly::elements
  Vector node_mass;
  SparseMatrix mass;

  // Of a single triangle, an upper bound for the mesh: the largest natural frequency of all springs [rad/s];
  // the largest rate of the viscous part, an eigenvalue of M^-1 (viscous_lambda J_lambda + viscous_mu J_mu)
  // [1/s].
  double element_omega = 0.0;
  double element_viscous = 0.0;
};

// p of one modulus from a state, as far as it is asked for:
//   residual   sum over the branches of w + viscous v
//   pull       residual + elastic u: the force is J p
enum class PartSum { residual, pull };
// In `memory` (2n), or where one branch is all of it, that part of y itself; zeros where nothing is on.
ConstVectorMap sum_of_parts(const Model& model, Modulus modulus, PartSum sum, std::span<const double> y,
                            Vector& memory);

}  // namespace rheo
