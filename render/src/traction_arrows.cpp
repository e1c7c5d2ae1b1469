#include "traction_arrows.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "theme.hpp"
#include "ticks.hpp"

namespace render {
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

// One arrow about its foot, in pixels.
struct Shape {
  Point tail, tip;
  bool presses = false;
  Point outer() const { return presses ? tail : tip; }
};

Shape shape(const TractionArrows::Arrow& arrow, float longest, float unit) {
  const float length = std::max(longest * arrow.part, std::min(9 * unit, longest));
  const float gap = 2.5f * unit;  // clear of the outline
  const float tip = arrow.presses ? -gap : length + gap, tail = tip - length;
  const auto [ux, uy] = arrow.direction;
  return {{ux * tail, uy * tail}, {ux * tip, uy * tip}, arrow.presses};
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

TractionArrows::Arrow TractionArrows::arrow(const MeshFrame& frame, std::size_t k, double scale) {
  const TractionArrow& given = frame.arrows[k];
  edge_.resize(std::max(edge_.size(), frame.arrows.size()), std::numeric_limits<std::size_t>::max());
  const double size = std::hypot(given.vector[0], given.vector[1]);
  const std::array<double, 2> normal = outward_normal(frame, k);
  return {
      .at = given.at,
      .direction = {static_cast<float>(given.vector[0] / size), static_cast<float>(-given.vector[1] / size)},
      .part = static_cast<float>(std::min(size / scale, 1.5)),
      .presses = normal[0] * given.vector[0] + normal[1] * given.vector[1] < -0.1 * size};
}

std::vector<TractionArrows::Arrow> TractionArrows::arrows(const MeshFrame& frame, double scale) {
  scale = usable_scale(scale, largest_traction(frame.arrows));
  std::vector<Arrow> all;
  for (std::size_t k = 0; k < frame.arrows.size(); ++k)
    if (is_drawn(frame.arrows[k], scale)) all.push_back(arrow(frame, k, scale));
  return all;
}

void TractionArrows::add_to(Framing& framing, const Canvas& canvas, std::span<const Arrow> arrows,
                            float longest) {
  const float side = head_half_width(longest, canvas.unit()) + 2 * canvas.unit();
  const auto reach = [side](float pixels) { return std::max(pixels, 0.0f) + side; };
  for (const Arrow& arrow : arrows) {
    const Point end = shape(arrow, longest, canvas.unit()).outer();
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
  std::vector<Drawn> sizes;
  std::vector<Stroke> drawn;
  for (std::size_t k = 0; k < frame.arrows.size(); ++k) {
    const Point foot = camera.pixel(frame.arrows[k].at[0], frame.arrows[k].at[1]);
    if (!is_drawn(frame.arrows[k], scale) || !near_picture(canvas, foot)) continue;
    const bool close = std::any_of(feet.begin(), feet.end(),
                                   [&](Point p) { return std::hypot(p.x - foot.x, p.y - foot.y) < apart; });
    if (close) continue;
    feet.push_back(foot);
    const Arrow about = arrow(frame, k, scale);
    const Shape s = shape(about, longest, unit);
    const Point tail{foot.x + s.tail.x, foot.y + s.tail.y}, tip{foot.x + s.tip.x, foot.y + s.tip.y};
    const float length = std::hypot(tip.x - tail.x, tip.y - tail.y);
    const float ux = about.direction.x, uy = about.direction.y;
    const float head = head_length(length, unit), half = head_half_width(length, unit);
    const Point neck{tip.x - ux * head, tip.y - uy * head};
    canvas.line(tail, {tip.x - ux * head * 0.8f, tip.y - uy * head * 0.8f}, canvas.palette().force, width);
    canvas.triangle(tip, {neck.x - uy * half, neck.y + ux * half}, {neck.x + uy * half, neck.y - ux * half},
                    canvas.palette().force);
    drawn.push_back({tail, tip, std::max(half, width / 2)});
    const double size = std::hypot(frame.arrows[k].vector[0], frame.arrows[k].vector[1]);
    sizes.push_back({size, s.presses ? tail : tip, s.presses ? Point{-ux, -uy} : Point{ux, uy}});
  }
  if (value_area.width() > 0) write_values(canvas, camera, frame, sizes, std::move(drawn), value_area);
}

// Each size once, beyond the middle one of the arrows that have it, or near there; the largest first. Where
// tractions differ from edge to edge, the arrows' lengths tell the others.
void TractionArrows::write_values(Canvas& canvas, const Camera& camera, const MeshFrame& frame,
                                  std::vector<Drawn>& sizes, std::vector<Stroke> drawn,
                                  const Rect& area) const {
  constexpr int most = 5;
  const float unit = canvas.unit(), text = canvas.text_size(TextSize::small);
  std::vector<Stroke> outline;
  for (std::size_t e = 0; e < boundary_.size(); e += 2) {
    const auto pixel = [&](int node) {
      const auto i = 2 * static_cast<std::size_t>(node);
      return camera.pixel(frame.positions[i], frame.positions[i + 1]);
    };
    const Stroke s{pixel(boundary_[e]), pixel(boundary_[e + 1]), theme::outline_width(unit) / 2};
    if (near_picture(canvas, s.from) && near_picture(canvas, s.to)) outline.push_back(s);
  }
  Color halo = canvas.palette().paper;
  halo.a = 215;
  std::ranges::stable_sort(sizes, std::greater{}, &Drawn::size);
  auto alike = sizes.begin();
  for (int written = 0; alike != sizes.end() && written < most; ++written) {
    const auto end = std::find_if(alike, sizes.end(),
                                  [&](const Drawn& one) { return one.size < (1 - 1e-9) * alike->size; });
    const Drawn& chosen = alike[(end - alike) / 2];
    const std::string value = with_unit(alike->size, "Pa");
    alike = end;
    const float w = canvas.text_width(TextSize::small, value);
    const Point wanted{chosen.outer.x + chosen.away.x * (w / 2 + 0.5f * text),
                       chosen.outer.y + chosen.away.y * 0.8f * text};
    const float plate_width = w + 0.4f * text, plate_height = 1.1f * text;
    const auto [x, y] = free_place(wanted, plate_width, plate_height, area, drawn, outline);
    canvas.rect({x - plate_width / 2, y - plate_height / 2, x + plate_width / 2, y + plate_height / 2}, halo,
                0.25f * text);
    canvas.text({x, y}, Align::center, TextSize::small, canvas.palette().force, value);
    drawn.push_back({{x - plate_width / 2, y}, {x + plate_width / 2, y}, plate_height / 2});
  }
}

}  // namespace render
