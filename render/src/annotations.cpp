#include "annotations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "colormap.hpp"
#include "theme.hpp"
#include "ticks.hpp"

namespace render {
namespace {

bool finite(Point p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}

Point node_pixel(const Camera& camera, std::span<const double> positions, int node) {
  const auto i = 2 * static_cast<std::size_t>(node);
  return camera.pixel(positions[i], positions[i + 1]);
}

bool near_picture(const Canvas& canvas, Point p) {
  const auto w = static_cast<float>(canvas.width()), h = static_cast<float>(canvas.height());
  return finite(p) && p.x > -w && p.x < 2 * w && p.y > -h && p.y < 2 * h;
}

}  // namespace

namespace {

// A run of held edges as points in the picture, and the strokes along it.
class HatchedRun {
 public:
  void add(Point p) {
    if (points_.empty()) points_.push_back(p);
    const Point q = points_.back();
    const float size = std::hypot(p.x - q.x, p.y - q.y);
    if (size < 1e-3f) return;  // not worth a direction; its length counts with the next one
    points_.push_back(p);
    length_ += size;
  }

  // As many strokes as suit the spacing best, the first and the last one half a step from the ends.
  void draw(Canvas& canvas) const {
    if (points_.size() < 2) return;
    const float reach = 9 * canvas.unit(), width = std::max(1.0f, 1.3f * canvas.unit());
    const float step = length_ / std::max(1.0f, std::round(length_ / (9 * canvas.unit())));
    float next = step / 2;  // of the next stroke, from the start of the segment
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const Point a = points_[i - 1], b = points_[i];
      const float dx = b.x - a.x, dy = b.y - a.y, size = std::hypot(dx, dy);
      const float tx = dx / size, ty = dy / size;
      const float nx = -ty, ny = tx;  // outward: the interior is on the left, and pixels count downwards
      for (; next < size; next += step) {
        const Point from{a.x + tx * next, a.y + ty * next};
        const Point to{from.x + (nx - tx) * 0.72f * reach, from.y + (ny - ty) * 0.72f * reach};
        canvas.line(from, to, theme::soft_ink, width);
      }
      next -= size;
    }
  }

 private:
  std::vector<Point> points_;
  float length_ = 0;
};

}  // namespace

void draw_hatches(Canvas& canvas, const Camera& camera, const BoundaryChains& boundary,
                  std::span<const double> positions, std::span<const int> held, std::vector<char>& mark) {
  if (held.empty()) return;
  enum : char { free_node, held_node, hatched_node };
  mark.assign(positions.size() / 2, free_node);
  for (const int node : held) mark[static_cast<std::size_t>(node)] = held_node;

  const auto is_held = [&](std::size_t e) {
    for (const int node : {boundary.edges[2 * e], boundary.edges[2 * e + 1]}) {
      if (mark[static_cast<std::size_t>(node)] == free_node ||
          !near_picture(canvas, node_pixel(camera, positions, node)))
        return false;
    }
    return true;
  };
  for (std::size_t chain = 0; chain < boundary.count(); ++chain) {
    const std::size_t begin = boundary.offsets[chain], size = boundary.size(chain);
    std::size_t first = 0;  // a run that goes on beyond a loop's first edge is not to be cut there
    if (boundary.closed(chain)) {
      while (first < size && is_held(begin + first)) ++first;
    }
    HatchedRun run;
    for (std::size_t k = 0; k < size; ++k) {
      const std::size_t e = begin + (first + k) % size;
      if (!is_held(e)) {
        run.draw(canvas);
        run = {};
        continue;
      }
      for (const int node : {boundary.edges[2 * e], boundary.edges[2 * e + 1]}) {
        run.add(node_pixel(camera, positions, node));
        mark[static_cast<std::size_t>(node)] = hatched_node;
      }
    }
    run.draw(canvas);
  }
  const float radius = 4 * canvas.unit();
  for (const int node : held) {
    if (mark[static_cast<std::size_t>(node)] != held_node) continue;
    const Point p = node_pixel(camera, positions, node);
    if (near_picture(canvas, p)) canvas.disk(p, radius, theme::ink);
  }
}

