#include "annotations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

void draw_hatches(Canvas& canvas, const Camera& camera, std::span<const int> boundary,
                  std::span<const double> positions, std::span<const int> held, std::vector<char>& mark) {
  if (held.empty()) return;
  enum : char { free_node, held_node, hatched_node };
  mark.assign(positions.size() / 2, free_node);
  for (const int node : held) mark[static_cast<std::size_t>(node)] = held_node;

  const float spacing = 9 * canvas.unit(), reach = 9 * canvas.unit(),
              width = std::max(1.0f, 1.3f * canvas.unit());
  float phase = spacing / 2;  // of the next stroke along the edge, carried over from edge to edge
  for (std::size_t e = 0; e + 1 < boundary.size(); e += 2) {
    char& mark_a = mark[static_cast<std::size_t>(boundary[e])];
    char& mark_b = mark[static_cast<std::size_t>(boundary[e + 1])];
    const Point a = node_pixel(camera, positions, boundary[e]),
                b = node_pixel(camera, positions, boundary[e + 1]);
    if (mark_a == free_node || mark_b == free_node || !near_picture(canvas, a) || !near_picture(canvas, b)) {
      phase = spacing / 2;
      continue;
    }
    mark_a = mark_b = hatched_node;
    const float dx = b.x - a.x, dy = b.y - a.y, size = std::hypot(dx, dy);
    if (size < 1e-3f) continue;
    const float tx = dx / size, ty = dy / size;
    const float nx = -ty, ny = tx;  // outward: the interior is on the left, and pixels count downwards
    float s = phase;
    for (; s < size; s += spacing) {
      const Point from{a.x + tx * s, a.y + ty * s};
      const Point to{from.x + (nx - tx) * 0.72f * reach, from.y + (ny - ty) * 0.72f * reach};
      canvas.line(from, to, theme::soft_ink, width);
    }
    phase = s - size;
  }
  const float radius = 4 * canvas.unit();
  for (const int node : held) {
    if (mark[static_cast<std::size_t>(node)] != held_node) continue;
    const Point p = node_pixel(camera, positions, node);
    if (near_picture(canvas, p)) canvas.disk(p, radius, theme::ink);
  }
}

// The outward normal, at rest, of the boundary edge that the arrow stands on: the nearest one by its middle.
std::array<double, 2> TractionArrows::outward_normal(std::span<const double> positions,
                                                     const TractionArrow& arrow, std::size_t k) {
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
  return {(by - ay) / size, -(bx - ax) / size};
}

void TractionArrows::draw(Canvas& canvas, const Camera& camera, std::span<const double> positions,
                          std::span<const TractionArrow> arrows, double scale, float longest,
                          const Rect& value_area) {
  edge_.resize(arrows.size(), std::numeric_limits<std::size_t>::max());
  double largest = 0;
  for (const TractionArrow& arrow : arrows) {
    const double size = std::hypot(arrow.vector[0], arrow.vector[1]);
    if (std::isfinite(size)) largest = std::max(largest, size);
  }
  if (!(largest > 0)) return;
  if (!(scale > 0) || !std::isfinite(scale)) scale = largest;

  const float unit = canvas.unit(), width = std::max(1.6f, 2.4f * unit);
  const float apart = 9 * unit;
  std::vector<Point> feet;
  struct Drawn {
    Point outer;
    std::array<float, 2> away;  // from the body
  };
  std::vector<Drawn> strongest;
  float left = std::numeric_limits<float>::infinity(), right = -left, top = left;  // what the strongest cover
  for (std::size_t k = 0; k < arrows.size(); ++k) {
    const TractionArrow& arrow = arrows[k];
    const double size = std::hypot(arrow.vector[0], arrow.vector[1]);
    const Point foot = camera.pixel(arrow.at[0], arrow.at[1]);
    if (!(size > 1e-3 * scale) || !std::isfinite(size) || !near_picture(canvas, foot)) continue;
    const bool close = std::any_of(feet.begin(), feet.end(),
                                   [&](Point p) { return std::hypot(p.x - foot.x, p.y - foot.y) < apart; });
    if (close) continue;
    feet.push_back(foot);
    const float length = std::max(longest * static_cast<float>(std::min(size / scale, 1.5)), 9 * unit);
    const float ux = static_cast<float>(arrow.vector[0] / size),
                uy = static_cast<float>(-arrow.vector[1] / size);
    const std::array<double, 2> normal = outward_normal(positions, arrow, k);
    const bool presses = normal[0] * arrow.vector[0] + normal[1] * arrow.vector[1] < -0.1 * size;
    const float gap = 2.5f * unit;  // clear of the outline
    const Point tip = presses ? Point{foot.x - ux * gap, foot.y - uy * gap}
                              : Point{foot.x + ux * (length + gap), foot.y + uy * (length + gap)};
    const Point tail{tip.x - ux * length, tip.y - uy * length};
    const float head = std::min(11 * unit, 0.55f * length), half = 0.42f * head;
    const Point neck{tip.x - ux * head, tip.y - uy * head};
    canvas.line(tail, {tip.x - ux * head * 0.8f, tip.y - uy * head * 0.8f}, theme::force, width);
    canvas.triangle(tip, {neck.x - uy * half, neck.y + ux * half}, {neck.x + uy * half, neck.y - ux * half},
                    theme::force);
    if (size < (1 - 1e-9) * largest) continue;
    strongest.push_back({presses ? tail : tip, {presses ? -ux : ux, presses ? -uy : uy}});
    left = std::min({left, tail.x, tip.x});
    right = std::max({right, tail.x, tip.x});
    top = std::min({top, tail.y - half, tip.y - half});
  }
  if (strongest.empty() || value_area.width() <= 0) return;

  // The value beyond the middle one of the largest arrows; above all arrows where that is outside of the
  // area.
  const Drawn& chosen = strongest[strongest.size() / 2];
  const std::string value = with_unit(largest, "Pa");
  const float text = canvas.text_size(TextSize::small), w = canvas.text_width(TextSize::small, value);
  float x = chosen.outer.x + chosen.away[0] * (w / 2 + 0.5f * text);
  float y = chosen.outer.y + chosen.away[1] * 0.8f * text;
  const auto inside = [](float v, float low, float high) { return v >= low && v <= high; };
  if (!inside(x, value_area.x0 + w / 2, value_area.x1 - w / 2) || !inside(y, value_area.y0, value_area.y1)) {
    x = (left + right) / 2;
    y = top - 0.9f * text;
  }
  x = std::clamp(x, value_area.x0 + w / 2, std::max(value_area.x1 - w / 2, value_area.x0 + w / 2));
  y = std::clamp(y, value_area.y0 + text / 2, std::max(value_area.y1 - text / 2, value_area.y0 + text / 2));
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
