#include "view/picture.hpp"

#include <algorithm>
#include <cmath>

#include "body_labels.hpp"
#include "flat_rows.hpp"
#include "node_scalars.hpp"
#include "scene_parts.hpp"

namespace app::view {
namespace {

constexpr double room_about = 0.18;  // of the body's larger side: to be pulled into

// The next of few steps, so that a scale that grows does not flicker.
double rounded_up(double x) {
  if (!(x > 0.0) || !std::isfinite(x)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (step * power >= x) return step * power;
  return 10.0 * power;
}

}  // namespace

PictureStyle style_of(const rheo::PictureSettings& picture) {
  PictureStyle style;
  style.color = picture.color;
  if (!picture.range_auto) {
    style.range_mode = RangeMode::typed;
    style.typed = picture.range;
  }
  return style;
}

void Picture::find_scalar(const Display& display, rheo::ColorBy color) {
  switch (color) {
    case rheo::ColorBy::w_lambda:
      scalar_ = display.w_lambda;
      return;
    case rheo::ColorBy::w_mu:
      scalar_ = display.w_mu;
      return;
    case rheo::ColorBy::speed:
      scalar_ = display.speed;
      return;
    case rheo::ColorBy::w:
      scalar_.resize(display.w_lambda.size());
      for (std::size_t i = 0; i < scalar_.size(); ++i)
        scalar_[i] = std::hypot(display.w_lambda[i], display.w_mu[i]);
      return;
    case rheo::ColorBy::none:
      scalar_.clear();
      return;
  }
}

void Picture::find_range(const Display& display, const PictureStyle& style) {
  if (display.t < last_t_) largest_ = 0.0, arrow_scale_ = 0.0;
  last_t_ = display.t;
  for (const double value : scalar_)
    if (std::isfinite(value)) largest_ = std::max(largest_, value);
  if (style.range_mode == RangeMode::typed)
    range_ = style.typed;
  else if (style.range_mode == RangeMode::automatic)
    range_ = {0.0, rounded_up(largest_)};
}

// Of the body, now and at rest.
std::array<double, 4> Picture::extent(const Display& display) {
  std::array<double, 4> b{rheo::forever, rheo::forever, -rheo::forever, -rheo::forever};
  const auto see = [&](double x, double y) {
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    b = {std::min(b[0], x), std::min(b[1], y), std::max(b[2], x), std::max(b[3], y)};
  };
  for (const rheo::Vec2& p : display.scene->mesh.points) see(p.x, p.y);
  for (std::size_t i = 0; i + 1 < display.positions.size(); i += 2)
    see(display.positions[i], display.positions[i + 1]);
  return b;
}

void Picture::fit_bounds(const Display& display) {
  const std::array<double, 4> b = extent(display);
  body_size_ = std::max(b[2] - b[0], b[3] - b[1]);
  const double room = room_about * body_size_;
  bounds_ = {b[0] - room, b[1] - room, b[2] + room, b[3] + room};
}

// In few jumps rather than with every frame.
void Picture::follow(const Display& display) {
  const std::array<double, 4> b = extent(display);
  const double room = room_about * std::max(bounds_[2] - bounds_[0], bounds_[3] - bounds_[1]);
  const double most = 20.0 * room;
  for (std::size_t k = 0; k < 2; ++k) {
    if (b[k] < bounds_[k]) bounds_[k] = std::max(b[k] - room, bounds_[k] - most);
    if (b[k + 2] > bounds_[k + 2]) bounds_[k + 2] = std::min(b[k + 2] + room, bounds_[k + 2] + most);
  }
}

void Picture::build(const Display& display, const PictureStyle& style, int width, int height) {
  const rheo::Scene& scene = *display.scene;
  const std::vector<double> rest = flat(scene.mesh.points);
  const std::vector<int> triangles = flat_numbers(scene.mesh.triangles);
  const std::vector<int> boundary = flat_numbers(scene.mesh.edge_groups.at("boundary"));
  const std::vector<int> interfaces = interfaces_of(scene);
  const std::vector<render::BodyLabel> labels = body_labels(scene);
  const ScalarText scalar = scalar_text(style.color, scene.picture.branch);
  picture_.reset();
  picture_ = std::make_unique<render::MeshPicture>(context_,
                                                   render::MeshLayout{.rest = rest,
                                                                      .triangles = triangles,
                                                                      .boundary = boundary,
                                                                      .interfaces = interfaces,
                                                                      .labels = labels,
                                                                      .title = scene.title,
                                                                      .scalar_name = scalar.name,
                                                                      .scalar_unit = scalar.unit,
                                                                      .range = range_,
                                                                      .bar_room = render::BarRoom::fixed,
                                                                      .bounds = bounds_,
                                                                      .arrow_scale = arrow_scale()},
                                                   width, height);
}

void Picture::draw(const Display& display, const PictureStyle& style, int width, int height) {
  if (display.body != body_) {
    fit_ = true;
    largest_ = arrow_scale_ = 0.0;
    if (display.scene->picture.bounds) set_bounds(*display.scene->picture.bounds);
  }
  if (style.color != color_) largest_ = 0.0;
  if (fit_)
    fit_bounds(display);
  else if (follows_ && display.hand.hold == Hold::nothing)
    follow(display);  // not under a hand: what it drags by would move away
  fit_ = false;
  find_scalar(display, style.color);
  find_range(display, style);
  if (!picture_ || display.body != body_ || style.color != color_ || picture_->width() != width ||
      picture_->height() != height)
    build(display, style, width, height);
  if (display.scene != scene_) loaded_ = std::make_unique<LoadedEdges>(*display.scene);
  scene_ = display.scene;
  body_ = display.body;
  color_ = style.color;

  arrows_ = loaded_->arrows(display.tractions, display.positions);
  const rheo::Vec2 p = display.hand.traction;
  if (p.x != 0.0 || p.y != 0.0)
    for (const rheo::Edge& edge : display.hand.edges)
      arrows_.push_back(arrow_on(edge, {p.x, p.y}, display.positions));
  double largest = 0.0;
  for (const render::TractionArrow& arrow : arrows_)
    largest = std::max(largest, std::hypot(arrow.vector[0], arrow.vector[1]));
  if (largest > arrow_scale_) arrow_scale_ = rounded_up(largest);

  const auto shown = [](bool yes) { return yes ? render::Show::yes : render::Show::no; };
  picture_->set_view({.range = range_,
                      .bounds = bounds_,
                      .arrow_scale = arrow_scale(),
                      .shade = style.dark ? render::Shade::dark : render::Shade::light,
                      .mesh_lines = shown(style.mesh_lines),
                      .rest_shape = shown(style.rest_shape),
                      .node_numbers = shown(style.node_numbers)});
  plane_ = picture_->plane();
  picture_->draw({.positions = display.positions,
                  .scalar = scalar_,
                  .held = display.held,
                  .arrows = arrows_,
                  .time = display.t});
}

void Picture::pan(double pixels_x, double pixels_y) {
  if (pixels_x != 0.0 || pixels_y != 0.0) follows_ = false;
  const double dx = pixels_x / plane_.scale, dy = -pixels_y / plane_.scale;
  bounds_ = {bounds_[0] - dx, bounds_[1] - dy, bounds_[2] - dx, bounds_[3] - dy};
}

void Picture::zoom(double factor, double pixel_x, double pixel_y) {
  follows_ = false;
  const double width = (bounds_[2] - bounds_[0]) / factor;
  constexpr double closest = 1e-6, farthest = 1e4;  // in sizes of the body
  const double size = body_size_ > 0.0 ? body_size_ : bounds_[2] - bounds_[0];
  if (!(width > closest * size) || !(width < farthest * size)) return;
  const auto [x, y] = plane_.plane(pixel_x, pixel_y);
  bounds_ = {x + (bounds_[0] - x) / factor, y + (bounds_[1] - y) / factor, x + (bounds_[2] - x) / factor,
             y + (bounds_[3] - y) / factor};
}

}  // namespace app::view
