#include "label_place.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace render {
namespace {

// Whether the segment from `a` to `b` meets the rectangle: what the rectangle's two pairs of sides leave of
// it is not empty.
bool meets(Point a, Point b, const Rect& r) {
  float from = 0, to = 1;
  const auto cut = [&](float start, float step, float low, float high) {
    if (step == 0) {
      if (start < low || start > high) to = -1;
      return;
    }
    const auto [first, last] = std::minmax({(low - start) / step, (high - start) / step});
    from = std::max(from, first);
    to = std::min(to, last);
  };
  cut(a.x, b.x - a.x, r.x0, r.x1);
  cut(a.y, b.y - a.y, r.y0, r.y1);
  return from <= to;
}

bool meets_any(std::span<const Stroke> strokes, const Rect& r) {
  return std::ranges::any_of(strokes, [&](const Stroke& s) {
    const float w = s.half_width;
    return meets(s.from, s.to, {r.x0 - w, r.y0 - w, r.x1 + w, r.y1 + w});
  });
}

bool is_inside(Point p, std::span<const Stroke> outline) {
  bool inside = false;
  for (const Stroke& s : outline) {
    if ((s.from.y > p.y) == (s.to.y > p.y)) continue;
    const float x = s.from.x + (p.y - s.from.y) / (s.to.y - s.from.y) * (s.to.x - s.from.x);
    if (x > p.x) inside = !inside;
  }
  return inside;
}

}  // namespace

Point free_place(Point wanted, float width, float height, const Rect& area, std::span<const Stroke> strokes,
                 std::span<const Stroke> outline) {
  const float x0 = area.x0 + width / 2, x1 = std::max(area.x1 - width / 2, x0);
  const float y0 = area.y0 + height / 2, y1 = std::max(area.y1 - height / 2, y0);
  const auto box = [&](Point p) {
    return Rect{p.x - width / 2, p.y - height / 2, p.x + width / 2, p.y + height / 2};
  };
  const float step = 0.35f * height;
  constexpr int rings = 60;

  // Square rings of growing size: what is found is at most 1.42 times as far as the nearest.
  const auto nearest = [&](const auto& is_free) -> std::optional<Point> {
    for (int r = 0; r <= rings; ++r) {
      std::optional<Point> best;
      float least = 0;
      for (int i = -r; i <= r; ++i) {
        for (int j = -r; j <= r; j += std::abs(i) == r ? 1 : 2 * r) {
          const Point p{wanted.x + static_cast<float>(i) * step, wanted.y + static_cast<float>(j) * step};
          const Point q{std::clamp(p.x, x0, x1), std::clamp(p.y, y0, y1)};
          // What the area cuts off is looked at once, where it comes into the area.
          if (std::abs(q.x - p.x) >= step || std::abs(q.y - p.y) >= step) continue;
          const float distance = std::hypot(q.x - wanted.x, q.y - wanted.y);
          if ((best && distance >= least) || !is_free(q)) continue;
          best = q;
          least = distance;
        }
      }
      if (best) return best;
    }
    return std::nullopt;
  };
  const auto off_strokes = [&](Point p) { return !meets_any(strokes, box(p)); };
  const auto off_all = [&](Point p) {
    return off_strokes(p) && !meets_any(outline, box(p)) && !is_inside(p, outline);
  };
  const Point clamped{std::clamp(wanted.x, x0, x1), std::clamp(wanted.y, y0, y1)};
  if (const auto place = nearest(off_all)) return *place;
  return nearest(off_strokes).value_or(clamped);
}

}  // namespace render
