// An order of a mesh's nodes in which neighbours have near numbers (reverse Cuthill-McKee), for locality in
// memory.
//
// Source   Cuthill and McKee 1969; George 1971 (reversed); each connected part from a node far from its
// middle, found by two breadth-first passes
// Cost     linear in the triangles, but for a short sort of each node's neighbours
#pragma once

#include <cstdint>
#include <vector>

#include "rheo/mesh.hpp"

namespace rheo {

// By new number: the node's number in the mesh.
std::vector<std::int32_t> narrow_order(const Mesh& mesh);

}  // namespace rheo
