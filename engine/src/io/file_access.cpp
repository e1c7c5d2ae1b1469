#include "io/file_access.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "io/message.hpp"
#include "rheo/error.hpp"

namespace rheo {
namespace {

namespace fs = std::filesystem;

// With all symbolic links of what is there followed.
fs::path followed(const fs::path& path) {
  std::error_code failure;
  const fs::path absolute = fs::absolute(path, failure);
  const fs::path result = failure ? fs::path() : fs::weakly_canonical(absolute, failure);
  if (failure) {
    throw Error(Error::Kind::file,
                fmt::format("{} cannot be followed: {}", one_line(path.string(), 200), failure.message()));
  }
  return result;
}

bool lies_in(const fs::path& folder, const fs::path& path) {
  const auto [left, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return left == folder.end() || (std::next(left) == folder.end() && left->empty());
}

}  // namespace

fs::path FileAccess::resolve(const std::string& name) const {
  // The name goes into messages of one line, and a zero byte would cut it short.
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::any_of(name.begin(), name.end(), is_control))
    throw Error(Error::Kind::input, "a control character in the name of a file: give the file another name");
  const fs::path path = folder_ / name;
  if (outside_ == OutsideFiles::refused) {
    const fs::path folder = followed(folder_.empty() ? fs::path(".") : folder_);
    if (const fs::path real = followed(path); !lies_in(folder, real)) {
      throw Error(Error::Kind::input,
                  fmt::format("leads to {}, out of the scene's folder {}: put the file beside the scene, or "
                              "allow it with --allow-outside",
                              one_line(real.string(), 200), one_line(folder.string(), 200)));
    }
  }
  std::error_code absent;
  const fs::file_status status = fs::status(path, absent);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
    throw Error(Error::Kind::input, fmt::format("{} is a device or a pipe: a regular file is needed",
                                                one_line(path.string(), 200)));
  }
  return path;
}

}  // namespace rheo
