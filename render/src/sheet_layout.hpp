// Where the shapes of a sheet and their times stand.
//
// All shapes have one scale: the largest that any grid of equal cells gives. A cell is a line for the time
// and below it the room for the shape with its hatches and arrows, which are shorter in small cells. Times
// are short ("0.25 s") where that makes the shapes larger; captions are cut short where not all have room.
//
// Units    pixels; bounds [m], times [s]
// Errors   none
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "camera.hpp"
#include "canvas.hpp"
#include "traction_arrows.hpp"

namespace render {

struct SheetLayout {
  struct Panel {
    Rect cell;
    Camera camera;
    std::string time;  // with the caption; empty where cells are too narrow for every time
    Point time_at;     // its left end
  };
  std::vector<Panel> panels;
  float hatch_size = 1;
  float longest_arrow = 0;
  float label_gap = 0;  // between a body and its name
};

// `captions`: one a time, may be empty; `bounds` as usable_bounds() makes them; `arrows` of all frames;
// `label_room`: height below a shape for the names of its bodies.
SheetLayout layout_sheet(const Canvas& canvas, const Rect& area, const std::array<double, 4>& bounds,
                         std::span<const double> times, std::span<const std::string_view> captions,
                         std::span<const TractionArrows::Arrow> arrows, float label_room = 0);

}  // namespace render
