// The colour bar: name, unit, the colours from low to high, and at least two numbers where they fit.
//
// Units    pixels
// Errors   none: no numbers without a finite range
#pragma once

#include <array>
#include <string>

#include "canvas.hpp"
#include "render/mesh_picture.hpp"

namespace render {

struct ColorBar {
  std::string name, unit;
  std::array<double, 2> range{};
  BarRoom room = BarRoom::as_needed;
};

// What the bar takes of a picture's width, so that a layout can leave room for it.
float color_bar_width(const Canvas& canvas, const ColorBar& bar);

// Numbers that would touch each other in a low `area` are left out.
void draw_color_bar(Canvas& canvas, const ColorBar& bar, const Rect& area);

}  // namespace render
