#include "io/table_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/message.hpp"
#include "rheo/error.hpp"
#include "rheo/limits.hpp"

namespace rheo {

namespace {

std::string joined(std::span<const std::string> words, std::string_view separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : std::string(separator)) + word;
  return text;
}

}  // namespace

bool NumberRule::admits(double value) const {
  if (std::isnan(value)) return false;
  if (std::isinf(value) && !(infinite_allowed && value > 0.0)) return false;
  return (low_allowed ? value >= low : value > low) && value <= high;
}

std::string NumberRule::size_complaint(double value) const {
  if (std::isinf(value)) return {};
  if (low == 0.0 && !low_allowed && !of_usable_size(value)) {
    return fmt::format("{:g} to {:g} is allowed ({}){}", smallest_size, largest_size, unit,
                       infinite_allowed ? ", and inf" : "");
  }
  if (!within_size(value)) return fmt::format("numbers of at most {:g} in size are allowed", largest_size);
  return {};
}

std::string NumberRule::allowed() const {
  std::string text = infinite_allowed ? "a number" : "a finite number";
  if (std::isfinite(low)) text += fmt::format(" {} {}", low_allowed ? ">=" : ">", low);
  if (std::isfinite(high)) text += fmt::format("{} <= {}", std::isfinite(low) ? " and" : "", high);
  if (infinite_allowed) text += " or inf";
  if (*unit != '\0') text += fmt::format(" ({})", unit);
  return text;
}

TableReader::TableReader(const TomlValue& table, std::string file, std::string header, int line,
                         std::vector<std::string> keys)
    : table_(table), file_(std::move(file)), header_(std::move(header)), line_(line) {
  if (table.type != TomlValue::Type::table) refuse(fmt::format("= {}: a table is needed", written(table)));
  for (const TomlEntry& entry : table.entries) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
    const std::string near = nearest_word(entry.key, keys);
    const std::string hint = near.empty() ? fmt::format("known here: {}", joined(keys, ", "))
                                          : fmt::format("did you mean {}?", near);
    throw Error(Error::Kind::input,
                fmt::format("{}:{}: {}{}{} = {}: unknown key; {}", file_, entry.line, header_,
                            header_.empty() ? "" : " ", one_line(entry.key), written(entry.value), hint));
  }
}

const TomlValue* TableReader::find(std::string_view key) const {
  const TomlEntry* entry = table_.find(key);
  return entry == nullptr ? nullptr : &entry->value;
}

const TomlValue& TableReader::require(std::string_view key, std::string_view meaning) const {
  if (const TomlValue* value = find(key)) return *value;
  refuse(fmt::format("{} is missing: {}", key, meaning));
}

std::string TableReader::exactly_one(std::span<const std::string> keys) const {
  const std::string* found = nullptr;
  for (const std::string& key : keys) {
    const TomlValue* value = find(key);
    if (value == nullptr) continue;
    if (found != nullptr) {
      refuse(key, *value,
             fmt::format("{} is there too; exactly one of {} is allowed", *found, joined(keys, ", ")));
    }
    found = &key;
  }
  if (found == nullptr)
    refuse(fmt::format("{} is missing: exactly one of them is needed", joined(keys, " or ")));
  return *found;
}

double TableReader::number(std::string_view key, const NumberRule& rule, double otherwise) const {
  const TomlValue* value = find(key);
  return value == nullptr ? otherwise : number(key, *value, rule);
}

double TableReader::number(std::string_view key, const TomlValue& value, const NumberRule& rule) const {
  if (!value.is_number() || !rule.admits(value.number)) refuse(key, value, rule.allowed() + " is needed");
  check_size(key, value, rule, value.number);
  return value.number;
}

double TableReader::required_number(std::string_view key, const NumberRule& rule,
                                    std::string_view meaning) const {
  require(key, fmt::format("{}, {}, is needed", meaning, rule.allowed()));
  return number(key, rule, 0.0);
}

std::string TableReader::text(std::string_view key, const std::string& otherwise) const {
  const TomlValue* value = find(key);
  if (value == nullptr) return otherwise;
  if (value->type != TomlValue::Type::string) refuse(key, *value, "a text in quotes is needed");
  return value->text;
}

std::size_t TableReader::choice(std::string_view key, std::span<const std::string> choices,
                                std::size_t otherwise) const {
  const TomlValue* value = find(key);
  if (value == nullptr) return otherwise;
  if (value->type == TomlValue::Type::string) {
    const auto found = std::find(choices.begin(), choices.end(), value->text);
    if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  }
  refuse(key, *value, word_list(choices) + " is allowed");
}

Vec2 TableReader::pair(std::string_view key, const NumberRule& rule, Vec2 otherwise) const {
  const TomlValue* value = find(key);
  return value == nullptr ? otherwise : pair(key, *value, rule);
}

Vec2 TableReader::pair(std::string_view key, const TomlValue& value, const NumberRule& rule) const {
  const bool fits = value.type == TomlValue::Type::array && value.items.size() == 2 &&
                    std::all_of(value.items.begin(), value.items.end(), [&](const TomlValue& item) {
                      return item.is_number() && rule.admits(item.number);
                    });
  if (!fits) refuse(key, value, fmt::format("[x, y], each {}, is needed", rule.allowed()));
  for (const TomlValue& item : value.items) check_size(key, value, rule, item.number);
  return {value.items[0].number, value.items[1].number};
}

