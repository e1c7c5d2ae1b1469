#include "io/read_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include "rheo/error.hpp"

namespace rheo {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void refuse_size(const std::filesystem::path& file, const std::string& what, std::size_t limit) {
  throw Error(Error::Kind::input, fmt::format("{}: the {} file is larger than {} MB, the most that is read",
                                              file.string(), what, limit >> 20));
}

}  // namespace

std::string read_file(const std::filesystem::path& file, const std::string& what, std::size_t limit,
                      std::string_view beginning) {
  const auto cannot_read = [&](int reason) {
    return Error(Error::Kind::file, fmt::format("{}: the {} file cannot be read: {}", file.string(), what,
                                                std::generic_category().message(reason)));
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw Error(Error::Kind::file, fmt::format("{}: is a folder; a {} file is needed", file.string(), what));
  }
  const std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(file.c_str(), "rb"));
  if (!stream) throw cannot_read(errno);
  std::string text;
  const auto size = std::filesystem::file_size(file, ignored);
  const bool sized = !ignored;
  if (sized && size > limit) refuse_size(file, what, limit);
  // Read to the end whatever the size said: devices and pipes have none.
  for (char block[65536];;) {
    errno = 0;
    const std::size_t count = std::fread(block, 1, sizeof block, stream.get());
    text.append(block, count);
    if (text.size() == count) {  // the first
      const std::string_view begin(text);
      const auto first = std::min(begin.find_first_not_of(" \t\r\n"), begin.size());
      if (!begin.substr(first).starts_with(beginning)) return text;
      if (sized) text.reserve(static_cast<std::size_t>(size));
    }
    if (text.size() > limit) refuse_size(file, what, limit);
    if (count < sizeof block) {
      if (std::ferror(stream.get()) != 0) throw cannot_read(errno);
      return text;
    }
  }
}

void book_file(const std::filesystem::path& file, MemoryBudget& memory) {
  std::error_code unsized;
  const auto size = static_cast<double>(std::filesystem::file_size(file, unsized));
  if (unsized) return;
  try {
    memory.take(size, "the file's bytes", "take a smaller file");
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace rheo
