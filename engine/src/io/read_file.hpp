// A whole file into memory.
//
// Errors   Error::Kind::file where it cannot be opened or read (a folder too); Error::Kind::input where it is
// longer
//          than `limit` bytes, noticed before more than that is held
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace rheo {

// `what` names the kind of file in messages: "scene", "mesh", "table".
std::string read_file(const std::filesystem::path& file, const std::string& what, std::size_t limit);

}  // namespace rheo
