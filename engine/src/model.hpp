// What never changes in a run: connection matrices of each region, mass, and where the state's parts lie.
//
//   J_lambda = sum h T B^T I_lambda B,  J_mu = sum h T B^T I_mu B        (6 x 6 a triangle, assembled)
//   with (b_i, c_i) = (y_j - y_k, x_k - x_j) the 2 x 2 blocks are
//   J_lambda,ij = h / (4 T) [b_i b_j, b_i c_j; c_i b_j, c_i c_j]
//   J_mu,ij     = h / (4 T) [2 b_i b_j + c_i c_j, c_i b_j; b_i c_j, 2 c_i c_j + b_i b_j]
//
// Source   Hirai and Tomokuni, eq. (2), (3); B: the constant strain triangle with engineering shear
// Units    J [m] (thickness included), so that J w is in N for w in Pa m; mass [kg]
// Shapes   J of a region: 2k x 2k for the k nodes that its triangles touch; node_mass: n; mass: n x n, the
// same for x and y (empty when lumped)
#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kernels/edge_force.hpp"
#include "kernels/element_force.hpp"
#include "regions.hpp"
#include "rheo/scene.hpp"

namespace rheo {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;
using VectorMap = Eigen::Map<Eigen::VectorXd>;

enum class Modulus { lambda, mu };

// One region's share of the mesh: its material and matrices, on the nodes that its triangles touch. The only
// region has all nodes, by the mesh's own numbers; nothing is listed then.
struct Patch {
  Material material;
  std::vector<std::int32_t> nodes;      // of the mesh, rising
  std::vector<std::int32_t> triangles;  // likewise
  std::vector<double> area_share;       // by node: of the area of its triangles, the region's
  std::size_t part = 0;                 // 2 x its nodes
  bool lambda = true;                   // whether any force hangs on J_lambda
  bool mu = true;                       // likewise
  SparseMatrix j_lambda;                // empty where no force hangs on it, and without Assembly::matrices
  SparseMatrix j_mu;

  const SparseMatrix& j(Modulus modulus) const { return modulus == Modulus::lambda ? j_lambda : j_mu; }
  bool has(Modulus modulus) const { return modulus == Modulus::lambda ? lambda : mu; }
  // Of one of its nodes; of any node where nothing is listed.
  std::int32_t number_of(std::int32_t mesh_node) const;

  // visit(i, j): entry i of the patch's vectors (2k) is at entry j of the mesh's (2n).
  template <class Visit>
  void for_each_dof(const Visit& visit) const {
    if (nodes.empty()) {
      for (std::size_t i = 0; i < part; ++i) visit(i, i);
      return;
    }
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const std::size_t j = 2 * static_cast<std::size_t>(nodes[k]);
      visit(2 * k, j);
      visit(2 * k + 1, j + 1);
    }
  }
};

// A Maxwell branch of one modulus and region, and the part w of the state that is its own:
// w' = ela v - rate w.
struct BranchPart {
  Modulus modulus = Modulus::lambda;
  std::size_t number = 0;  // Material::branch
  double ela = 0.0, vis = 0.0, rate = 0.0;
  std::size_t offset = 0;  // in the state
  std::size_t region = 0;
  std::size_t size = 0;  // the region's Patch::part
};

// The flat state y = (u, v, w_lambda of each branch and region, w_mu of each), u and v 2n numbers, w as many
// as the region has degrees of freedom; a branch with a zero modulus has no part.
struct Layout {
  Layout() = default;
  Layout(std::size_t nodes, std::span<const Patch> patches);

  std::size_t part = 0;              // 2n
  bool lambda = true;                // whether any force hangs on J_lambda
  bool mu = true;                    // likewise
  std::vector<BranchPart> branches;  // in the state's order

  std::size_t u() const { return 0; }
  std::size_t v() const { return part; }
  // Of the first branch of either that is on.
  std::size_t w_lambda() const { return 2 * part; }
  std::size_t w_mu() const { return first_mu; }
  std::size_t size() const { return end; }

 private:
  std::size_t first_mu = 0, end = 0;
};

// Whether J_lambda and J_mu are assembled, or left to the edge or the element form.
enum class Assembly { matrices, edges, elements };

struct Model {
  Model(const Mesh& mesh, const Regions& regions, Assembly assembly = Assembly::matrices);
  // Of one material.
  Model(const Mesh& mesh, const Material& material, Assembly assembly = Assembly::matrices)
      : Model(mesh, Regions{{material}, {}}, assembly) {}

  // out = M x for x of 2n numbers.
  void multiply_mass(const double* x, double* out) const;
  // sum over the regions of (lambda J_lambda + mu J_mu) x; moduli by region
  Vector stiffness(const std::vector<Moduli>& moduli, const Vector& x) const;
  void stiffness(const std::vector<Moduli>& moduli, const Vector& x, Vector& result) const;

  bool is_lumped() const { return mass.size() == 0; }
  bool has_several_materials() const { return patches.size() > 1; }
  // Of the only region.
  const Material& material() const;
  const SparseMatrix& j(Modulus modulus) const;
  // The largest number that a branch has, plus one.
  std::size_t branch_count() const;
  // Whether some region has such a part, or something else than its first branch.
  bool has_elastic_part() const;
  bool has_viscous_part() const;
  bool is_parallel() const;

  std::vector<Patch> patches;  // by region
  Layout layout;
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

// p of one modulus and region from a state, as far as it is asked for:
//   residual   sum over the branches of w + viscous v
//   pull       residual + elastic u: the force is J p
enum class PartSum { residual, pull };
// In `memory` (Patch::part), or where one branch is all of it, that part of y itself; zeros where nothing is
// on.
ConstVectorMap sum_of_parts(const Model& model, std::size_t region, Modulus modulus, PartSum sum,
                            std::span<const double> y, Vector& memory);

}  // namespace rheo
