// Typed access to one table of a scene file; every complaint is "file:line: [table] key = value: what is
// allowed".
//
// A reader is made with all the keys that its table may have and refuses any other at once, naming the
// nearest.
//
// Errors   Error::Kind::input
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/table_file.hpp"
#include "io/toml_tree.hpp"
#include "rheo/mesh.hpp"

namespace rheo {

// Which numbers a key takes.
struct NumberRule {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_allowed = true;        // low itself
  bool infinite_allowed = false;  // plus infinity
  const char* unit = "";

  bool admits(double value) const;
  // What else is wrong with a value that is admitted: a size that cannot be computed with (limits.hpp).
  // Empty: nothing.
  std::string size_complaint(double value) const;
  std::string allowed() const;  // "a finite number > 0 (Pa s)"
};

class TableReader {
 public:
  // `header` as in the file: "[mesh]", "[[fix]]". `line`: of the header.
  TableReader(const TomlValue& table, std::string file, std::string header, int line,
              std::vector<std::string> keys);

  const TomlValue* find(std::string_view key) const;
  bool has(std::string_view key) const { return find(key) != nullptr; }

  // The value of a key that must be there; `meaning` says what for in the message: "the duration of the run
  // (s)".
  const TomlValue& require(std::string_view key, std::string_view meaning) const;
  // Of `keys`, exactly one must be there; returns which.
  std::string exactly_one(std::span<const std::string> keys) const;

  double number(std::string_view key, const NumberRule& rule, double otherwise) const;
  double number(std::string_view key, const TomlValue& value, const NumberRule& rule) const;
  double required_number(std::string_view key, const NumberRule& rule, std::string_view meaning) const;
  std::string text(std::string_view key, const std::string& otherwise) const;
  // Index of the word among `choices`.
  std::size_t choice(std::string_view key, std::span<const std::string> choices, std::size_t otherwise) const;
  // [x, y] with both components under the rule.
  Vec2 pair(std::string_view key, const NumberRule& rule, Vec2 otherwise) const;
  Vec2 pair(std::string_view key, const TomlValue& value, const NumberRule& rule) const;
  // A list of one or more rows of `columns` finite numbers; `form` in messages: "[x, y]".
  NumberTable rows(std::string_view key, const TomlValue& value, std::size_t columns,
                   std::string_view form) const;
  // The same of whole numbers from low to high.
  std::vector<std::vector<int>> integer_rows(std::string_view key, const TomlValue& value,
                                             std::size_t columns, int low, int high,
                                             std::string_view form) const;
  // One whole number from low to high; `what` in the message: "node number".
  int integer(std::string_view key, const TomlValue& value, int low, int high, std::string_view what) const;

  // Runs `check`; what it refuses as "[table] key = ..." gets the file and the key's line in front.
  void locate(const std::function<void()>& check) const;
  // Runs `read`; what it refuses gets "file:line: [table] key = value: " in front.
  void attribute(std::string_view key, const TomlValue& value, const std::function<void()>& read) const;

  // file:line: [table] key = value: text
  [[noreturn]] void refuse(std::string_view key, const TomlValue& value, std::string_view text) const;
  // The same of a text that may be the default, where the key is not in the file.
  [[noreturn]] void refuse_text(std::string_view key, const std::string& value, std::string_view text) const;
  // file:line: [table] text
  [[noreturn]] void refuse(std::string_view text) const;

  // "file:line: [[fix]]"
  std::string where() const;
  // The same with the line of one of its values.
  std::string where(const TomlValue& value) const;
  const std::string& header() const { return header_; }

 private:
  // Refuses a number under `rule` that stands in `value`.
  void check_size(std::string_view key, const TomlValue& value, const NumberRule& rule, double number) const;

  const TomlValue& table_;
  std::string file_;
  std::string header_;
  int line_;
};

// The tables of [[name]]; null: none.
const std::vector<TomlValue>& tables_of(const TomlValue* list, const std::string& file,
                                        const std::string& name);

}  // namespace rheo
