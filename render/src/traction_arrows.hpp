// Traction arrows on a body, and their values.
//
// Units    pixels for what is drawn, [m] and [Pa] for what is given
// Errors   none; anything that is not finite is left out
#pragma once

#include <array>
#include <span>
#include <vector>

#include "camera.hpp"
#include "canvas.hpp"
#include "label_place.hpp"
#include "render/mesh_picture.hpp"

namespace render {

// Arrows of a length proportional to the traction, `longest` pixels at `scale` Pa (<= 0: at the largest of
// the frame). One that pulls starts on its edge, one that presses ends on it. Those too close together to be
// told apart are thinned out.
class TractionArrows {
 public:
  TractionArrows(std::vector<int> boundary, std::span<const int> triangles, std::vector<double> rest);

  // `value_area`: where each size of traction (the five largest of many) is written, near an arrow that has
  // it and clear of arrows and body; empty: nowhere.
  void draw(Canvas& canvas, const Camera& camera, const MeshFrame& frame, double scale, float longest,
            const Rect& value_area);

  // An arrow whatever its length in pixels will be.
  struct Arrow {
    std::array<double, 2> at{};
    Point direction{};  // in the picture, of length 1
    float part = 0;     // of the longest
    bool presses = false;
  };
  // The frame's arrows that draw() draws, before thinning.
  std::vector<Arrow> arrows(const MeshFrame& frame, double scale);

  // Makes room for them.
  static void add_to(Framing& framing, const Canvas& canvas, std::span<const Arrow> arrows, float longest);

 private:
  struct Drawn {
    double size = 0;    // [Pa]
    Point outer, away;  // the end that is farther from the body, and the way on from there
  };
  void write_values(Canvas& canvas, const Camera& camera, const MeshFrame& frame, std::vector<Drawn>& sizes,
                    std::vector<Stroke> drawn, const Rect& area) const;
  std::array<double, 2> outward_normal(const MeshFrame& frame, std::size_t k);
  Arrow arrow(const MeshFrame& frame, std::size_t k, double scale);

  std::vector<int> boundary_;      // k x 2
  std::vector<int> opposite_;      // k, the third node of the edge's triangle; -1 where there is none
  std::vector<double> rest_;       // n x 2
  std::vector<std::size_t> edge_;  // of each arrow, as found in the last frame
};

}  // namespace render
