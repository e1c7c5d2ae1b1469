// Pictures of a deforming mesh: single frames and the sheet of successive shapes.
//
// Arrays in, pixels out: a struct of read-only spans, valid during a draw. The renderer knows nothing of
// where they come from.
//
// Units    lengths [m], times [s], tractions [Pa]; the scalar's unit is a text
// Errors   std::runtime_error with one line (no context, a picture beyond the driver's limit)
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/image.hpp"
#include "render/text_box.hpp"

namespace render {

class Context;

// A body's name and its nodes.
struct BodyLabel {
  std::string text;
  int first_node = 0, node_count = 0;
};

// What the colour bar takes of a picture: what its numbers need, or as much for any range from 0 on, so that
// the body lies at the same pixels whatever the range is.
enum class BarRoom { as_needed, fixed };

// What stays the same through a sequence; copied by MeshPicture.
struct MeshLayout {
  std::span<const double> rest;         // n x 2, reference positions
  std::span<const int> triangles;       // m x 3
  std::span<const int> boundary;        // k x 2, interior on the left
  std::span<const int> interfaces{};    // k x 2, where materials meet: a line that stands out from the mesh's
  std::span<const BodyLabel> labels{};  // of several bodies
  std::string letters{};                // that captions of sheets will need
  std::string title;                    // drawn at the top left; may be empty
  std::string scalar_name;              // "|w_lambda|"; empty: no colour, no colour bar
  std::string scalar_unit;              // "Pa m"
  std::array<double, 2> range{0, 1};    // colour range of the whole sequence
  BarRoom bar_room = BarRoom::as_needed;
  std::array<double, 4> bounds{};  // x0, y0, x1, y1: what the camera must show, over the whole motion
  double arrow_scale = 0.0;        // largest |traction| of the sequence [Pa]: gets the longest arrow
};

struct TractionArrow {
  std::array<double, 2> at{};      // a point of the deformed edge
  std::array<double, 2> vector{};  // [Pa]
  friend bool operator==(const TractionArrow&, const TractionArrow&) = default;
};

struct MeshFrame {
  std::span<const double> positions;  // n x 2, deformed
  std::span<const double> scalar;     // n, or empty
  std::span<const int>
      held;  // degrees of freedom 2 node + axis: marked along boundary edges held at both ends
  std::span<const TractionArrow> arrows;  // one per loaded edge
  double time = 0.0;
  std::string_view caption{};  // beside the time on a sheet, cut short where there is no room
};

enum class Shade { light, dark };
enum class Show { no, yes };

// What of the layout may change from frame to frame in a window.
struct MeshView {
  std::array<double, 2> range{0, 1};
  std::array<double, 4> bounds{};
  double arrow_scale = 0.0;
  Shade shade = Shade::light;
  Show mesh_lines = Show::yes;
  Show rest_shape = Show::yes;
  Show node_numbers = Show::no;
  friend bool operator==(const MeshView&, const MeshView&) = default;
};

// Where the plane lies in the picture: pixel = (x, y) -> (at_x + scale x, at_y - scale y), from the top left.
struct PlaneInPicture {
  double at_x = 0, at_y = 0, scale = 1;
  std::array<double, 2> pixel(double x, double y) const { return {at_x + scale * x, at_y - scale * y}; }
  std::array<double, 2> plane(double px, double py) const {
    return {(px - at_x) / scale, (at_y - py) / scale};
  }
};

// Pixels from the picture's top left.
struct PictureArea {
  float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// What frames and sheets have cost so far.
struct PictureCounters {
  std::int64_t frames_drawn = 0;
  std::int64_t frames_repeated = 0;  // alike but for the time in the heading, which alone was drawn
  std::int64_t mesh_uploads = 0;     // of positions and colours; none where neither changed
};

// How many shapes, each with its time, have good room on a sheet of this size.
int sheet_room(int width, int height);

class MeshPicture {
 public:
  // Draws with `context`, which must outlive this; pictures have the context's size.
  MeshPicture(Context& context, const MeshLayout& layout);
  // Of another size than the context's.
  MeshPicture(Context& context, const MeshLayout& layout, int width, int height);
  ~MeshPicture();
  MeshPicture(MeshPicture&&) noexcept;

  // One frame with everything: mesh, outline, rest shape, hatches, arrows, colour bar, title, time. `out` is
  // resized where needed, its memory used again. Of a frame that differs from the last one by its time only,
  // all else is taken from there: the same pixels.
  void draw(const MeshFrame& frame, Image& out);

  // The same, left on the graphics side: for a window, or for read().
  void draw(const MeshFrame& frame);
  void read(Image& out) const;
  // From the next frame on.
  void set_view(const MeshView& view);
  const MeshView& view() const;
  // Of the frames as drawn with the view as it is.
  PlaneInPicture plane() const;
  // What title and colour bar leave to the body.
  PictureArea body_area() const;
  // The framebuffer's name in the context, top row first.
  unsigned framebuffer() const;
  int width() const;
  int height() const;

  // Successive shapes in a grid, each with its time, all at one scale, one colour bar (the paper's Figure 3).
  // Where there are more shapes than sheet_room(), times that would touch each other are left out.
  Image sheet(std::span<const MeshFrame> frames);

  // What is written in the last picture.
  const std::vector<TextBox>& texts() const;

  PictureCounters counters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace render
