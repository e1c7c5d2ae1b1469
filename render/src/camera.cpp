#include "camera.hpp"

#include <algorithm>
#include <cmath>

namespace render {

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
  const double size = side > 0 ? side : std::max({1e-12, std::abs(b[0]) * 1e-3, std::abs(b[1]) * 1e-3});
  for (std::size_t k = 0; k < 2; ++k) {
    if (b[k + 2] - b[k] < 1e-6 * size) {
      const double middle = (b[k] + b[k + 2]) / 2;
      b[k] = middle - size / 20;
      b[k + 2] = middle + size / 20;
    }
  }
  return b;
}

Camera fit_camera(const std::array<double, 4>& bounds, const Rect& area) {
  const std::array<double, 4> b = usable_bounds(bounds);
  const double w = std::max(area.width(), 1.0f), h = std::max(area.height(), 1.0f);
  Camera camera;
  camera.x0 = (b[0] + b[2]) / 2;
  camera.y0 = (b[1] + b[3]) / 2;
  camera.pixel_x = (area.x0 + area.x1) / 2;
  camera.pixel_y = (area.y0 + area.y1) / 2;
  camera.scale = std::min(w / (b[2] - b[0]), h / (b[3] - b[1]));
  return camera;
}

}  // namespace render
