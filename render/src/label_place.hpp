// Where a small text can stand without hiding what is drawn.
//
// Units    pixels
// Errors   none: where there is no free place, one that hides strokes least
#pragma once

#include <span>

#include "canvas.hpp"

namespace render {

// A drawn line with its thickness.
struct Stroke {
  Point from, to;
  float half_width = 0;
};

// The middle of a box of `width` x `height` inside of `area`: the place nearest to `wanted` of a fine grid
// about it where the box meets none of `strokes` and nothing of the body. `outline`: the body's boundary
// edges in any order, each a stroke; inside is where a ray meets an odd number of them.
Point free_place(Point wanted, float width, float height, const Rect& area, std::span<const Stroke> strokes,
                 std::span<const Stroke> outline);

}  // namespace render