NumberTable TableReader::rows(std::string_view key, const TomlValue& value, std::size_t columns,
                              std::string_view form) const {
  if (value.type != TomlValue::Type::array || value.items.empty()) {
    refuse(key, value, fmt::format("a list of one or more {} is needed", form));
  }
  NumberTable table;
  table.rows.reserve(value.items.size());
  table.lines.reserve(value.items.size());
  for (const TomlValue& item : value.items) {
    const bool fits = item.type == TomlValue::Type::array && item.items.size() == columns &&
                      std::all_of(item.items.begin(), item.items.end(), [](const TomlValue& v) {
                        return v.is_number() && std::isfinite(v.number);
                      });
    if (!fits) {
      refuse(fmt::format("{}[{}]", key, table.rows.size()), item,
             fmt::format("{} of finite numbers is needed", form));
    }
    std::vector<double> row;
    row.reserve(columns);
    for (const TomlValue& v : item.items) {
      check_size(fmt::format("{}[{}]", key, table.rows.size()), item, {}, v.number);
      row.push_back(v.number);
    }
    table.rows.push_back(std::move(row));
    table.lines.push_back(item.line);
  }
  return table;
}

std::vector<std::vector<int>> TableReader::integer_rows(std::string_view key, const TomlValue& value,
                                                        std::size_t columns, int low, int high,
                                                        std::string_view form) const {
  if (value.type != TomlValue::Type::array || value.items.empty()) {
    refuse(key, value, fmt::format("a list of one or more {} is needed", form));
  }
  std::vector<std::vector<int>> result;
  result.reserve(value.items.size());
  for (const TomlValue& item : value.items) {
    const bool fits = item.type == TomlValue::Type::array && item.items.size() == columns &&
                      std::all_of(item.items.begin(), item.items.end(), [&](const TomlValue& v) {
                        return v.type == TomlValue::Type::integer && v.integer >= low && v.integer <= high;
                      });
    if (!fits) {
      refuse(fmt::format("{}[{}]", key, result.size()), item,
             fmt::format("{} of node numbers from {} to {} is needed", form, low, high));
    }
    std::vector<int> row;
    row.reserve(columns);
    for (const TomlValue& v : item.items) row.push_back(static_cast<int>(v.integer));
    result.push_back(std::move(row));
  }
  return result;
}

void TableReader::refuse_text(std::string_view key, const std::string& value, std::string_view text) const {
  if (const TomlValue* given = find(key)) refuse(key, *given, text);
  refuse(fmt::format("{} = {}, the default: {}", key, in_quotes(value), text));
}

int TableReader::integer(std::string_view key, const TomlValue& value, int low, int high,
                         std::string_view what) const {
  if (value.type != TomlValue::Type::integer || value.integer < low || value.integer > high) {
    refuse(key, value, fmt::format("a {} from {} to {} is needed", what, low, high));
  }
  return static_cast<int>(value.integer);
}

void TableReader::check_size(std::string_view key, const TomlValue& value, const NumberRule& rule,
                             double number) const {
  if (const std::string complaint = rule.size_complaint(number); !complaint.empty())
    refuse(key, value, complaint);
}

void TableReader::locate(const std::function<void()>& check) const {
  try {
    check();
  } catch (const Error& error) {
    const std::string_view message = error.what();
    int line = line_;
    if (message.starts_with(header_ + " ")) {
      const std::string_view rest = message.substr(header_.size() + 1);
      if (const TomlValue* value = find(rest.substr(0, rest.find(' ')))) line = value->line;
    }
    throw Error(error.kind(), fmt::format("{}:{}: {}", file_, line, message));
  }
}

void TableReader::attribute(std::string_view key, const TomlValue& value,
                            const std::function<void()>& read) const {
  try {
    read();
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}:{}: {} {} = {}: {}", file_, value.line, header_, key,
                                          written(value), error.what()));
  }
}

void TableReader::refuse(std::string_view key, const TomlValue& value, std::string_view text) const {
  throw Error(Error::Kind::input, fmt::format("{}:{}: {}{}{} = {}: {}", file_, value.line, header_,
                                              header_.empty() ? "" : " ", key, written(value), text));
}

void TableReader::refuse(std::string_view text) const {
  throw Error(Error::Kind::input, fmt::format("{} {}", where(), text));
}

std::string TableReader::where() const {
  return fmt::format("{}:{}: {}", file_, line_, header_);
}

std::string TableReader::where(const TomlValue& value) const {
  return fmt::format("{}:{}: {}", file_, value.line, header_);
}

const std::vector<TomlValue>& tables_of(const TomlValue* list, const std::string& file,
                                        const std::string& name) {
  static const std::vector<TomlValue> none;
  if (list == nullptr) return none;
  const auto refuse = [&](int line, const TomlValue& value) {
    throw Error(Error::Kind::input,
                fmt::format("{}:{}: {} = {}: several of them are allowed, so write [[{}]]", file, line, name,
                            written(value), name));
  };
  if (list->type != TomlValue::Type::array) refuse(list->line, *list);
  for (const TomlValue& item : list->items) {
    if (item.type != TomlValue::Type::table) refuse(item.line, item);
  }
  return list->items;
}

}  // namespace rheo
