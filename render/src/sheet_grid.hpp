// How many columns and rows show a number of equal panels at the largest scale.
//
// Errors   none; count < 1 is taken as 1
#pragma once

#include <functional>

#include "canvas.hpp"

namespace render {

struct Grid {
  int columns = 1, rows = 1;
};

// `scale`: of what a panel shows when it has this cell. Cells of the last row may stay empty.
Grid choose_grid(int count, const Rect& area, const std::function<double(const Rect& cell)>& scale);

Rect grid_cell(const Grid& grid, const Rect& area, int index);

}  // namespace render
