// What is drawn about a body: hatches where it is held, traction arrows, the colour bar.
//
// Units    pixels for what is drawn, [m] and [Pa] for what is given
// Errors   none; anything that is not finite is left out
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "camera.hpp"
#include "canvas.hpp"
#include "render/mesh_picture.hpp"

namespace render {

// Strokes outside of the boundary edges whose two nodes are held, dots on held nodes without such an edge.
// `mark` is memory for one flag a node, used again from frame to frame.
void draw_hatches(Canvas& canvas, const Camera& camera, std::span<const int> boundary,
                  std::span<const double> positions, std::span<const int> held, std::vector<char>& mark);

// Arrows of a length proportional to the traction, `longest` pixels at `scale` Pa. One that pulls starts on
// the edge, one that presses ends on it. Those too close together to be told apart are thinned out.
class TractionArrows {
 public:
  TractionArrows(std::vector<int> boundary, std::vector<double> rest)
      : boundary_(std::move(boundary)), rest_(std::move(rest)) {}
  // `value_area`: where the largest traction is written beside its arrow; empty: nowhere.
  void draw(Canvas& canvas, const Camera& camera, std::span<const double> positions,
            std::span<const TractionArrow> arrows, double scale, float longest, const Rect& value_area);

 private:
  std::array<double, 2> outward_normal(std::span<const double> positions, const TractionArrow& arrow,
                                       std::size_t k);

  std::vector<int> boundary_;      // k x 2
  std::vector<double> rest_;       // n x 2
  std::vector<std::size_t> edge_;  // of each arrow, as found in the last frame
};

// The bar's place and text sizes, so that a layout can leave room for it.
struct ColorBar {
  std::string name, unit;
  std::array<double, 2> range{};
};
float color_bar_width(const Canvas& canvas, const ColorBar& bar);
void draw_color_bar(Canvas& canvas, const ColorBar& bar, const Rect& area);

}  // namespace render
