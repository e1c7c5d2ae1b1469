#include "frame_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstring>

#include "failure.hpp"

namespace app {
namespace {

std::string_view bytes_of(std::span<const float> record) {
  return {reinterpret_cast<const char*>(record.data()), record.size_bytes()};
}

}  // namespace

FrameStore::FrameStore(const std::filesystem::path& folder, std::size_t length, std::int64_t records,
                       std::int64_t memory_limit)
    : file_path_(folder / "positions.bin"), length_(length) {
  // In double: the product of absurd counts must not wrap round.
  const double bytes = static_cast<double>(length) * static_cast<double>(records) * sizeof(float);
  in_memory_ = bytes <= static_cast<double>(memory_limit);
  if (in_memory_) {
    memory_.reserve(length * static_cast<std::size_t>(records));
    return;
  }
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (!error && bytes > static_cast<double>(space.available))
    throw Failure(ExitCode::file,
                  fmt::format("{}: the sequence needs {:.1f} GB for its positions, {:.1f} GB are free: draw "
                              "fewer frames with --every, lower --frame-rate or --duration, or name a folder "
                              "on another disk with -o",
                              folder.string(), bytes * 1e-9, static_cast<double>(space.available) * 1e-9));
}

void FrameStore::append(std::span<const float> record) {
  assert(record.size() == length_);
  if (in_memory_) {
    memory_.insert(memory_.end(), record.begin(), record.end());
  } else {
    if (!file_) file_.emplace(file_path_);
    file_->append(bytes_of(record));
    ++filed_;
  }
  ++count_;
}

void FrameStore::read(std::int64_t k, std::span<float> record) const {
  assert(record.size() == length_ && k >= 0 && k < count_);
  if (in_memory_) {
    std::copy_n(memory_.begin() + k * static_cast<std::ptrdiff_t>(length_), length_, record.begin());
    return;
  }
  file_->read(static_cast<std::uint64_t>(k) * record.size_bytes(),
              {reinterpret_cast<char*>(record.data()), record.size_bytes()});
}

GrowingFile::Mark FrameStore::keep() {
  if (!file_) file_.emplace(file_path_);
  for (; filed_ < count_; ++filed_)
    file_->append(bytes_of(std::span(memory_).subspan(static_cast<std::size_t>(filed_) * length_, length_)));
  return file_->keep();
}

void FrameStore::take_up(const GrowingFile::Mark& kept) {
  assert(count_ == 0);
  file_.emplace(file_path_, kept, length_ * sizeof(float), [&](std::string_view record) {
    ++count_;
    if (!in_memory_) return;
    const std::size_t begin = memory_.size();
    memory_.resize(begin + length_);
    std::memcpy(memory_.data() + begin, record.data(), std::min(record.size(), length_ * sizeof(float)));
  });
  filed_ = count_;
}

void FrameStore::discard() {
  if (file_) file_->discard();
}

}  // namespace app
