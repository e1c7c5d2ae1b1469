// PNG files, each whole or not at all, and sequences encoded on threads of their own.
//
// Errors   FileError: the path and the system's reason
#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <vector>

#include "render/image.hpp"

namespace render {

class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::vector<unsigned char> encode_png(const Image& image);
void write_png(const std::filesystem::path& file, const Image& image);

// A bounded queue of frames with `threads` encoders. submit() waits while the queue is full and throws the
// first error of an encoder; finish() waits for all and does likewise. The destructor waits too, and throws
// nothing.
class PngSequence {
 public:
  explicit PngSequence(int threads);
  ~PngSequence();
  PngSequence(const PngSequence&) = delete;
  PngSequence& operator=(const PngSequence&) = delete;

  void submit(Image&& image, std::filesystem::path file);
  void finish();
  Image recycle();  // an Image whose memory can be used again; empty when there is none

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace render
