// Pictures to files from the window: single ones, and sequences at even simulated times of which no frame is
// lost (the recording asks the physics for each of its frames).
//
// Errors   messages; render::FileError is caught here
// Not here what is in the pictures
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "render/png.hpp"

namespace app::view {

class Recording {
 public:
  explicit Recording(std::filesystem::path folder) : folder_(std::move(folder)) {}

  bool is_on() const { return sequence_ != nullptr; }
  int frames() const { return frames_; }
  // Each returns what to tell the user.
  std::string start();
  std::string stop();
  // Empty where all is well.
  std::string add(render::Image&& image);
  render::Image image() { return sequence_ ? sequence_->recycle() : render::Image{}; }
  std::string picture(const render::Image& image);
  std::string text_file(const std::string& stem, const std::string& ending, const std::string& text);

 private:
  std::filesystem::path free_name(const std::string& stem, const std::string& ending);

  std::filesystem::path folder_, frames_folder_;
  std::unique_ptr<render::PngSequence> sequence_;
  int frames_ = 0;
};

}  // namespace app::view
