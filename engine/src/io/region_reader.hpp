// The [[region]] tables of a scene file: parts of the mesh with a material of their own.
//
//   name, and exactly one of
//   physical = "crumb"             a Gmsh file's physical surface ("physical_<tag>" without a name)
//   box = [x0, y0, x1, y1]         m; triangles whose centroid lies inside, here and below
//   disk = [x, y, radius]
//   polygon = [[x, y], ...]        three corners or more, the even-odd rule
//   triangles = [i, ...]           by number
//   and [region.material]          all that [material] has; its mass is the scene's
//
// A later region takes triangles away from an earlier one.
//
// Errors   Error::Kind::input: as everywhere in the scene; a region without a triangle
#pragma once

#include <string>

#include "io/allowance.hpp"
#include "io/toml_tree.hpp"
#include "rheo/scene.hpp"

namespace rheo {

// Adds the region to `scene`, whose mesh and first material are there. `owner`: "" or "body.".
void read_region(const TomlValue& table, const std::string& file, Allowance& allowance,
                 const std::string& owner, Scene& scene);

// Refuses regions of which later ones have left nothing.
void check_regions(const Scene& scene);

}  // namespace rheo
