// The body of a Display as the same picture that `rheo render` draws, at any place and scale.
//
// Units    pixels from the picture's top left; lengths [m]
// Errors   std::runtime_error of the renderer
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "loaded_edges.hpp"
#include "render/mesh_picture.hpp"
#include "view/display.hpp"

namespace app::view {

enum class RangeMode { automatic, held, typed };

struct PictureStyle {
  rheo::ColorBy color = rheo::ColorBy::w_lambda;
  RangeMode range_mode = RangeMode::automatic;
  std::array<double, 2> typed{0.0, 1.0};
  bool mesh_lines = true, rest_shape = true, node_numbers = false, dark = false;
};

// As a scene asks for it.
PictureStyle style_of(const rheo::PictureSettings& picture);

class Picture {
 public:
  explicit Picture(render::Context& context) : context_(context) {}

  // Draws; width and height as long as they are at least the renderer's smallest.
  void draw(const Display& display, const PictureStyle& style, int width, int height);
  const render::MeshPicture& mesh_picture() const { return *picture_; }
  void read(render::Image& out) const { picture_->read(out); }

  // The whole body, as it is now and at rest, from the next draw on; the view grows with the body until
  // somebody pans or zooms.
  void fit() { fit_ = follows_ = true; }
  void pan(double pixels_x, double pixels_y);
  void zoom(double factor, double pixel_x, double pixel_y);
  void set_bounds(const std::array<double, 4>& bounds) {
    bounds_ = bounds;
    fit_ = follows_ = false;
  }
  const std::array<double, 4>& bounds() const { return bounds_; }
  const std::array<double, 2>& range() const { return range_; }
  // Of the longest arrow [Pa]. Never 0: the room that arrows take is left from the beginning, for a first
  // push must not move the picture.
  double arrow_scale() const { return arrow_scale_ > 0.0 ? arrow_scale_ : 1.0; }
  const render::PlaneInPicture& plane() const { return plane_; }

 private:
  void build(const Display& display, const PictureStyle& style, int width, int height);
  void find_scalar(const Display& display, rheo::ColorBy color);
  void find_range(const Display& display, const PictureStyle& style);
  static std::array<double, 4> extent(const Display& display);
  void fit_bounds(const Display& display);
  void follow(const Display& display);

  render::Context& context_;
  std::unique_ptr<render::MeshPicture> picture_;
  std::unique_ptr<LoadedEdges> loaded_;
  std::shared_ptr<const rheo::Scene> scene_;  // that loaded_ is of
  std::int64_t body_ = -1;
  rheo::ColorBy color_ = rheo::ColorBy::none;

  std::array<double, 4> bounds_{};
  double body_size_ = 0.0;  // when it was fitted [m]
  bool fit_ = true, follows_ = true;
  std::array<double, 2> range_{0.0, 1.0};
  double largest_ = 0.0;  // of the scalar, since t = 0
  double last_t_ = 0.0;
  double arrow_scale_ = 0.0;
  render::PlaneInPicture plane_;
  std::vector<double> scalar_;
  std::vector<render::TractionArrow> arrows_;
};

}  // namespace app::view
