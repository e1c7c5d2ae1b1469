// Tables of numbers: comma separated values, or the rows of a list in a scene file.
//
// A table file may begin with one line of column names; "#" begins a comment; empty lines are passed over.
//
// Errors   Error::Kind::input, "file:line: ..."; Error::Kind::file where the file cannot be read
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "memory_budget.hpp"

namespace rheo {

struct NumberTable {
  std::vector<std::vector<double>> rows;
  std::vector<int> lines;  // of each row, in its file
};

// At least one row, each of `columns` finite numbers; `form` names them in messages: "t, ux, uy".
// read_table books the memory for it.
NumberTable read_table(const std::filesystem::path& file, std::size_t columns, std::string_view form,
                       MemoryBudget& memory);
NumberTable parse_table(std::string_view text, const std::string& name, std::size_t columns,
                        std::string_view form);

}  // namespace rheo
