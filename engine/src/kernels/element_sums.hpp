// The element form's force at a block's slots, each triangle computed once a sweep, whichever way a thread
// goes.
//
//   F at a slot = sum over the triangles of its own block + sum over those of the block before that reach
//   into it, each in the triangles' order
//
// Two sums of their own, so that both ways through the blocks add the same numbers in the same order. A
// block's triangles add to the array of its number modulo 2: in it lie the block's own sum and what it passes
// on to the next block. Upwards that waits for the next visit; downwards the block before is computed with
// its upper neighbour's visit, and its own sum waits. At the edge of two threads' stretches the upper thread
// computes the lower one's reaching triangles again, in a third array; only there.
//
// Shapes   p: s x 4; F: s x 2, zero between chains
// Threads  of_block by several, as block_team.hpp calls it, of stretches of at least two blocks
// Errors   none
#pragma once

#include <array>
#include <vector>

#include "aligned_vector.hpp"
#include "kernels/block_team.hpp"
#include "kernels/element_force.hpp"

namespace rheo {

class ElementSums {
 public:
  // All must outlive this.
  ElementSums(const ElementForce& force, const std::vector<ElementForm::Block>& blocks, int threads);

  // F of p by slot, valid at the slots of the visited block; who reads it there sets it to zero again.
  double* of_block(const double* p, const BlockVisit& visit);

 private:
  void add_triangles(const double* p, std::size_t block, double* force) const;
  // The slots of a block's nodes that triangles of the block before reach.
  std::size_t reached_begin(std::size_t block) const;
  std::size_t reached_end(std::size_t block) const;
  // The block before's reaching triangles, by the thread of this block.
  void add_from_below(const double* p, std::size_t block, double* own);

  const ElementForce& force_;
  const ElementForm& form_;
  const std::vector<ElementForm::Block>& blocks_;
  std::array<AlignedVector, 2> sums_;
  AlignedVector at_edges_;  // several threads only
};

}  // namespace rheo