namespace {

double largest_traction(std::span<const TractionArrow> arrows) {
  double largest = 0;
  for (const TractionArrow& arrow : arrows) {
    const double size = std::hypot(arrow.vector[0], arrow.vector[1]);
    if (std::isfinite(size)) largest = std::max(largest, size);
  }
  return largest;
}

double usable_scale(double scale, double largest) {
  return scale > 0 && std::isfinite(scale) ? scale : largest;
}

// Too weak to be seen, or no number.
bool is_drawn(const TractionArrow& arrow, double scale) {
  const double size = std::hypot(arrow.vector[0], arrow.vector[1]);
  return size > 1e-3 * scale && std::isfinite(size) && std::isfinite(arrow.at[0]) &&
         std::isfinite(arrow.at[1]);
}

float head_length(float length, float unit) {
  return std::min(11 * unit, 0.55f * length);
}

float head_half_width(float length, float unit) {
  return 0.42f * head_length(length, unit);
}

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

}  // namespace

TractionArrows::TractionArrows(std::vector<int> boundary, std::span<const int> triangles,
                               std::vector<double> rest)
    : boundary_(std::move(boundary)), opposite_(boundary_.size() / 2, -1), rest_(std::move(rest)) {
  std::map<std::pair<int, int>, std::size_t> edges;  // by their nodes, the smaller one first
  std::vector<char> outside(rest_.size() / 2, 0);
  for (std::size_t e = 0; e < opposite_.size(); ++e) {
    const int a = boundary_[2 * e], b = boundary_[2 * e + 1];
    edges.try_emplace(std::minmax(a, b), e);
    outside[static_cast<std::size_t>(a)] = outside[static_cast<std::size_t>(b)] = 1;
  }
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = triangles[t + k], b = triangles[t + (k + 1) % 3];
      if (!outside[static_cast<std::size_t>(a)] || !outside[static_cast<std::size_t>(b)]) continue;
      const auto edge = edges.find(std::minmax(a, b));
      if (edge != edges.end()) opposite_[edge->second] = triangles[t + (k + 2) % 3];
    }
  }
}

// The outward normal of the boundary edge that the arrow stands on, the nearest one by its middle: the normal
// at rest, turned as the edge's triangle has turned. (The deformed edge's own normal would change sides where
// a body turns inside out.) With x = F X over the triangle the nearest rotation to F has the angle
//
//   atan2(F_yx - F_xy, F_xx + F_yy)
std::array<double, 2> TractionArrows::outward_normal(const MeshFrame& frame, std::size_t k) {
  const std::span<const double> positions = frame.positions;
  const TractionArrow& arrow = frame.arrows[k];
  const auto ends = [&](std::span<const double> points, std::size_t e) {
    const auto a = 2 * static_cast<std::size_t>(boundary_[2 * e]);
    const auto b = 2 * static_cast<std::size_t>(boundary_[2 * e + 1]);
    return std::array<double, 4>{points[a], points[a + 1], points[b], points[b + 1]};
  };
  // Squared distance from the arrow's foot to the edge's middle, in units of the edge's squared length.
  const auto misfit = [&](std::size_t e) {
    const auto [ax, ay, bx, by] = ends(positions, e);
    const double x = (ax + bx) / 2 - arrow.at[0], y = (ay + by) / 2 - arrow.at[1];
    const double size = (bx - ax) * (bx - ax) + (by - ay) * (by - ay);
    return (x * x + y * y) / std::max(size, std::numeric_limits<double>::min());
  };
  const std::size_t count = boundary_.size() / 2;
  if (count == 0) return {0, 0};
  if (edge_[k] >= count || !(misfit(edge_[k]) < 1e-12)) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < count; ++e) {
      const auto [ax, ay, bx, by] = ends(positions, e);
      const double x = (ax + bx) / 2 - arrow.at[0], y = (ay + by) / 2 - arrow.at[1];
      if (!(x * x + y * y < least)) continue;
      least = x * x + y * y;
      edge_[k] = e;
    }
  }
  if (edge_[k] >= count) return {0, 0};
  const auto [ax, ay, bx, by] = ends(rest_, edge_[k]);
  const double size = std::hypot(bx - ax, by - ay);
  if (!(size > 0)) return {0, 0};
  const double nx = (by - ay) / size, ny = -(bx - ax) / size;
  if (opposite_[edge_[k]] < 0) return {nx, ny};

  // Columns: the edge, and from its start to the third node; d deformed, r at rest. F = d r^-1.
  const auto columns = [&](std::span<const double> points) {
    const auto [x, y, x1, y1] = ends(points, edge_[k]);
    const auto c = 2 * static_cast<std::size_t>(opposite_[edge_[k]]);
    return std::array<double, 4>{x1 - x, y1 - y, points[c] - x, points[c + 1] - y};
  };
  const auto r = columns(rest_), d = columns(positions);
  const double area = r[0] * r[3] - r[1] * r[2];
  if (!((d[0] * d[3] - d[1] * d[2]) * area > 0)) return {nx, ny};  // turned inside out, or no numbers
  const double xx = (d[0] * r[3] - d[2] * r[1]) / area, xy = (d[2] * r[0] - d[0] * r[2]) / area;
  const double yx = (d[1] * r[3] - d[3] * r[1]) / area, yy = (d[3] * r[0] - d[1] * r[2]) / area;
  const double angle = std::atan2(yx - xy, xx + yy), c = std::cos(angle), s = std::sin(angle);
  return {c * nx - s * ny, s * nx + c * ny};
}

