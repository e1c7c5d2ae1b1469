// What kernels that sweep over blocks of neighbouring nodes have in common: a block's size, and which items
// of a list belong to it.
//
// Shapes   block ends: by block, one past its last node, rising
// Errors   none
#pragma once

#include <cstdint>
#include <vector>

namespace rheo {

// Nodes of a block at least: shorter ones cost more in turns than they keep in cache.
constexpr std::int32_t smallest_block = 256;

template <class Block>
std::vector<std::int32_t> block_ends(const std::vector<Block>& blocks) {
  std::vector<std::int32_t> ends;
  ends.reserve(blocks.size());
  for (const Block& block : blocks) ends.push_back(block.last_node);
  return ends;
}

// Where each block's items begin in a list sorted by node, and the list's end: allocates nothing where
// `begins` has had as many before.
template <class Item, class NodeOf>
void find_block_begins(const std::vector<std::int32_t>& ends, const std::vector<Item>& items,
                       const NodeOf& node_of, std::vector<std::size_t>& begins) {
  begins.assign(1, 0);
  begins.reserve(ends.size() + 1);
  std::size_t k = 0;
  for (const std::int32_t end : ends) {
    while (k < items.size() && node_of(items[k]) < static_cast<std::size_t>(end)) ++k;
    begins.push_back(k);
  }
}

}  // namespace rheo
