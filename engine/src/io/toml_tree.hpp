// A TOML document as a plain tree in which every value and key knows its line.
//
// The TOML library stays behind parse_toml: it compiles slowly and is included in one translation unit.
//
// Errors   Error::Kind::input, "name:line: ..."
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "memory_budget.hpp"

namespace rheo {

struct TomlEntry;

struct TomlValue {
  enum class Type { table, array, string, integer, number, boolean, date };

  Type type = Type::table;
  int line = 1;
  bool is_inline = false;  // a table in braces
  std::string text;        // string: its value; date: as written
  std::int64_t integer = 0;
  double number = 0.0;  // integers too
  bool boolean = false;
  std::vector<TomlValue> items;    // array
  std::vector<TomlEntry> entries;  // table, by key

  bool is_number() const { return type == Type::number || type == Type::integer; }
  const TomlEntry* find(std::string_view key) const;
};

struct TomlEntry {
  std::string key;
  int line = 1;  // of the key
  TomlValue value;
};

// Books the tree's memory before it is built. Refuses keys of more parts and brackets nested deeper than
// most_nested: the library takes its trees apart recursively, and a scene needs three or four.
TomlValue parse_toml(std::string_view text, const std::string& name, MemoryBudget& memory);
// The same within what the machine has available.
TomlValue parse_toml(std::string_view text, const std::string& name);

inline constexpr int most_nested = 32;

// As it would be written, on one line, cut short: 7, "left", [0.5, "x", ...].
std::string written(const TomlValue& value);

// The version of toml++ that reads.
std::string toml_version();

}  // namespace rheo
