// The rheological force triangle by triangle: for several materials in one mesh.
//
//   with (b_i, c_i) = sqrt(h / (4 T)) (y_j - y_k, x_k - x_j), and l, m the w_lambda, w_mu at a triangle's
//   nodes,
//
//   s_xx = div + 2 sum b_i m_ix        div = sum (b_i l_ix + c_i l_iy)
//   s_yy = div + 2 sum c_i m_iy
//   s_xy = sum (b_i m_iy + c_i m_ix)
//   F_i  = (b_i s_xx + c_i s_xy, b_i s_xy + c_i s_yy)
//
// b and c sum to zero, so that two nodes' differences to the first carry all: four numbers a triangle.
//
// Each region of the mesh has a material of its own. Residual forces belong to a node *and* a region: a node
// has one pair (w_lambda, w_mu), a slot, for each region that touches it, and its force is the sum over its
// slots. With one region slots are nodes.
//
// Nodes are renumbered (node_order.hpp; then by region inside short stretches) and triangles sorted by their
// nodes: what a stretch of triangles reads and adds to lies near each other in memory.
//
// Source   Hirai and Tomokuni, eq. (2), (3), by triangle instead of assembled
// Units    b, c [sqrt(m)]: F in N for w in Pa m
// Shapes   n nodes, s slots and t triangles, in the kernel's own order
// Errors   none: mesh, regions and materials were checked before (asserted)
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "aligned_vector.hpp"
#include "regions.hpp"
#include "rheo/mesh.hpp"

namespace rheo {

struct ElementForm {
  ElementForm(const Mesh& mesh, const Regions& regions);

  int nodes = 0;
  int slots = 0;
  std::vector<Material> materials;
  std::vector<std::int32_t> mesh_node;    // n: number in the mesh of the kernel's node
  std::vector<std::int32_t> kernel_node;  // n: its inverse
  std::vector<std::int32_t> slot_begin;   // n + 1: a node's slots, by rising region
  std::vector<std::int32_t> slot_region;  // s
  std::vector<std::int32_t> slot_node;    // s
  std::vector<double> node_mass;          // n: a third of each triangle's, by its region's density [kg]

  // Nodes in a row with slots of one region each, or one node with several.
  struct Run {
    std::int32_t first = 0;  // node
    std::int32_t last = 0;   // one past
    std::int32_t slot = 0;   // of `first`
    std::int32_t slots_a_node = 1;
    std::int32_t region = 0;  // where there is one slot a node
  };
  std::vector<Run> runs;

  AlignedArray<std::array<double, 4>> gradient;       // t: b_1, c_1, b_2, c_2
  AlignedArray<std::array<std::uint32_t, 3>> offset;  // t: 4 x slot of the corners 0, 1, 2

  // A node's triangles, rising.
  std::span<const std::int32_t> triangles_at(std::size_t node) const {
    return std::span(node_triangles).subspan(node_begin[node], node_begin[node + 1] - node_begin[node]);
  }
  std::vector<std::size_t> node_begin;       // n + 1
  std::vector<std::int32_t> node_triangles;  // 3t

  // A triangle's nodes have numbers within this distance.
  std::int32_t bandwidth = 0;

  // Stretches of nodes, none (but the last) shorter than the bandwidth: a triangle's nodes lie in one block
  // or in two neighbouring ones, and it belongs to the lower.
  struct Block {
    std::int32_t first_node = 0, last_node = 0;
    std::int32_t first_run = 0, last_run = 0;            // that have nodes in it
    std::int64_t first_triangle = 0, last_triangle = 0;  // that belong to it
    std::int64_t reaching = 0;  // first triangle from which on some of the block before reach into it
  };
  std::vector<Block> blocks(std::int32_t smallest) const;
};

}  // namespace rheo