TractionArrows::Shape TractionArrows::shape(const MeshFrame& frame, std::size_t k, double scale,
                                            float longest, float unit) {
  const TractionArrow& arrow = frame.arrows[k];
  edge_.resize(std::max(edge_.size(), frame.arrows.size()), std::numeric_limits<std::size_t>::max());
  const double size = std::hypot(arrow.vector[0], arrow.vector[1]);
  const float length = std::max(longest * static_cast<float>(std::min(size / scale, 1.5)), 9 * unit);
  const float ux = static_cast<float>(arrow.vector[0] / size),
              uy = static_cast<float>(-arrow.vector[1] / size);
  const std::array<double, 2> normal = outward_normal(frame, k);
  Shape s;
  s.presses = normal[0] * arrow.vector[0] + normal[1] * arrow.vector[1] < -0.1 * size;
  const float gap = 2.5f * unit;  // clear of the outline
  const float tip = s.presses ? -gap : length + gap;
  s.tip = {ux * tip, uy * tip};
  s.tail = {ux * (tip - length), uy * (tip - length)};
  return s;
}

void TractionArrows::add_to(Framing& framing, const Canvas& canvas, const MeshFrame& frame, double scale,
                            float longest) {
  scale = usable_scale(scale, largest_traction(frame.arrows));
  for (std::size_t k = 0; k < frame.arrows.size(); ++k) {
    const TractionArrow& arrow = frame.arrows[k];
    if (!is_drawn(arrow, scale)) continue;
    const Point end = shape(frame, k, scale, longest, canvas.unit()).outer();
    const float side = head_half_width(longest, canvas.unit()) + 2 * canvas.unit();
    const auto reach = [side](float pixels) { return std::max(pixels, 0.0f) + side; };
    framing.add(arrow.at[0], arrow.at[1], {reach(-end.x), reach(-end.y), reach(end.x), reach(end.y)});
  }
}

