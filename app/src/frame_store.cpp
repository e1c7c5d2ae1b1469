#include "frame_store.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>

#include "failure.hpp"
#include "output_folder.hpp"

namespace app {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& folder, const char* what, int reason) {
  throw Failure(ExitCode::file, fmt::format("{}: cannot {} the sequence's positions: {}", folder.string(),
                                            what, std::strerror(reason)));
}

}  // namespace

FrameStore::FrameStore(const std::filesystem::path& folder, std::size_t length, std::int64_t records,
                       std::int64_t memory_limit)
    : folder_(folder), length_(length) {
  // In double: the product of absurd counts must not wrap round.
  const double bytes = static_cast<double>(length) * static_cast<double>(records) * sizeof(float);
  if (bytes <= static_cast<double>(memory_limit)) {
    memory_.reserve(length * static_cast<std::size_t>(records));
    return;
  }
  std::error_code error;
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  if (!error && bytes > static_cast<double>(space.available))
    throw Failure(ExitCode::file,
                  fmt::format("{}: the sequence needs {:.1f} GB for its positions, {:.1f} GB are free: lower "
                              "--frame-rate or --duration, or name a folder on another disk with -o",
                              folder.string(), bytes * 1e-9, static_cast<double>(space.available) * 1e-9));
  file_ = open_unnamed_file(folder);
}

FrameStore::~FrameStore() {
  if (file_ >= 0) close(file_);
}

void FrameStore::append(std::span<const float> record) {
  assert(record.size() == length_);
  if (file_ < 0) {
    memory_.insert(memory_.end(), record.begin(), record.end());
  } else {
    const auto bytes = std::as_bytes(record);
    const auto start = static_cast<off_t>(count_) * static_cast<off_t>(bytes.size());
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t n =
          pwrite(file_, bytes.data() + done, bytes.size() - done, start + static_cast<off_t>(done));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) refuse(folder_, "write", n < 0 ? errno : ENOSPC);
      done += static_cast<std::size_t>(n);
    }
  }
  ++count_;
}

void FrameStore::read(std::int64_t k, std::span<float> record) const {
  assert(record.size() == length_ && k >= 0 && k < count_);
  if (file_ < 0) {
    std::copy_n(memory_.begin() + k * static_cast<std::ptrdiff_t>(length_), length_, record.begin());
    return;
  }
  const auto bytes = std::as_writable_bytes(record);
  const auto start = static_cast<off_t>(k) * static_cast<off_t>(bytes.size());
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n =
        pread(file_, bytes.data() + done, bytes.size() - done, start + static_cast<off_t>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) refuse(folder_, "read", n < 0 ? errno : EIO);
    done += static_cast<std::size_t>(n);
  }
}

}  // namespace app
