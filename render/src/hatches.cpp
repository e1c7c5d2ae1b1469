#include "hatches.hpp"

#include <algorithm>
#include <cmath>

namespace render {
namespace {

Point node_pixel(const Camera& camera, std::span<const double> positions, int node) {
  const auto i = 2 * static_cast<std::size_t>(node);
  return camera.pixel(positions[i], positions[i + 1]);
}

// How an edge is held.
enum class Hold { none, fixed, rolls, guided };

// A run of edges that are held alike as points in the picture, and the marks along it.
class HeldRun {
 public:
  explicit HeldRun(Hold hold) : hold_(hold) {}

  Hold hold() const { return hold_; }

  void add(Point p) {
    if (points_.empty()) points_.push_back(p);
    const Point q = points_.back();
    const float size = std::hypot(p.x - q.x, p.y - q.y);
    if (size < 1e-3f) return;  // not worth a direction; its length counts with the next one
    points_.push_back(p);
    length_ += size;
  }

  // As many marks as suit the spacing best, the first and the last one half a step from the ends.
  void draw(Canvas& canvas, float size) const {
    if (points_.size() < 2) return;
    const float pitch = 9 * canvas.unit() * size, width = std::max(1.0f, 1.3f * canvas.unit());
    const Color color = canvas.palette().soft_ink;
    const float radius = 0.34f * pitch;
    const float step = length_ / std::max(1.0f, std::round(length_ / pitch));
    float next = step / 2;  // of the next mark, from the start of the segment
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const Point a = points_[i - 1], b = points_[i];
      const float dx = b.x - a.x, dy = b.y - a.y, along = std::hypot(dx, dy);
      const float tx = dx / along, ty = dy / along;
      const float nx = -ty, ny = tx;  // outward: the interior is on the left, and pixels count downwards
      const auto at = [&](float s, float out) {
        return Point{a.x + tx * s + nx * out, a.y + ty * s + ny * out};
      };
      const float lift = radius + width;  // a roller touches the outline
      for (; next < along; next += step) {
        switch (hold_) {
          case Hold::none:
            break;
          case Hold::fixed:
            canvas.line(at(next, 0), at(next - 0.72f * pitch, 0.72f * pitch), color, width);
            break;
          case Hold::guided:
            canvas.line(at(next, 0), at(next, 0.8f * pitch), color, width);
            break;
          case Hold::rolls:
            canvas.disk(at(next, lift), radius, color);
            canvas.disk(at(next, lift), radius - width, canvas.palette().paper);
            break;
        }
      }
      if (hold_ == Hold::rolls)
        canvas.line(at(0, lift + radius + width / 2), at(along, lift + radius + width / 2), color, width);
      next -= along;
    }
  }

 private:
  Hold hold_;
  std::vector<Point> points_;
  float length_ = 0;
};

enum : char { free_node = 0, along_x = 1, along_y = 2, along_both = 3, marked_edge = 4 };

}  // namespace

void draw_hatches(Canvas& canvas, const Camera& camera, const BoundaryChains& boundary,
                  std::span<const double> positions, std::span<const int> held, float size,
                  std::vector<char>& mark) {
  if (held.empty()) return;
  mark.assign(positions.size() / 2, free_node);
  for (const int dof : held) mark[static_cast<std::size_t>(dof / 2)] |= dof % 2 == 0 ? along_x : along_y;

  const auto hold = [&](std::size_t e) {
    const int first = boundary.edges[2 * e], second = boundary.edges[2 * e + 1];
    const int both =
        mark[static_cast<std::size_t>(first)] & mark[static_cast<std::size_t>(second)] & along_both;
    const Point p = node_pixel(camera, positions, first), q = node_pixel(camera, positions, second);
    if (both == free_node || !near_picture(canvas, p) || !near_picture(canvas, q)) return Hold::none;
    if (both == along_both) return Hold::fixed;
    const bool runs_along_x = std::abs(q.x - p.x) > std::abs(q.y - p.y);
    return (both == along_x) == runs_along_x ? Hold::guided : Hold::rolls;
  };
  for (std::size_t chain = 0; chain < boundary.count(); ++chain) {
    const std::size_t begin = boundary.offsets[chain], edges = boundary.size(chain);
    std::size_t first = 0;  // a run that goes on beyond a loop's first edge is not to be cut there
    if (boundary.closed(chain)) {
      while (first < edges && hold(begin + first) != Hold::none) ++first;
    }
    HeldRun run(Hold::none);
    for (std::size_t k = 0; k < edges; ++k) {
      const std::size_t e = begin + (first + k) % edges;
      const Hold now = hold(e);
      if (now != run.hold()) {
        run.draw(canvas, size);
        run = HeldRun(now);
      }
      if (now == Hold::none) continue;
      for (const int node : {boundary.edges[2 * e], boundary.edges[2 * e + 1]}) {
        run.add(node_pixel(camera, positions, node));
        mark[static_cast<std::size_t>(node)] |= marked_edge;
      }
    }
    run.draw(canvas, size);
  }
  const float radius = 4 * canvas.unit() * size;
  for (std::size_t node = 0; node < mark.size(); ++node) {
    if (mark[node] == free_node || (mark[node] & marked_edge) != 0) continue;
    const Point p = node_pixel(camera, positions, static_cast<int>(node));
    if (!near_picture(canvas, p)) continue;
    canvas.disk(p, radius, canvas.palette().ink);
    if (mark[node] != along_both) canvas.disk(p, 0.5f * radius, canvas.palette().paper);
  }
}

}  // namespace render
