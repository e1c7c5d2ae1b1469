#include "camera.hpp"

#include <algorithm>
#include <cmath>

namespace render {
namespace {

constexpr double least_part = 0.2;  // of the area that margins leave for the bounds

// Where `holds` turns from true to false between 0 and `end`, by bisection.
template <class Condition>
double last_true(double end, const Condition& holds) {
  double yes = 0, no = end;
  for (int i = 0; i < 50; ++i) {
    const double middle = (yes + no) / 2;
    (holds(middle) ? yes : no) = middle;
  }
  return yes;
}

}  // namespace

bool near_picture(const Canvas& canvas, Point p) {
  const auto w = static_cast<float>(canvas.width()), h = static_cast<float>(canvas.height());
  return std::isfinite(p.x) && std::isfinite(p.y) && p.x > -w && p.x < 2 * w && p.y > -h && p.y < 2 * h;
}

std::array<double, 4> usable_bounds(std::array<double, 4> b) {
  for (std::size_t k = 0; k < 2; ++k) {
    double& low = b[k];
    double& high = b[k + 2];
    if (!std::isfinite(low) || !std::isfinite(high) || high < low ||
        std::max(std::abs(low), std::abs(high)) > 1e30) {
      low = -0.5;
      high = 0.5;
    }
  }
  const double side = std::max({b[2] - b[0], b[3] - b[1]});
  const double reach = std::max(std::abs(b[0]), std::abs(b[1]));
  const double size = side > 0 ? side : reach > 0 ? 1e-3 * reach : 1;
  for (std::size_t k = 0; k < 2; ++k) {
    if (b[k + 2] - b[k] < 1e-6 * size) {
      const double middle = (b[k] + b[k + 2]) / 2;
      b[k] = middle - size / 20;
      b[k + 2] = middle + size / 20;
    }
  }
  return b;
}

void Framing::Side::add(const Reach& reach) {
  const auto behind = [](const Reach& a, const Reach& b) { return a.at <= b.at && a.margin <= b.margin; };
  if (std::ranges::any_of(reaches_, [&](const Reach& known) { return behind(reach, known); })) return;
  std::erase_if(reaches_, [&](const Reach& known) { return behind(known, reach); });
  reaches_.push_back(reach);
}

double Framing::Side::pixels(double scale, double cut) const {
  double end = 0;
  for (const Reach& reach : reaches_) end = std::max(end, scale * reach.at + cut * reach.margin);
  return end;
}

Framing::Framing(const std::array<double, 4>& bounds, const Margins& margins)
    : bounds_(usable_bounds(bounds)), x0_((bounds_[0] + bounds_[2]) / 2), y0_((bounds_[1] + bounds_[3]) / 2) {
  add(bounds_[0], bounds_[1], margins);
  add(bounds_[2], bounds_[3], margins);
}

void Framing::add(double x, double y, const Margins& margins) {
  if (!(x >= bounds_[0] && x <= bounds_[2] && y >= bounds_[1] && y <= bounds_[3])) return;
  left_.add({x0_ - x, margins.left});
  right_.add({x - x0_, margins.right});
  bottom_.add({y0_ - y, margins.bottom});
  top_.add({y - y0_, margins.top});
}

Framing::Axis Framing::fit(const Side& low, const Side& high, double extent, double length) {
  const auto needed = [&](double scale, double cut) {
    return low.pixels(scale, cut) + high.pixels(scale, cut);
  };
  const double least = least_part * length / extent;
  if (needed(least, 1) > length)
    return {least, last_true(1, [&](double cut) { return needed(least, cut) <= length; })};
  return {last_true(length / extent, [&](double scale) { return needed(scale, 1) <= length; }), 1};
}

std::array<Framing::Axis, 2> Framing::axes(const Rect& area) const {
  return {fit(left_, right_, bounds_[2] - bounds_[0], std::max(area.width(), 1.0f)),
          fit(bottom_, top_, bounds_[3] - bounds_[1], std::max(area.height(), 1.0f))};
}

Camera Framing::fit(const Rect& area) const {
  const auto [x, y] = axes(area);
  const double s = std::min(x.scale, y.scale);
  Camera camera;
  camera.x0 = x0_;
  camera.y0 = y0_;
  camera.scale = s;
  camera.pixel_x = (area.x0 + area.x1 + left_.pixels(s, x.cut) - right_.pixels(s, x.cut)) / 2;
  camera.pixel_y = (area.y0 + area.y1 + top_.pixels(s, y.cut) - bottom_.pixels(s, y.cut)) / 2;
  return camera;
}

Rect Framing::covered(const Camera& camera, const Rect& area) const {
  const auto [x, y] = axes(area);
  const double s = camera.scale;
  return {static_cast<float>(camera.pixel_x - left_.pixels(s, x.cut)),
          static_cast<float>(camera.pixel_y - top_.pixels(s, y.cut)),
          static_cast<float>(camera.pixel_x + right_.pixels(s, x.cut)),
          static_cast<float>(camera.pixel_y + bottom_.pixels(s, y.cut))};
}

}  // namespace render
