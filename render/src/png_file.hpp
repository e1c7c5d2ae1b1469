// Writes a file whole or not at all: aside as NAME.part, then renamed.
//
// Errors   FileError: the path and the system's reason; nothing is left behind
#pragma once

#include <filesystem>
#include <span>

namespace render {

void write_file_whole(const std::filesystem::path& file, std::span<const unsigned char> bytes);

}  // namespace render
