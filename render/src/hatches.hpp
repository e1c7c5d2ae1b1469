// Hatches and rollers where a body is held.
//
// Units    pixels for what is drawn, [m] for what is given
// Errors   none; anything that is not finite is left out
#pragma once

#include <span>
#include <vector>

#include "boundary_chains.hpp"
#include "camera.hpp"
#include "canvas.hpp"

namespace render {

// Marks outside of the boundary edges whose two nodes are held, evenly along each run of edges that are held
// alike: slanted strokes where both axes are held; where one is, rollers on a ground if the edge may slide
// along it, straight strokes if the edge may move off and on only. On held nodes without such an edge: dots,
// hollow where one axis is free. `held`: 2 node + axis. `size`: of all marks, 1 in a picture of one shape.
// `mark` is memory for one flag a node, used again from frame to frame.
void draw_hatches(Canvas& canvas, const Camera& camera, const BoundaryChains& boundary,
                  std::span<const double> positions, std::span<const int> held, float size,
                  std::vector<char>& mark);

}  // namespace render
