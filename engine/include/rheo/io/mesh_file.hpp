// Gmsh MSH files, versions 2.2 and 4.1, ASCII and binary.
//
// Three-node triangles make the mesh (nodes renumbered in the order of the file); two-node lines in physical
// groups become edge groups, named by $PhysicalNames or "physical_<tag>". Points and other sections are
// passed over, and so are nodes that no triangle uses where they lie on a geometric point or curve (Gmsh
// writes the middle of an arc, say). How many these were is told to who asks.
//
// Errors   Error::Kind::input: another format or version, another element type, z that differs, a truncated
// file,
//          tags that do not exist, more nodes and elements than there is memory for; Error::Kind::file where
//          the file cannot be read
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "rheo/mesh.hpp"

namespace rheo {

// Nodes of the file that are not in the mesh, because no triangle uses them.
struct LeftOutNodes {
  int count = 0;
  std::int64_t first_tag = 0;  // the file's number of the first of them
};

// Not prepared yet: the caller sets the thickness and calls prepare(). `memory` [bytes] may be taken; 0: what
// this machine has available.
Mesh read_msh(const std::filesystem::path& file, LeftOutNodes* left_out = nullptr, double memory = 0.0);

// The same from the file's bytes; `name` stands for the file in messages.
Mesh parse_msh(std::string bytes, const std::string& name, LeftOutNodes* left_out = nullptr,
               double memory = 0.0);

}  // namespace rheo
