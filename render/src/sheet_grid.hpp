// How many columns and rows show a number of equal panels at the largest scale.
//
// Errors   none; count < 1 is taken as 1
#pragma once

#include <array>

#include "canvas.hpp"

namespace render {

struct Grid {
  int columns = 1, rows = 1;
};

// Panels of bounds with the given width and height [m] in `area`; each loses `inset_x` and `inset_y` pixels
// to its label and to the space between.
Grid choose_grid(int count, double width, double height, const Rect& area, float inset_x, float inset_y);

Rect grid_cell(const Grid& grid, const Rect& area, int index);

}  // namespace render
