#include "kernels/element_sums.hpp"

#include <algorithm>

namespace rheo {
namespace {

// What another block's triangles add, moved to a block's own sum: slots [begin, end).
void take(double* own, double* other, std::size_t begin, std::size_t end) {
  for (std::size_t i = 2 * begin; i < 2 * end; ++i) {
    own[i] += other[i];
    other[i] = 0.0;
  }
}

}  // namespace

ElementSums::ElementSums(const ElementForce& force, const std::vector<ElementForm::Block>& blocks,
                         int threads)
    : force_(force), form_(force.form()), blocks_(blocks) {
  const std::size_t size = 2 * static_cast<std::size_t>(form_.slots);
  for (AlignedVector& sum : sums_) sum.assign(size, 0.0);
  if (threads > 1) at_edges_.assign(size, 0.0);
}

std::size_t ElementSums::reached_begin(std::size_t block) const {
  return static_cast<std::size_t>(form_.slot_begin[static_cast<std::size_t>(blocks_[block].first_node)]);
}

std::size_t ElementSums::reached_end(std::size_t block) const {
  const std::int32_t node = std::min(blocks_[block].last_node, blocks_[block].first_node + form_.bandwidth);
  return static_cast<std::size_t>(form_.slot_begin[static_cast<std::size_t>(node)]);
}

void ElementSums::add_triangles(const double* p, std::size_t block, double* force) const {
  force_.sweep().add_forces(form_, p, force, blocks_[block].first_triangle, blocks_[block].last_triangle);
}

void ElementSums::add_from_below(const double* p, std::size_t block, double* own) {
  const ElementForm::Block& b = blocks_[block];
  double* const edge = at_edges_.data();
  force_.sweep().add_forces(form_, p, edge, b.reaching, b.first_triangle);
  take(own, edge, reached_begin(block), reached_end(block));
  // What they add to the block before is its own thread's to add.
  const std::int32_t lowest = std::max(0, b.first_node - form_.bandwidth);
  const auto first = static_cast<std::size_t>(form_.slot_begin[static_cast<std::size_t>(lowest)]);
  std::fill(edge + 2 * first, edge + 2 * reached_begin(block), 0.0);
}

double* ElementSums::of_block(const double* p, const BlockVisit& visit) {
  const std::size_t block = visit.block;
  double* const own = sums_[block % 2].data();
  double* const other = sums_[1 - block % 2].data();
  const bool up = visit.way == BlockVisit::Way::up;
  const bool highest = up ? visit.last : visit.first;  // of the thread's stretch
  const bool lowest = up ? visit.first : visit.last;
  if (up || visit.first) add_triangles(p, block, own);
  if (highest && block + 1 < blocks_.size()) {
    // The thread above computes that again.
    std::fill(own + 2 * reached_begin(block + 1), own + 2 * reached_end(block + 1), 0.0);
  }
  if (block == 0) return own;
  if (lowest) {
    add_from_below(p, block, own);
    return own;
  }
  if (!up) add_triangles(p, block - 1, other);
  take(own, other, reached_begin(block), reached_end(block));
  return own;
}

}  // namespace rheo
