// A whole file into memory.
//
// Errors   Error::Kind::file where it cannot be opened or read (a folder too); Error::Kind::input where it is
// longer
//          than `limit` bytes, noticed before more than that is held
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "memory_budget.hpp"

namespace rheo {

// `what` names the kind of file in messages: "scene", "mesh", "table". Of a file that does not begin with
// `beginning` (blanks apart) only the first piece is read: enough to say what it is not.
std::string read_file(const std::filesystem::path& file, const std::string& what, std::size_t limit,
                      std::string_view beginning = {});

// Books what a file's bytes take, where it has a size. Refusals name the file.
void book_file(const std::filesystem::path& file, MemoryBudget& memory);

}  // namespace rheo
