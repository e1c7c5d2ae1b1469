// Where a point of the plane comes to lie in the picture: equal scale in x and y, y upwards in the plane.
//
//   pixel = (pixel_x + (x - x0) scale, pixel_y - (y - y0) scale)
//
// Units    x, y [m]; pixels from the top left
// Errors   none: empty or non-finite bounds give a unit square about what is known
#pragma once

#include <array>
#include <vector>

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

// A finite point in the picture or at most once its size beside it.
bool near_picture(const Canvas& canvas, Point p);

// Pixels beyond a point on its four sides.
struct Margins {
  float left = 0, top = 0, right = 0, bottom = 0;
};

// `bounds` made finite and not empty.
std::array<double, 4> usable_bounds(std::array<double, 4> bounds);

// What a picture must show: bounds in the plane, and points with something of a fixed size in pixels about
// them (an arrow). The largest scale s at which all of it fits solves, for each axis with margins m and M,
//
//   max_i(s x_i + M_i) - min_i(s x_i - m_i) = length of the area
class Framing {
 public:
  // `bounds`: x0, y0, x1, y1; as usable_bounds() makes them.
  Framing(const std::array<double, 4>& bounds, const Margins& margins);

  void add(double x, double y, const Margins& margins);  // left out unless it is within the bounds

  // The largest scale, all of it centred in `area`. Margins are cut where they leave the bounds less than a
  // fifth of it.
  Camera fit(const Rect& area) const;

  // What `camera` = fit(area) shows of it.
  Rect covered(const Camera& camera, const Rect& area) const;

 private:
  // One side of one axis: points beyond which something reaches, none of them behind another in both numbers.
  struct Reach {
    double at;      // from the middle of the bounds towards this side [m]
    double margin;  // pixels
  };
  class Side {
   public:
    void add(const Reach& reach);
    double pixels(double scale, double cut) const;  // from the middle to the end of all that is here

   private:
    std::vector<Reach> reaches_;  // `at` falling, `margin` rising
  };
  struct Axis {
    double scale;  // the largest
    double cut;    // factor of the margins
  };
  static Axis fit(const Side& low, const Side& high, double extent, double length);
  std::array<Axis, 2> axes(const Rect& area) const;

  std::array<double, 4> bounds_;
  double x0_, y0_;
  Side left_, top_, right_, bottom_;
};

}  // namespace render
