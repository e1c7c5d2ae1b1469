#include "sheet_grid.hpp"

#include <algorithm>

namespace render {

Grid choose_grid(int count, const Rect& area, const std::function<double(const Rect& cell)>& scale) {
  count = std::max(count, 1);
  Grid best;
  double best_scale = -1;
  for (int columns = 1; columns <= count; ++columns) {
    const int rows = (count + columns - 1) / columns;
    if (columns > 1 && (count + columns - 2) / (columns - 1) == rows)
      continue;  // the same rows with fewer columns
    const Grid grid{columns, rows};
    const double reached = scale(grid_cell(grid, area, 0));
    if (reached <= best_scale) continue;
    best_scale = reached;
    best = grid;
  }
  return best;
}

Rect grid_cell(const Grid& grid, const Rect& area, int index) {
  const float w = area.width() / static_cast<float>(grid.columns),
              h = area.height() / static_cast<float>(grid.rows);
  const auto column = static_cast<float>(index % grid.columns),
             row = static_cast<float>(index / grid.columns);
  return {area.x0 + column * w, area.y0 + row * h, area.x0 + (column + 1) * w, area.y0 + (row + 1) * h};
}

}  // namespace render