void TractionArrows::draw(Canvas& canvas, const Camera& camera, const MeshFrame& frame, double scale,
                          float longest, const Rect& value_area) {
  const double largest = largest_traction(frame.arrows);
  if (!(largest > 0)) return;
  scale = usable_scale(scale, largest);

  const float unit = canvas.unit(), width = std::max(1.6f, 2.4f * unit);
  const float apart = 9 * unit;
  std::vector<Point> feet;
  struct Drawn {
    Point outer;
    Point away;  // from the body
  };
  std::vector<Drawn> strongest;
  struct Segment {
    Point from, to;
    float half_width;
  };
  std::vector<Segment> shafts;                                                     // of all that is drawn
  float left = std::numeric_limits<float>::infinity(), right = -left, top = left;  // what the strongest cover
  for (std::size_t k = 0; k < frame.arrows.size(); ++k) {
    const TractionArrow& arrow = frame.arrows[k];
    const Point foot = camera.pixel(arrow.at[0], arrow.at[1]);
    if (!is_drawn(arrow, scale) || !near_picture(canvas, foot)) continue;
    const bool close = std::any_of(feet.begin(), feet.end(),
                                   [&](Point p) { return std::hypot(p.x - foot.x, p.y - foot.y) < apart; });
    if (close) continue;
    feet.push_back(foot);
    const Shape about = shape(frame, k, scale, longest, unit);
    const Point tail{foot.x + about.tail.x, foot.y + about.tail.y};
    const Point tip{foot.x + about.tip.x, foot.y + about.tip.y};
    const float length = std::hypot(tip.x - tail.x, tip.y - tail.y);
    const float ux = (tip.x - tail.x) / length, uy = (tip.y - tail.y) / length;
    const float head = head_length(length, unit), half = head_half_width(length, unit);
    const Point neck{tip.x - ux * head, tip.y - uy * head};
    canvas.line(tail, {tip.x - ux * head * 0.8f, tip.y - uy * head * 0.8f}, theme::force, width);
    canvas.triangle(tip, {neck.x - uy * half, neck.y + ux * half}, {neck.x + uy * half, neck.y - ux * half},
                    theme::force);
    shafts.push_back({tail, tip, std::max(half, width / 2)});
    const double size = std::hypot(arrow.vector[0], arrow.vector[1]);
    if (size < (1 - 1e-9) * largest) continue;
    strongest.push_back({about.presses ? tail : tip, about.presses ? Point{-ux, -uy} : Point{ux, uy}});
    left = std::min({left, tail.x, tip.x});
    right = std::max({right, tail.x, tip.x});
    top = std::min({top, tail.y - half, tip.y - half});
  }
  if (strongest.empty() || value_area.width() <= 0) return;

  // The value beyond the middle one of the largest arrows, farther out while it would stand on an arrow;
  // above all arrows where that is outside of the area.
  const Drawn& chosen = strongest[strongest.size() / 2];
  const std::string value = with_unit(largest, "Pa");
  const float text = canvas.text_size(TextSize::small), w = canvas.text_width(TextSize::small, value);
  const auto on_an_arrow = [&](Point p) {
    return std::ranges::any_of(shafts, [&](const Segment& s) {
      const float x = w / 2 + 0.2f * text + s.half_width, y = 0.55f * text + s.half_width;
      return meets(s.from, s.to, {p.x - x, p.y - y, p.x + x, p.y + y});
    });
  };
  const auto inside = [&](Point p) {
    return p.x >= value_area.x0 + w / 2 && p.x <= value_area.x1 - w / 2 && p.y >= value_area.y0 &&
           p.y <= value_area.y1;
  };
  Point at{chosen.outer.x + chosen.away.x * (w / 2 + 0.5f * text),
           chosen.outer.y + chosen.away.y * 0.8f * text};
  while (inside(at) && on_an_arrow(at)) {
    at.x += 0.25f * text * chosen.away.x;
    at.y += 0.25f * text * chosen.away.y;
  }
  if (!inside(at)) {
    at = {(left + right) / 2, top - 0.9f * text};
    for (const Segment& s : shafts) {  // weaker ones too
      const Rect column{at.x - w / 2 - s.half_width, value_area.y0, at.x + w / 2 + s.half_width,
                        value_area.y1};
      if (meets(s.from, s.to, column))
        at.y = std::min(at.y, std::min(s.from.y, s.to.y) - s.half_width - 0.9f * text);
    }
  }
  const float x =
      std::clamp(at.x, value_area.x0 + w / 2, std::max(value_area.x1 - w / 2, value_area.x0 + w / 2));
  const float y = std::clamp(at.y, value_area.y0 + text / 2,
                             std::max(value_area.y1 - text / 2, value_area.y0 + text / 2));
  Color halo = theme::paper;
  halo.a = 215;
  canvas.rect({x - w / 2 - 0.2f * text, y - 0.55f * text, x + w / 2 + 0.2f * text, y + 0.55f * text}, halo,
              0.25f * text);
  canvas.text({x, y}, Align::center, TextSize::small, theme::force, value);
}

