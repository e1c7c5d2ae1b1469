// The rheological force by edges: three numbers an edge carry both connection matrices (one material over the
// mesh).
//
//   F_i = sum_j S_ij (a_j - a_i) + trace(S_ij) (w_mu,j - w_mu,i)        a = w_lambda + w_mu
//       + boundary: (h / 4) rot(g_next - g_prev),  g = w_lambda - w_mu, rot(x, y) = (y, -x)
//   S_ij = sum over the triangles of edge ij of h / (4 T) sym((b_i, c_i) (b_j, c_j)^T)
//
// With S = s0 I + s1 diag(1, -1) + s2 antidiag(1, 1) this is, in the sums s_k dw over a node's edges,
//
//   F_x = sum s0 (dl_x + 3 dm_x) + s1 (dl_x + dm_x) + s2 (dl_y + dm_y)         l = w_lambda, m = w_mu
//   F_y = sum s0 (dl_y + 3 dm_y) - s1 (dl_y + dm_y) + s2 (dl_x + dm_x)
//
// so that kernels gather 4 numbers a neighbour and keep three sums of 4 lanes a node, combined once at its
// end.
//
// Nodes are renumbered (reverse Cuthill-McKee, then by valence inside short stretches): neighbours lie near
// each other in memory and runs of equal valence need no branch.
//
// Source   design of this project; J_mu,ij = J_lambda,ij^T + trace(J_lambda,ij) I for linear triangles
// Units    s0, s1, s2 [m] (thickness included): F in N for w in Pa m
// Shapes   n nodes in the kernel's own order; directed edges: each edge of the mesh twice
#pragma once

#include <cstdint>
#include <vector>

#include "rheo/mesh.hpp"

namespace rheo {

struct EdgeForm {
  explicit EdgeForm(const Mesh& mesh);

  int nodes = 0;
  std::vector<std::int32_t> mesh_node;    // n: number in the mesh of the kernel's node
  std::vector<std::int32_t> kernel_node;  // n: its inverse

  // Runs of nodes with one valence; directed edges lie one after the other in node order.
  struct Run {
    std::int32_t first = 0;  // node
    std::int32_t last = 0;   // one past
    std::int32_t valence = 0;
    std::int64_t edge = 0;  // of `first`
  };
  std::vector<Run> runs;
  std::vector<std::uint32_t> offset;  // by directed edge: 4 x the neighbour's number
  std::vector<double> s;              // 3 by directed edge: s0, s1, s2

  // Boundary passages: previous and next node along the boundary (interior on the left) of a boundary node.
  struct Corner {
    std::int32_t node = 0;
    std::int32_t previous = 0;
    std::int32_t next = 0;
  };
  std::vector<Corner> corners;
  double quarter_thickness = 0.0;  // h / 4

  // A node's neighbours have numbers within this distance.
  std::int32_t bandwidth = 0;

  // Stretches of whole runs, none (but the last) shorter than the bandwidth: a node's neighbours lie in its
  // own or a neighbouring block, so that sweeps can follow each other through the mesh at a distance of one
  // block.
  struct Block {
    std::int32_t first_run = 0, last_run = 0;
    std::int32_t first_node = 0, last_node = 0;
  };
  std::vector<Block> blocks;
};

}  // namespace rheo
