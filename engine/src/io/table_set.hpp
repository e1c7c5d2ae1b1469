// The tables of one level of a scene file, by name; every complaint is "file:line: [table] ...".
//
// Errors   Error::Kind::input
#pragma once

#include <string>
#include <vector>

#include "io/table_reader.hpp"
#include "io/toml_tree.hpp"

namespace rheo {

class TableSet {
 public:
  // `owner`: what the tables' names begin with; `line`: where the level begins.
  TableSet(const TomlValue& root, const std::string& file, std::string owner, int line)
      : root_(root), file_(file), owner_(std::move(owner)), line_(line) {}

  bool has(const std::string& name) const { return root_.find(name) != nullptr; }
  // [name], empty where it is not there.
  const TomlValue& value_of(const std::string& name) const;
  // `meaning`: what the table has to hold.
  const TomlValue& required_value_of(const std::string& name, const char* meaning) const;
  TableReader table(const std::string& name, std::vector<std::string> keys) const;
  TableReader required_table(const std::string& name, const char* meaning,
                             std::vector<std::string> keys) const;
  // Those of [[name]].
  const std::vector<TomlValue>& list(const std::string& name) const;
  const TomlEntry* find(const std::string& name) const { return root_.find(name); }

 private:
  const TomlValue& root_;
  const std::string& file_;
  std::string owner_;
  int line_;
};

}  // namespace rheo