namespace {

// The bar's numbers: none without a finite range, one for a single value.
Ticks bar_ticks(const ColorBar& bar, int most) {
  const auto [low, high] = bar.range;
  if (std::isfinite(low) && low == high) return {{low}, {fmt::format("{:.3g}", low)}, {}, 0};
  return linear_ticks(low, high, most);
}

std::string bar_unit(const ColorBar& bar, const Ticks& ticks) {
  if (ticks.exponent == 0) return bar.unit;
  return fmt::format("10^{} {}", ticks.exponent, bar.unit);
}

int bar_tick_count(const Canvas& canvas, float height) {
  return std::clamp(static_cast<int>(height / (2.2f * canvas.text_size(TextSize::small))), 2, 9);
}

}  // namespace

float color_bar_width(const Canvas& canvas, const ColorBar& bar) {
  const float text = canvas.text_size(TextSize::small);
  const Ticks ticks = bar_ticks(bar, bar_tick_count(canvas, 0.7f * static_cast<float>(canvas.height())));
  float numbers = 0;
  for (const std::string& s : ticks.labels)
    numbers = std::max(numbers, canvas.text_width(TextSize::small, s));
  const float name = std::max(canvas.label_width(TextSize::normal, bar.name),
                              canvas.label_width(TextSize::small, bar_unit(bar, ticks)));
  return std::max(1.6f * text + numbers, name);
}

void draw_color_bar(Canvas& canvas, const ColorBar& bar, const Rect& area) {
  const float text = canvas.text_size(TextSize::small), normal = canvas.text_size(TextSize::normal);
  const Rect strip{std::round(area.x0), std::round(area.y0 + normal + 1.6f * text),
                   std::round(area.x0 + 0.9f * text), std::round(area.y1)};
  const Ticks ticks = bar_ticks(bar, bar_tick_count(canvas, strip.height()));
  canvas.label({area.x0, area.y0 + 0.5f * normal}, Align::left, TextSize::normal, theme::ink, bar.name);
  canvas.label({area.x0, area.y0 + normal + 0.6f * text}, Align::left, TextSize::small, theme::soft_ink,
               bar_unit(bar, ticks));
  if (strip.height() < 2) return;

  const std::array<Rgb, 256> map = make_colormap();
  const auto color = [&map](std::size_t i) { return Color{map[i][0], map[i][1], map[i][2]}; };
  const bool spread = bar.range[1] > bar.range[0];
  constexpr std::size_t slices = 64;
  for (std::size_t i = 0; i < slices; ++i) {
    const auto edge = [&](std::size_t k) {
      return std::round(strip.y1 - strip.height() * static_cast<float>(k) / static_cast<float>(slices));
    };
    const std::size_t below = spread ? i * 255 / slices : 0, above = spread ? (i + 1) * 255 / slices : 0;
    canvas.gradient({strip.x0, edge(i + 1), strip.x1, edge(i)}, color(above), color(below));
  }
  canvas.frame(strip, theme::ink, std::max(1.0f, canvas.unit()));
  for (std::size_t i = 0; i < ticks.at.size(); ++i) {
    const double t = spread ? (ticks.at[i] - bar.range[0]) / (bar.range[1] - bar.range[0]) : 0.0;
    const float y = std::round(strip.y1 - strip.height() * static_cast<float>(t));
    canvas.line({strip.x1, y}, {strip.x1 + 0.3f * text, y}, theme::ink, std::max(1.0f, canvas.unit()));
    canvas.text({strip.x1 + 0.5f * text, y}, Align::left, TextSize::small, theme::ink, ticks.labels[i]);
  }
}

}  // namespace render
