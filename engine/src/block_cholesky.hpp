// S = L L^T of a sparse symmetric positive definite matrix of 2 x 2 blocks, a block a pair of nodes.
//
//   analysis  an order of the nodes that keeps L sparse (approximate minimum degree), the elimination tree,
//   and
//             the columns of L; once a mesh
//   factor    row by row: L_ki = (S_ki - sum over j < i of L_kj L_ij^T) L_ii^-T, L_kk L_kk^T = what is left
//   of
//             S_kk; for every new set of values
//   solve     L z = r, L^T x = z, in place
//
// Blocks halve the indices that a scalar factor reads, and the small products run in registers.
//
// Source   Davis, Direct Methods for Sparse Linear Systems (2006), ch. 4 (elimination tree, up-looking
// factor);
//          Amestoy, Davis and Duff, 1996 (the order; Eigen's implementation)
// Shapes   blocks: row-major 2 x 2, in the order of the pattern's entries; x: 2 numbers a node, in the mesh's
// order Errors   factor: false where a pivot is not positive beyond rounding
#pragma once

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

// All that does not depend on values; shared by the factors of one pattern.
class BlockAnalysis {
 public:
  explicit BlockAnalysis(BlockPattern pattern);

  const BlockPattern& pattern() const { return pattern_; }
  // Blocks of L below its diagonal.
  std::size_t fill() const { return column_start_.back(); }
  // Memory of one factor [bytes].
  std::size_t factor_bytes() const;

 private:
  friend class BlockCholesky;

  // Where row k of L has blocks, as reach[top..nodes), so that a column comes after those it depends on.
  int reach(int k, std::span<int> stack, std::span<int> mark) const;

  BlockPattern pattern_;
  std::vector<int> order_;                 // node at each place
  std::vector<int> place_;                 // of each node
  std::vector<int> parent_;                // in the elimination tree, -1: none
  std::vector<std::size_t> column_start_;  // nodes + 1, into L's blocks below the diagonal
};

class BlockCholesky {
 public:
  explicit BlockCholesky(std::shared_ptr<const BlockAnalysis> analysis);

  int nodes() const { return analysis_->pattern().nodes(); }

  bool factor(std::span<const Block> values);
  // x = S^-1 x
  void solve(std::span<double> x) const;

 private:
  std::shared_ptr<const BlockAnalysis> analysis_;
  std::vector<int> row_;           // of each block below the diagonal, by columns
  std::vector<Block> below_;       // likewise
  std::vector<Block> diagonal_;    // L_kk^-1: lower triangles, the upper right number 0
  mutable std::vector<double> x_;  // in the order of elimination
};

}  // namespace rheo
