// Where a point of the plane comes to lie in the picture: equal scale in x and y, y upwards in the plane.
//
//   pixel = (pixel_x + (x - x0) scale, pixel_y - (y - y0) scale)
//
// Units    x, y [m]; pixels from the top left
// Errors   none: empty or non-finite bounds give a unit square about what is known
#pragma once

#include <array>

#include "canvas.hpp"

namespace render {

struct Camera {
  double x0 = 0, y0 = 0;            // looked at [m]
  double pixel_x = 0, pixel_y = 0;  // where that is in the picture
  double scale = 1;                 // pixels per metre

  Point pixel(double x, double y) const {
    return {static_cast<float>(pixel_x + (x - x0) * scale), static_cast<float>(pixel_y - (y - y0) * scale)};
  }
};

// The largest scale at which `bounds` (x0, y0, x1, y1) fit into `area`, centred.
Camera fit_camera(const std::array<double, 4>& bounds, const Rect& area);

// `bounds` made finite and not empty.
std::array<double, 4> usable_bounds(std::array<double, 4> bounds);

}  // namespace render
