// What the picture tests share: contexts, pixels, comparing pictures.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/context.hpp"
#include "render/image.hpp"
#include "render/png.hpp"

namespace support {

using Pixel = std::array<int, 3>;

inline constexpr Pixel paper{252, 252, 253};

inline Pixel at(const render::Image& image, int x, int y) {
  const auto i =
      4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return {image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]};
}

inline int distance(const Pixel& a, const Pixel& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

// x0, y0, x1, y1 (inclusive) of the pixels for which `wanted` holds; x1 < x0 when there is none.
struct Box {
  int x0 = 1 << 30, y0 = 1 << 30, x1 = -1, y1 = -1, count = 0;
  int width() const { return x1 - x0 + 1; }
  int height() const { return y1 - y0 + 1; }
};

inline Box find(const render::Image& image, const std::function<bool(int x, int y, const Pixel&)>& wanted) {
  Box box;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!wanted(x, y, at(image, x, y))) continue;
      box.x0 = std::min(box.x0, x);
      box.y0 = std::min(box.y0, y);
      box.x1 = std::max(box.x1, x);
      box.y1 = std::max(box.y1, y);
      ++box.count;
    }
  }
  return box;
}

// Where two pictures of one size differ by more than `level`.
inline Box find_difference(const render::Image& a, const render::Image& b, int level = 0) {
  return find(a, [&](int x, int y, const Pixel& p) { return distance(p, at(b, x, y)) > level; });
}

struct Difference {
  int largest = 0;
  double mean = 0;
};

inline Difference compare(const render::Image& a, const render::Image& b) {
  if (a.width != b.width || a.height != b.height) return {256, 256};
  Difference d;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const int step = std::abs(a.rgba[i] - b.rgba[i]);
    d.largest = std::max(d.largest, step);
    d.mean += step;
  }
  d.mean /= static_cast<double>(std::max<std::size_t>(a.rgba.size(), 1));
  return d;
}

// A context, or null where this machine lacks the backend; a context that fails to open otherwise is a
// failure.
inline std::unique_ptr<render::Context> open(render::Backend backend, int width, int height) {
  try {
    return render::open_context(backend, width, height);
  } catch (const std::runtime_error& e) {
    if (std::string(e.what()).find("install the Debian package") == std::string::npos) throw;
    return nullptr;
  }
}

// The folder for pictures that a failing test leaves behind.
inline std::filesystem::path output_folder() {
  const std::filesystem::path folder = RHEO_TEST_OUTPUT;
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace support

#define RHEO_OPEN_OR_SKIP(name, backend, width, height)    \
  const auto name = support::open(backend, width, height); \
  if (!name)                                               \
  GTEST_SKIP() << "this machine has no such backend"       \
               << " (libosmesa6, libegl1 with libgl1-mesa-dri)"
