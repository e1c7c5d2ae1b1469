// S = L D L^T of a sparse symmetric positive definite matrix of 2 x 2 blocks, a block a pair of nodes:
// Eigen's SimplicialLDLT over single degrees of freedom.
//
//   FactorOrder   an order of the nodes that keeps L sparse (approximate minimum degree); once a mesh
//   SparseFactor  the elimination tree and memory of L when made; L for every new set of values; x = S^-1 x
//
// Ordering nodes keeps the two degrees of freedom of a node together in L: less fill and less time than an
// order of single ones. Eigen's own solve() allocates for its permutation, so the permutation is done here.
//
// Source   Amestoy, Davis and Duff, 1996 (the order); Davis, Direct Methods for Sparse Linear Systems (2006),
//          ch. 4 (up-looking factor); both as Eigen has them
// Shapes   blocks: row-major 2 x 2, in the order of the pattern's entries; x: 2 numbers a node, in the mesh's
//          order
// Errors   factor: false where a pivot is not positive beyond rounding
#pragma once

#include <Eigen/SparseCholesky>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace rheo {

using Block = std::array<double, 4>;  // a00, a01, a10, a11

// Which blocks are there: compressed rows, symmetric, the diagonal included.
struct BlockPattern {
  std::vector<int> start;   // nodes + 1
  std::vector<int> column;  // of each block, rising in a row

  int nodes() const { return static_cast<int>(start.size()) - 1; }
};

// All that depends neither on values nor on Eigen's factor; shared by the factors of one pattern.
class FactorOrder {
 public:
  explicit FactorOrder(BlockPattern pattern);

  const BlockPattern& pattern() const { return pattern_; }

 private:
  friend class SparseFactor;

  // The upper triangle of S in the order of elimination, its values those of `blocks`.
  Eigen::SparseMatrix<double> ordered(std::span<const Block> blocks) const;

  BlockPattern pattern_;
  std::vector<int> order_;        // node at each place
  std::vector<int> above_start_;  // nodes + 1, into above_
  std::vector<int> above_;        // of each place the blocks above and on the diagonal, by rising place
  Eigen::SparseMatrix<double> pattern_above_;  // the upper triangle, zeros
};

class SparseFactor {
 public:
  explicit SparseFactor(std::shared_ptr<const FactorOrder> order);

  const BlockPattern& pattern() const { return order_->pattern(); }
  // Memory of L, D and what goes with them [bytes].
  std::size_t bytes() const;

  bool factor(std::span<const Block> values);
  // x = S^-1 x
  void solve(std::span<double> x) const;

 private:
  using Natural =
      Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Upper, Eigen::NaturalOrdering<int>>;
  struct Cholesky : Natural {
    // Eigen gives L after a factor only, where it has its size from the analysis on, and D as a copy.
    const Eigen::SparseMatrix<double>& l() const { return m_matrix; }
    const Eigen::VectorXd& d() const { return m_diag; }
  };

  std::shared_ptr<const FactorOrder> order_;
  Cholesky cholesky_;
  mutable Eigen::VectorXd x_;  // in the order of elimination
};

}  // namespace rheo
