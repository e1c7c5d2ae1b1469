// What is drawn about a body: hatches where it is held, traction arrows, the colour bar.
//
// Units    pixels for what is drawn, [m] and [Pa] for what is given
// Errors   none; anything that is not finite is left out
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "boundary_chains.hpp"
#include "camera.hpp"
#include "canvas.hpp"
#include "render/mesh_picture.hpp"

namespace render {

// Strokes outside of the boundary edges whose two nodes are held, evenly along each run of such edges; dots
// on held nodes without such an edge. `mark` is memory for one flag a node, used again from frame to frame.
void draw_hatches(Canvas& canvas, const Camera& camera, const BoundaryChains& boundary,
                  std::span<const double> positions, std::span<const int> held, std::vector<char>& mark);

// Arrows of a length proportional to the traction, `longest` pixels at `scale` Pa (<= 0: at the largest of
// the frame). One that pulls starts on its edge, one that presses ends on it. Those too close together to be
// told apart are thinned out.
class TractionArrows {
 public:
  TractionArrows(std::vector<int> boundary, std::span<const int> triangles, std::vector<double> rest);

  // `value_area`: where the largest traction is written beside its arrow; empty: nowhere.
  void draw(Canvas& canvas, const Camera& camera, const MeshFrame& frame, double scale, float longest,
            const Rect& value_area);

  // Makes room for the frame's arrows, as draw() draws them.
  void add_to(Framing& framing, const Canvas& canvas, const MeshFrame& frame, double scale, float longest);

 private:
  // One arrow about its foot, in pixels.
  struct Shape {
    Point tail, tip;
    bool presses = false;
    Point outer() const { return presses ? tail : tip; }
  };
  Shape shape(const MeshFrame& frame, std::size_t k, double scale, float longest, float unit);
  std::array<double, 2> outward_normal(const MeshFrame& frame, std::size_t k);

  std::vector<int> boundary_;      // k x 2
  std::vector<int> opposite_;      // k, the third node of the edge's triangle; -1 where there is none
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
