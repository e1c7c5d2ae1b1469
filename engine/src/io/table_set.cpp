#include "io/table_set.hpp"

#include <fmt/format.h>

#include <utility>

#include "rheo/error.hpp"

namespace rheo {

const TomlValue& TableSet::value_of(const std::string& name) const {
  static const TomlValue empty;
  const TomlEntry* entry = root_.find(name);
  if (entry == nullptr) return empty;
  if (entry->value.type == TomlValue::Type::array) {
    throw Error(Error::Kind::input, fmt::format("{}:{}: {}{} is a list: one table, [{}{}], is needed", file_,
                                                entry->line, owner_, name, owner_, name));
  }
  return entry->value;
}

const TomlValue& TableSet::required_value_of(const std::string& name, const char* meaning) const {
  if (root_.find(name) == nullptr) {
    throw Error(Error::Kind::input,
                fmt::format("{}:{}: [{}{}] is missing; needed: {}", file_, line_, owner_, name, meaning));
  }
  return value_of(name);
}

TableReader TableSet::table(const std::string& name, std::vector<std::string> keys) const {
  const TomlValue& value = value_of(name);
  return TableReader(value, file_, fmt::format("[{}{}]", owner_, name), value.line, std::move(keys));
}

TableReader TableSet::required_table(const std::string& name, const char* meaning,
                                     std::vector<std::string> keys) const {
  required_value_of(name, meaning);
  return table(name, std::move(keys));
}

const std::vector<TomlValue>& TableSet::list(const std::string& name) const {
  const TomlEntry* entry = root_.find(name);
  return tables_of(entry == nullptr ? nullptr : &entry->value, file_, owner_ + name);
}

}  // namespace rheo
