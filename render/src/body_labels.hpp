// Names of bodies beside them.
//
// A name stands below its body, else above it, at its right or at its left: the first of these places that
// lies in the picture's area and meets no body's box and no other name.
//
// Units    pixels
// Errors   none: a name without a free place is left out
#pragma once

#include <span>
#include <string>
#include <vector>

#include "camera.hpp"
#include "canvas.hpp"
#include "render/mesh_picture.hpp"

namespace render {

// What is drawn of a body, as a box; empty where no node of it is finite.
Rect body_box(const Camera& camera, std::span<const double> positions, const BodyLabel& body);

// The boxes of all names, empty where there is no place; `sizes`: width and height of each, `gap`: between a
// name and its body.
std::vector<Rect> label_boxes(std::span<const Rect> bodies, std::span<const Point> sizes, float gap,
                              const Rect& area);

class BodyLabels {
 public:
  explicit BodyLabels(std::span<const BodyLabel> labels) : labels_(labels.begin(), labels.end()) {}

  // All characters, for a Canvas.
  std::string characters() const;
  // Height below the lowest body that a name takes.
  float room(const Canvas& canvas, TextSize size) const;
  // Names are shortened to the area's width.
  std::vector<Rect> boxes(const Canvas& canvas, const Camera& camera, std::span<const double> positions,
                          TextSize size, float gap, const Rect& area) const;
  // At those boxes.
  void draw(Canvas& canvas, std::span<const Rect> boxes, TextSize size) const;
  bool empty() const { return labels_.empty(); }

 private:
  std::vector<BodyLabel> labels_;
};

}  // namespace render
