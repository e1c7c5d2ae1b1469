// Makes PNG files in memory, one after the other, by stb_image_write with libdeflate inside.
//
// Pictures without transparency are written as RGB, others as RGBA. Rows are not filtered: frames of flat
// areas and thin lines deflate as well without, and faster.
//
// Errors   std::runtime_error where memory is short, the image is empty or too large
#pragma once

#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

#include "render/image.hpp"

namespace render {

class PngEncoder {
 public:
  // The file's bytes, valid until the next call.
  std::span<const unsigned char> encode(const Image& image);

 private:
  struct Free {
    void operator()(unsigned char* bytes) const { std::free(bytes); }
  };
  std::vector<unsigned char> rgb_;
  std::unique_ptr<unsigned char, Free> file_;
};

}  // namespace render
