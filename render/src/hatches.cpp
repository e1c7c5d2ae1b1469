#include "hatches.hpp"

#include <algorithm>
#include <cmath>

namespace render {
namespace {

Point node_pixel(const Camera& camera, std::span<const double> positions, int node) {
  const auto i = 2 * static_cast<std::size_t>(node);
  return camera.pixel(positions[i], positions[i + 1]);
}

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
  void draw(Canvas& canvas, float size) const {
    if (points_.size() < 2) return;
    const float pitch = 9 * canvas.unit() * size, reach = pitch, width = std::max(1.0f, 1.3f * canvas.unit());
    const float step = length_ / std::max(1.0f, std::round(length_ / pitch));
    float next = step / 2;  // of the next stroke, from the start of the segment
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const Point a = points_[i - 1], b = points_[i];
      const float dx = b.x - a.x, dy = b.y - a.y, along = std::hypot(dx, dy);
      const float tx = dx / along, ty = dy / along;
      const float nx = -ty, ny = tx;  // outward: the interior is on the left, and pixels count downwards
      for (; next < along; next += step) {
        const Point from{a.x + tx * next, a.y + ty * next};
        const Point to{from.x + (nx - tx) * 0.72f * reach, from.y + (ny - ty) * 0.72f * reach};
        canvas.line(from, to, canvas.palette().soft_ink, width);
      }
      next -= along;
    }
  }

 private:
  std::vector<Point> points_;
  float length_ = 0;
};

}  // namespace

void draw_hatches(Canvas& canvas, const Camera& camera, const BoundaryChains& boundary,
                  std::span<const double> positions, std::span<const int> held, float size,
                  std::vector<char>& mark) {
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
    const std::size_t begin = boundary.offsets[chain], edges = boundary.size(chain);
    std::size_t first = 0;  // a run that goes on beyond a loop's first edge is not to be cut there
    if (boundary.closed(chain)) {
      while (first < edges && is_held(begin + first)) ++first;
    }
    HatchedRun run;
    for (std::size_t k = 0; k < edges; ++k) {
      const std::size_t e = begin + (first + k) % edges;
      if (!is_held(e)) {
        run.draw(canvas, size);
        run = {};
        continue;
      }
      for (const int node : {boundary.edges[2 * e], boundary.edges[2 * e + 1]}) {
        run.add(node_pixel(camera, positions, node));
        mark[static_cast<std::size_t>(node)] = hatched_node;
      }
    }
    run.draw(canvas, size);
  }
  const float radius = 4 * canvas.unit() * size;
  for (const int node : held) {
    if (mark[static_cast<std::size_t>(node)] != held_node) continue;
    const Point p = node_pixel(camera, positions, node);
    if (near_picture(canvas, p)) canvas.disk(p, radius, canvas.palette().ink);
  }
}

}  // namespace render
