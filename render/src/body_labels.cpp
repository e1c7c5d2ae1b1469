#include "body_labels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "theme.hpp"

namespace render {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr Rect nowhere{};

bool is_empty(const Rect& r) {
  return !(r.x1 > r.x0 && r.y1 > r.y0);
}

bool meet(const Rect& a, const Rect& b) {
  return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

bool inside(const Rect& r, const Rect& area) {
  return r.x0 >= area.x0 && r.x1 <= area.x1 && r.y0 >= area.y0 && r.y1 <= area.y1;
}

float distance(const Rect& a, const Rect& b) {
  return std::hypot(std::max({a.x0 - b.x1, b.x0 - a.x1, 0.0f}), std::max({a.y0 - b.y1, b.y0 - a.y1, 0.0f}));
}

// Moved sideways into the area where it is not too wide for it.
float left_end(float middle, float width, const Rect& area) {
  return std::max(area.x0, std::min(middle - width / 2, area.x1 - width));
}

}  // namespace

Rect body_box(const Camera& camera, std::span<const double> positions, const BodyLabel& body) {
  Rect box{infinite, infinite, -infinite, -infinite};
  for (int node = body.first_node; node < body.first_node + body.node_count; ++node) {
    const auto i = 2 * static_cast<std::size_t>(node);
    const Point p = camera.pixel(positions[i], positions[i + 1]);
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
    box = {std::min(box.x0, p.x), std::min(box.y0, p.y), std::max(box.x1, p.x), std::max(box.y1, p.y)};
  }
  return is_empty(box) ? nowhere : box;
}

std::vector<Rect> label_boxes(std::span<const Rect> bodies, std::span<const Point> sizes, float gap,
                              const Rect& area) {
  std::vector<Rect> placed;
  const auto is_free = [&](const Rect& box) {
    return inside(box, area) &&
           std::ranges::none_of(bodies, [&](const Rect& body) { return meet(box, body); }) &&
           std::ranges::none_of(placed, [&](const Rect& other) { return meet(box, other); });
  };
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Rect& body = bodies[k];
    const auto [width, height] = sizes[k];
    if (is_empty(body) || !(width > 0)) {
      placed.push_back(nowhere);
      continue;
    }
    const float x = left_end((body.x0 + body.x1) / 2, width, area);
    const float y = (body.y0 + body.y1 - height) / 2;
    const float right = body.x1 + gap, left = body.x0 - gap - width;
    const std::array<Rect, 4> places{{{x, body.y1 + gap, x + width, body.y1 + gap + height},
                                      {x, body.y0 - gap - height, x + width, body.y0 - gap},
                                      {right, y, right + width, y + height},
                                      {left, y, left + width, y + height}}};
    // Not at another body, whose name it would be taken for; at the sides a little nearer to it will do for
    // that.
    const auto is_its_own = [&](const Rect& box) {
      const float too_near = box.y0 == y ? 1.0f : 0.5f;
      return is_free(box) && std::ranges::none_of(bodies, [&](const Rect& other) {
               return &other != &body && !is_empty(other) &&
                      distance(box, other) < too_near * distance(box, body);
             });
    };
    const auto* const place = std::ranges::find_if(places, is_its_own);
    placed.push_back(place == places.end() ? nowhere : *place);
  }
  return placed;
}

std::string BodyLabels::characters() const {
  std::string all;
  for (const BodyLabel& label : labels_) all += label.text;
  return all;
}

float BodyLabels::room(const Canvas& canvas, TextSize size) const {
  return labels_.empty() ? 0.0f : 1.2f * canvas.text_size(size);
}

std::vector<Rect> BodyLabels::boxes(const Canvas& canvas, const Camera& camera,
                                    std::span<const double> positions, TextSize size, float gap,
                                    const Rect& area) const {
  std::vector<Rect> bodies;
  std::vector<Point> sizes;
  for (const BodyLabel& label : labels_) {
    bodies.push_back(body_box(camera, positions, label));
    const std::string text = canvas.fit(size, label.text, area.width());
    sizes.push_back({canvas.text_width(size, text), canvas.text_size(size)});
  }
  return label_boxes(bodies, sizes, gap, area);
}

void BodyLabels::draw(Canvas& canvas, std::span<const Rect> boxes, TextSize size) const {
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const Rect& box = boxes[k];
    if (is_empty(box)) continue;
    canvas.text({(box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2}, Align::center, size, canvas.palette().ink,
                canvas.fit(size, labels_[k].text, box.width() + 1.0f));
  }
}

}  // namespace render
