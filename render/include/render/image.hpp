// A picture in memory.
//
// Shapes   rgba: height x width x 4 bytes, top row first
#pragma once

#include <cstdint>
#include <vector>

namespace render {

struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;
};

}  // namespace render
