// The cursor as a hand: which boundary edges it is at, and what dragging them means.
//
// Units    pixels for the cursor, SI for the body
// Errors   none
#pragma once

#include <array>
#include <vector>

#include "render/mesh_picture.hpp"
#include "view/display.hpp"

namespace app::view {

// A place on an edge, which goes with it: 0 at its first node, 1 at its second.
struct Grip {
  rheo::Edge edge{0, 0};
  double along = 0.0;
};
rheo::Vec2 place_of(const Grip& grip, std::span<const double> positions);  // [m]

struct Reach {
  std::vector<rheo::Edge> edges;  // empty: none is near
  Grip nearest;                   // of them, to the cursor
};
// Boundary edges of the nearest piece within `radius` pixels of the cursor, by the middle of the edge; else
// the nearest one that is as near itself. At most `most`, the nearest first. pieces: rheo::pieces_of().
Reach reach_at(const Display& display, const std::vector<int>& pieces, const render::PlaneInPicture& plane,
               std::array<double, 2> cursor, double radius, std::size_t most);

// Pa a metre of drag: a drag over half the diagonal of the edge's piece makes a stress of a quarter of the
// instantaneous stiffness lambda + 2 mu of the material there.
double default_push(const rheo::Scene& scene, const std::vector<int>& pieces, const rheo::Edge& edge);

}  // namespace app::view
