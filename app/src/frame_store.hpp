// Records of equal length, kept between the simulation and the drawing: in memory while small, else in the
// output folder's positions.bin.part, which goes with the program unless it is kept for a later one.
//
// Numbers are float32: a picture has 16384 pixels a side at most, 24 bits are plenty.
//
// Errors   Failure(file): no room or the system's reason
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "growing_file.hpp"

namespace app {

class FrameStore {
 public:
  // Room for `records` of `length` numbers each; beyond `memory_limit` bytes they go to the file.
  FrameStore(const std::filesystem::path& folder, std::size_t length, std::int64_t records,
             std::int64_t memory_limit = std::int64_t{256} << 20);

  void append(std::span<const float> record);
  void read(std::int64_t k, std::span<float> record) const;
  std::int64_t count() const { return count_; }

  // All records so far are in the file, whatever happens from now on.
  GrowingFile::Mark keep();
  // Goes on with the records that were kept, before the first append().
  void take_up(const GrowingFile::Mark& kept);
  void discard();

 private:
  std::filesystem::path file_path_;
  std::size_t length_;
  bool in_memory_ = true;
  std::int64_t count_ = 0;
  std::int64_t filed_ = 0;  // so many of them are in the file
  std::vector<float> memory_;
  mutable std::optional<GrowingFile> file_;
};

}  // namespace app
