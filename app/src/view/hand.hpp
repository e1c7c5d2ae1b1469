// The cursor as a hand: which boundary edges it is at, and what dragging them means.
//
// Units    pixels for the cursor, SI for the body
// Errors   none
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "render/mesh_picture.hpp"
#include "view/display.hpp"

namespace app::view {

// Boundary edges within `radius` pixels of the cursor, by the middle of the edge; else the nearest one that
// is as near itself. At most `most`, the nearest first.
std::vector<rheo::Edge> edges_at(const Display& display, const render::PlaneInPicture& plane,
                                 std::array<double, 2> cursor, double radius, std::size_t most);

// Mean place of the edges' middles. [m]
rheo::Vec2 middle_of(const std::vector<rheo::Edge>& edges, std::span<const double> positions);

// Pa a metre of drag: a drag over half the body's diagonal makes a stress of a quarter of the instantaneous
// stiffness lambda + 2 mu.
double default_push(const rheo::Scene& scene);

}  // namespace app::view
