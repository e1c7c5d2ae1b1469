// Records of equal length, kept between the simulation and the drawing: in memory while small, else in a file
// without a name in the output folder, which disappears with the program.
//
// Numbers are float32: a picture has 16384 pixels a side at most, 24 bits are plenty.
//
// Errors   Failure(file): no room or the system's reason
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace app {

class FrameStore {
 public:
  // Room for `records` of `length` numbers each; beyond `memory_limit` bytes they go to a file in `folder`.
  FrameStore(const std::filesystem::path& folder, std::size_t length, std::int64_t records,
             std::int64_t memory_limit = std::int64_t{256} << 20);
  FrameStore(const FrameStore&) = delete;
  FrameStore& operator=(const FrameStore&) = delete;
  ~FrameStore();

  void append(std::span<const float> record);
  void read(std::int64_t k, std::span<float> record) const;
  std::int64_t count() const { return count_; }

 private:
  std::filesystem::path folder_;
  std::size_t length_;
  std::int64_t count_ = 0;
  int file_ = -1;
  std::vector<float> memory_;
};

}  // namespace app
