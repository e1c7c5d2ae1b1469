// Rows of numbers as the renderer takes them: one after the other.
#pragma once

#include <vector>

#include "rheo/mesh.hpp"

namespace app {

inline std::vector<double> flat(const std::vector<rheo::Vec2>& points) {
  std::vector<double> out;
  out.reserve(2 * points.size());
  for (const rheo::Vec2& point : points) out.insert(out.end(), {point.x, point.y});
  return out;
}

template <typename Rows>
std::vector<int> flat_numbers(const Rows& rows) {
  std::vector<int> out;
  for (const auto& row : rows) out.insert(out.end(), row.begin(), row.end());
  return out;
}

}  // namespace app
