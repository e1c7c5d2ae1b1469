#include <gtest/gtest.h>

#include <utility>

#include "camera.hpp"
#include "sheet_grid.hpp"

namespace {

using render::Camera;
using render::Framing;
using render::Rect;

constexpr double close = 1e-4;  // pixels are floats

TEST(Framing, FillsTheAreaUpToTheMargins) {
  const Rect area{100, 50, 500, 450};
  const Framing framing({0, 0, 2, 1}, {10, 20, 30, 40});
  const Camera camera = framing.fit(area);
  EXPECT_NEAR(camera.scale, (400 - 10 - 30) / 2.0, close);
  EXPECT_NEAR(camera.pixel(0, 0).x, 110, close);
  EXPECT_NEAR(camera.pixel(2, 0).x, 470, close);
  const Rect covered = framing.covered(camera, area);
  EXPECT_NEAR(covered.x0, 100, close);
  EXPECT_NEAR(covered.x1, 500, close);
  EXPECT_NEAR(covered.y0 - area.y0, area.y1 - covered.y1, close) << "centred";
  EXPECT_NEAR(covered.height(), camera.scale * 1 + 20 + 40, close);
}

TEST(Framing, WhatStandsInsideOfTheBoundsCostsNothing) {
  const Rect area{0, 0, 400, 400};
  Framing framing({0, 0, 1, 1}, {10, 10, 10, 10});
  const double alone = framing.fit(area).scale;
  framing.add(0.5, 0.5, {60, 60, 60, 60});
  EXPECT_EQ(framing.fit(area).scale, alone);
  framing.add(0.95, 0.5, {0, 0, 60, 0});
  const Camera camera = framing.fit(area);
  EXPECT_LT(camera.scale, alone);
  EXPECT_GT(camera.scale, alone - 60);
  EXPECT_NEAR(camera.pixel(0.95, 0).x + 60, 400, close) << "what reaches out ends at the side";
  EXPECT_NEAR(camera.pixel(0, 0).x, 10, close) << "the other side needs no more than before";
}

TEST(Framing, SmallAreasLeaveSomeOfTheBody) {
  Framing framing({0, 0, 1, 1}, {10, 10, 10, 10});
  framing.add(1, 0.5, {0, 0, 500, 0});
  framing.add(0, 0.5, {500, 0, 0, 0});
  const Camera camera = framing.fit({0, 0, 100, 100});
  EXPECT_NEAR(camera.scale, 20, 0.01);
  EXPECT_GT(framing.fit({0, 0, 0, 0}).scale, 0);
}

std::pair<int, int> grid_of(int count, double w, double h, const Rect& area, const render::Margins& margins) {
  const Framing framing({0, 0, w, h}, margins);
  const render::Grid grid =
      render::choose_grid(count, area, [&](const Rect& cell) { return framing.fit(cell).scale; });
  return {grid.columns, grid.rows};
}

TEST(Grid, UsesThePictureWell) {
  const Rect wide{0, 0, 1600, 900};
  EXPECT_EQ(grid_of(1, 1, 1, wide, {}), (std::pair{1, 1}));
  EXPECT_EQ(grid_of(6, 1, 1, wide, {}), (std::pair{3, 2}));
  EXPECT_EQ(grid_of(6, 10, 1, wide, {}), (std::pair{1, 6}));
  EXPECT_EQ(grid_of(6, 1, 10, wide, {}), (std::pair{6, 1}));
}

TEST(Grid, NoOtherGridShowsLargerPanels) {
  const Rect area{20, 60, 1190, 700};
  for (const int count : {1, 2, 5, 8, 11, 12, 30}) {
    for (const double ratio : {0.1, 0.5, 1.0, 3.3, 10.0}) {
      const Framing framing({0, 0, ratio, 1}, {12, 80, 12, 12});
      const auto scale = [&](const Rect& cell) { return framing.fit(cell).scale; };
      const render::Grid best = render::choose_grid(count, area, scale);
      EXPECT_GE(best.columns * best.rows, count);
      const double reached = scale(render::grid_cell(best, area, 0));
      for (int columns = 1; columns <= count; ++columns) {
        const render::Grid other{columns, (count + columns - 1) / columns};
        EXPECT_LE(scale(render::grid_cell(other, area, 0)), reached) << count << " of " << ratio;
      }
    }
  }
}

// Eleven slabs of 10 x 3 with pressing arrows above: 6 x 2 would leave most of the height empty.
TEST(Grid, FlatShapesGetMoreRows) {
  EXPECT_EQ(grid_of(11, 10, 3, {22, 62, 1193, 698}, {12, 80, 12, 12}), (std::pair{4, 3}));
}

}  // namespace
