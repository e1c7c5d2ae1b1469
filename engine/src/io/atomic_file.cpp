#include "rheo/io/atomic_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "rheo/error.hpp"

namespace rheo {
namespace {

Error cannot_write(const std::filesystem::path& file, int reason) {
  return Error(Error::Kind::file, fmt::format("{}: cannot be written: {}", file.string(),
                                              std::generic_category().message(reason)));
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), part_(path_) {
  part_ += ".part";
  std::error_code ignored;
  if (std::filesystem::is_directory(path_, ignored)) throw cannot_write(path_, EISDIR);
  file_ = std::fopen(part_.c_str(), "wb");
  if (file_ == nullptr) throw cannot_write(path_, errno);
}

AtomicFile::~AtomicFile() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) throw cannot_write(path_, errno);
}

void AtomicFile::commit(Durability durability) {
  errno = 0;
  int reason = 0;
  // A file system without fsync (EINVAL) has nothing to wait for.
  if (durability == Durability::on_disk &&
      (std::fflush(file_) != 0 || (fsync(fileno(file_)) != 0 && errno != EINVAL)))
    reason = errno;
  int closed = std::fclose(std::exchange(file_, nullptr));
  if (closed != 0) reason = errno;
  if (reason != 0) closed = EOF;
  std::error_code error;
  if (closed == 0) {
    std::filesystem::rename(part_, path_, error);
    reason = error.value();
  }
  if (closed == 0 && !error) return;
  std::filesystem::remove(part_, error);
  throw cannot_write(path_, reason);
}

}  // namespace rheo
