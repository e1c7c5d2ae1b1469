// Makes PNG files in memory, one after the other, in the same memory.
//
//   signature, IHDR, one IDAT (zlib stream of the rows, each after a filter byte 0), IEND
//
// Pictures without transparency are written as RGB, others as RGBA. Rows are not filtered: frames of flat
// areas and thin lines deflate as well without, and faster. Source   PNG specification, third edition (W3C);
// RFC 1950 by libdeflate Errors   std::runtime_error where memory is short or the image is empty
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "render/image.hpp"

struct libdeflate_compressor;

namespace render {

class PngEncoder {
 public:
  PngEncoder();
  ~PngEncoder();
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  // The file's bytes, valid until the next call.
  std::span<const unsigned char> encode(const Image& image);

 private:
  libdeflate_compressor* compressor_;
  std::vector<unsigned char> rows_;
  std::vector<unsigned char> file_;
};

}  // namespace render
