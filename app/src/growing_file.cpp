#include "growing_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "failure.hpp"

namespace app {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t buffer_size = 1 << 16;

fs::path part_of(fs::path path) {
  return path += ".part";
}

}  // namespace

void GrowingFile::refuse(const char* what, int reason) const {
  throw Failure(ExitCode::file, fmt::format("{}: {}: {}", path_.string(), what, std::strerror(reason)));
}

GrowingFile::GrowingFile(fs::path path) : path_(std::move(path)) {
  std::error_code ignored;
  if (fs::is_directory(path_, ignored)) refuse("cannot be written", EISDIR);
  file_ = open(part_of(path_).c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file_ < 0) refuse("cannot be written", errno);
}

void GrowingFile::open_kept(std::uint64_t length) {
  kept_ = true;
  length_ = length;
  file_ = open(part_of(path_).c_str(), O_RDWR | O_CLOEXEC);
  was_whole_ = file_ < 0 && errno == ENOENT;
  if (was_whole_) file_ = open(path_.c_str(), O_RDWR | O_CLOEXEC);
  if (file_ < 0) refuse("what the cut run kept cannot be opened (--force begins anew)", errno);
  const off_t there = lseek(file_, 0, SEEK_END);
  if (there < 0 || static_cast<std::uint64_t>(there) < length) take_kept({});
}

// Nothing is changed before it is known to be the right one.
void GrowingFile::take_kept(const Mark& mark) {
  if (mark.length != length_ || mark.pieces != pieces_ || mark.checksum != fingerprint_.value()) {
    close(file_);
    throw Failure(ExitCode::file,
                  fmt::format("{}: is not what the checkpoint beside it belongs to: begin the "
                              "run anew with --force",
                              (was_whole_ ? path_ : part_of(path_)).string()));
  }
  std::error_code error;
  if (was_whole_) fs::rename(path_, part_of(path_), error);
  if (error) refuse("cannot be gone on with", error.value());
  if (ftruncate(file_, static_cast<off_t>(length_)) != 0) refuse("cannot be gone on with", errno);
}

std::size_t GrowingFile::next_piece(std::uint64_t offset, std::uint64_t end, std::size_t piece,
                                    std::string& held) {
  // A line: as much as is needed is read, twice as much at each turn.
  for (std::size_t size = piece > 0 ? piece : 1024;; size *= 2) {
    held.resize(static_cast<std::size_t>(std::min<std::uint64_t>(size, end - offset)));
    read(offset, held);
    if (piece > 0) return held.size();
    if (const std::size_t line = held.find('\n'); line != std::string::npos) return line + 1;
    if (offset + held.size() == end) return held.size();
  }
}

GrowingFile::~GrowingFile() {
  if (file_ < 0) return;
  if (!kept_)
    discard();
  else
    close(file_);
}

void GrowingFile::discard() {
  if (file_ < 0) return;
  close(file_);
  file_ = -1;
  std::error_code ignored;
  fs::remove(part_of(path_), ignored);
}

void GrowingFile::append(std::string_view piece) {
  buffer_ += piece;
  length_ += piece.size();
  ++pieces_;
  fingerprint_.add(piece);
  if (buffer_.size() >= buffer_size) flush();
}

void GrowingFile::flush() {
  std::uint64_t at = length_ - buffer_.size();
  for (std::string_view rest = buffer_; !rest.empty();) {
    const ssize_t n = pwrite(file_, rest.data(), rest.size(), static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) refuse("cannot be written", n < 0 ? errno : ENOSPC);
    rest.remove_prefix(static_cast<std::size_t>(n));
    at += static_cast<std::uint64_t>(n);
  }
  buffer_.clear();
}

void GrowingFile::read(std::uint64_t offset, std::span<char> out) {
  flush();
  while (!out.empty()) {
    const ssize_t n = pread(file_, out.data(), out.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) refuse("cannot be read", n < 0 ? errno : EIO);
    out = out.subspan(static_cast<std::size_t>(n));
    offset += static_cast<std::uint64_t>(n);
  }
}

GrowingFile::Mark GrowingFile::keep() {
  if (file_ >= 0) flush();
  // A file system without fsync has nothing to wait for.
  if (file_ >= 0 && fdatasync(file_) != 0 && errno != EINVAL) refuse("cannot be written", errno);
  kept_ = true;
  return {length_, pieces_, fingerprint_.value()};
}

void GrowingFile::commit() {
  flush();
  const int closed = close(file_);
  file_ = -1;
  const int reason = closed != 0 ? errno : 0;
  std::error_code error, ignored;
  if (reason == 0) fs::rename(part_of(path_), path_, error);
  if (reason == 0 && !error) return;
  if (!kept_) fs::remove(part_of(path_), ignored);
  refuse("cannot be written", reason != 0 ? reason : error.value());
}

}  // namespace app
