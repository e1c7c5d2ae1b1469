#include "view/recording.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "rheo/error.hpp"
#include "rheo/io/atomic_file.hpp"

namespace app::view {
namespace {

constexpr int encoders = 2;

}  // namespace

std::filesystem::path Recording::free_name(const std::string& stem, const std::string& ending) {
  std::filesystem::create_directories(folder_);
  for (int k = 1;; ++k) {
    std::filesystem::path path = folder_ / fmt::format("{}_{:03}{}", stem, k, ending);
    if (!std::filesystem::exists(path)) return path;
  }
}

std::string Recording::start() {
  try {
    frames_folder_ = free_name("frames", "");
    std::filesystem::create_directories(frames_folder_);
    sequence_ = std::make_unique<render::PngSequence>(encoders);
    frames_ = 0;
    return fmt::format("recording into {}", frames_folder_.string());
  } catch (const std::exception& error) {
    return fmt::format("cannot record: {}", error.what());
  }
}

std::string Recording::stop() {
  const auto sequence = std::move(sequence_);
  try {
    if (sequence) sequence->finish();
    return fmt::format("{} frames in {}", frames_, frames_folder_.string());
  } catch (const std::exception& error) {
    return fmt::format("recording is not whole: {}", error.what());
  }
}

std::string Recording::add(render::Image&& image) {
  try {
    sequence_->submit(std::move(image), frames_folder_ / fmt::format("frame_{:05}.png", frames_));
    ++frames_;
    return {};
  } catch (const std::exception& error) {
    sequence_.reset();
    return fmt::format("recording ended: {}", error.what());
  }
}

std::string Recording::picture(const render::Image& image) {
  try {
    const std::filesystem::path path = free_name("picture", ".png");
    render::write_png(path, image);
    return fmt::format("saved {}", path.string());
  } catch (const std::exception& error) {
    return fmt::format("cannot save the picture: {}", error.what());
  }
}

std::string Recording::text_file(const std::string& stem, const std::string& ending,
                                 const std::string& text) {
  try {
    const std::filesystem::path path = free_name(stem, ending);
    rheo::AtomicFile file(path);
    file.write(text);
    file.commit();
    return fmt::format("saved {}", path.string());
  } catch (const std::exception& error) {
    return fmt::format("cannot save: {}", error.what());
  }
}

}  // namespace app::view
