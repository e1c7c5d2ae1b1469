// Meshes of simple outlines.
//
// Units    m; `memory` [bytes]: what the mesh may take; 0: what this machine has available
// Errors   Error::Kind::input for sizes and counts that make no mesh, and for meshes of more nodes than
//          `memory` or max_shape_nodes allow (before their memory is asked for)
#pragma once

#include "rheo/mesh.hpp"

namespace rheo {

inline constexpr int max_shape_nodes =
    150'000'000;  // of two triangles each, whose corners are counted by int
inline constexpr double bytes_a_shape_node = 140.0;  // while it is made; a simulation takes much more

// How a cell with corners bl, br, tl, tr is cut in two.
enum class Diagonal {
  falling,     // (bl, br, tl) (tr, tl, br)
  rising,      // (bl, br, tr) (bl, tr, tl)
  alternating  // falling where column + row is even, else rising
};

// nx x ny nodes over width x height; node = row * nx + column, row 0 at the bottom, column 0 at the left.
// Prepared. Edge groups: left, right, bottom, top, boundary.
Mesh rectangle(Vec2 size, int nx, int ny, Diagonal diagonal = Diagonal::falling, double memory = 0.0);

// A node in the middle (the origin) and 6 k nodes on ring k = 1..rings; ring k begins at node 1 + 3 k (k -
// 1), on the positive x axis, and runs counter-clockwise. Prepared. Edge groups: rim, boundary.
Mesh disk(double radius, int rings, double memory = 0.0);

}  // namespace rheo
