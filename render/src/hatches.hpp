// Hatches where a body is held.
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

// Strokes outside of the boundary edges whose two nodes are held, evenly along each run of such edges; dots
// on held nodes without such an edge. `size`: of strokes and dots, 1 in a picture of one shape. `mark` is
// memory for one flag a node, used again from frame to frame.
void draw_hatches(Canvas& canvas, const Camera& camera, const BoundaryChains& boundary,
                  std::span<const double> positions, std::span<const int> held, float size,
                  std::vector<char>& mark);

}  // namespace render
