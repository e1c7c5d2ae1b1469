// The edges of a mesh, found by their two node numbers.
//
// Memory   one entry per triangle side, sorted by the lower node (a counting sort) and within it by the
// higher one:
//          linear time but for nodes with very many triangles
// Errors   none; node numbers were checked before
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "rheo/mesh.hpp"

namespace rheo {

class MeshEdges {
 public:
  // A triangle's side; `forward` where the triangle passes from the lower to the higher node number.
  struct Side {
    int high = 0;
    int triangle = 0;
    bool forward = false;
  };

  explicit MeshEdges(const Mesh& mesh);

  // All sides whose lower node is `low`, by rising higher node, then triangle.
  std::span<const Side> sides_of(int low) const;
  // All sides of one edge, in either direction; empty where the mesh has no such edge or node.
  std::span<const Side> sides(const Edge& edge) const;
  // The edge, turned so that a boundary edge has the interior on its left; nothing where the mesh has no such
  // edge.
  std::optional<Edge> oriented(const Edge& edge) const;

 private:
  std::vector<std::size_t> begin_;  // node_count + 1
  std::vector<Side> sides_;
};

}  // namespace rheo
