// The rheological force by edges: three numbers an edge carry both connection matrices (one material over the
// mesh).
//
//   F_i = sum_j S_ij (a_j - a_i) + trace(S_ij) (w_mu,j - w_mu,i)        a = w_lambda + w_mu
//       + boundary: (h / 4) rot(g_next - g_prev),  g = w_lambda - w_mu, rot(x, y) = (y, -x)
//   S_ij = sum over the triangles of edge ij of h / (4 T) sym((b_i, c_i) (b_j, c_j)^T)
//
// With S = [xx xy; xy yy] this is, in sums over a node's edges,
//
//   F_x = sum xx dl_x + (2 xx + yy) dm_x + xy (dl_y + dm_y)         l = w_lambda, m = w_mu
//   F_y = sum yy dl_y + (2 yy + xx) dm_y + xy (dl_x + dm_x)
//
// so that kernels gather the row p = (l_x, l_y, m_x, m_y) of a neighbour and keep two sums of 4 lanes a node:
// of level = (xx, yy, 2 xx + yy, 2 yy + xx) times dp, and of mixed = xy times dp, combined once at its end.
// While a step's data stay near the processor, level is kept ready: two numbers more an edge to read, fewer
// instructions. On larger meshes xx and yy are kept and the sums formed on the way (Level): the same bits.
//
// Where the branches relax at one rate, or only one is there, w_lambda = lambda_ela q and w_mu = mu_ela q
// with one q' = v - rate q, and one row of two numbers carries both (Combined):
//
//   F_x = sum kxx dq_x + kxy dq_y,  F_y = sum kyy dq_y + kxy dq_x
//   kxx = lambda_ela xx + mu_ela (2 xx + yy),  kyy likewise,  kxy = (lambda_ela + mu_ela) xy
//
// Nodes are renumbered (reverse Cuthill-McKee, then by valence inside short stretches): neighbours lie near
// each other in memory and runs of equal valence need no branch. Nodes of a run are taken two by two, their
// edges alternate in memory: one wide load serves both.
//
// Source   design of this project; J_mu,ij = J_lambda,ij^T + trace(J_lambda,ij) I for linear triangles
// Units    S [m] (thickness included): F in N for w in Pa m; k [Pa m]: F in N for q in m
// Shapes   n nodes in the kernel's own order; directed edges: each edge of the mesh twice
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "aligned_vector.hpp"
#include "rheo/material.hpp"
#include "rheo/mesh.hpp"

namespace rheo {

// Both branches as one: the moduli by which a common q is multiplied.
struct Combined {
  double lambda = 0.0, mu = 0.0;  // [Pa]
};

// Whether a material's two moduli can be combined: one branch of equal rates (but for rounding), or of a zero
// modulus.
std::optional<Combined> combined(const Material& material);

// What an edge keeps of its level for a row of 4: all four numbers, or xx and yy alone.
enum class Level { ready, summed };

struct EdgeForm {
  // `level`: none for what is faster at the mesh's size; combined branches know one way only.
  explicit EdgeForm(const Mesh& mesh, const std::optional<Combined>& moduli = std::nullopt,
                    const std::optional<Level>& level = std::nullopt);

  std::optional<Combined> moduli;
  int row = 4;        // numbers of a node's row p: 4, or 2 where the branches are combined
  int level_row = 4;  // numbers kept an edge of its level: 4, or 2 where summed or combined

  int nodes = 0;
  std::vector<std::int32_t> mesh_node;    // n: number in the mesh of the kernel's node
  std::vector<std::int32_t> kernel_node;  // n: its inverse

  // A node's edges: `edge`, `edge` + `stride`, ...
  struct Edges {
    std::int64_t edge = 0;
    std::int64_t stride = 1;
  };
  // Runs of nodes with one valence. The first and second node's edges alternate, then the third's and
  // fourth's, ...; those of a last node without a partner lie in a row. A run begins at an even edge: single
  // ones in between are empty.
  struct Run {
    std::int32_t first = 0;  // node
    std::int32_t last = 0;   // one past
    std::int32_t valence = 0;
    std::int64_t edge = 0;  // of `first`

    Edges edges_of(std::int64_t node) const {
      const std::int64_t k = node - first;
      const bool paired = (k | 1) < last - first;
      return {edge + (k - k % 2) * valence + (paired ? k % 2 : 0), paired ? 2 : 1};
    }
  };
  std::vector<Run> runs;
  AlignedArray<std::uint32_t> offset;  // by directed edge: `row` x the neighbour's number
  AlignedVector level;                 // by directed edge: xx, yy (2 xx + yy, 2 yy + xx), or kxx, kyy
  AlignedVector mixed;  // by directed edge: xy or kxy; some zeros beyond the end, for wide loads

  // Boundary passages: previous and next node along the boundary (interior on the left) of a boundary node.
  struct Corner {
    std::int32_t node = 0;
    std::int32_t previous = 0;
    std::int32_t next = 0;
  };
  std::vector<Corner> corners;
  double corner_factor = 0.0;  // h / 4, times lambda - mu where combined

  // A node's neighbours have numbers within this distance.
  std::int32_t bandwidth = 0;

  // Stretches of whole runs: a node's neighbours lie in its own or a neighbouring block, so that sweeps can
  // follow each other through the mesh at a distance of one block. Each is as short as that allows, down to
  // smallest_block: the shorter, the nearer the data stay.
  struct Block {
    std::int32_t first_run = 0, last_run = 0;
    std::int32_t first_node = 0, last_node = 0;
  };
  std::vector<Block> blocks;

  // A directed edge's level, where the row is 4.
  std::array<double, 4> full_level(std::size_t edge) const {
    const double* at = level.data() + static_cast<std::size_t>(level_row) * edge;
    return {at[0], at[1], 2 * at[0] + at[1], 2 * at[1] + at[0]};
  }
};

}  // namespace rheo
