// Gmsh MSH files, versions 2.2 and 4.1, ASCII and binary.
//
// Three-node triangles make the mesh (nodes renumbered in the order of the file); two-node lines in physical
// groups become edge groups, named by $PhysicalNames or "physical_<tag>". Points and other sections are
// passed over, and so are nodes that no triangle uses where they lie on a geometric point or curve (Gmsh
// writes the middle of an arc, say).
//
// Errors   Error::Kind::input: another format or version, another element type, z that differs, a truncated
// file,
//          tags that do not exist; Error::Kind::file where the file cannot be read
#pragma once

#include <filesystem>
#include <string>

#include "rheo/mesh.hpp"

namespace rheo {

// Not prepared yet: the caller sets the thickness and calls prepare().
Mesh read_msh(const std::filesystem::path& file);

// The same from the file's bytes; `name` stands for the file in messages.
Mesh parse_msh(std::string bytes, const std::string& name);

}  // namespace rheo
