#include "io/toml_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "io/message.hpp"
#include "rheo/error.hpp"

// Some broken texts fail the library's assertions (a table's name that begins with a strange character, say).
// It goes on to find the mistake and its line when the assertions are empty; with NDEBUG they would become
// assumptions of the optimiser, which may drop just that.
#undef NDEBUG
#define TOML_ASSERT(condition) static_cast<void>(0)
#define TOML_HEADER_ONLY 1
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

namespace rheo {
namespace {

int line_of(const toml::source_region& source) {
  return std::max(1, static_cast<int>(source.begin.line));
}

TomlValue convert(const toml::node& node);

TomlValue convert_table(const toml::table& table) {
  TomlValue value;
  value.is_inline = table.is_inline();
  value.entries.reserve(table.size());
  for (const auto& [key, child] : table) {
    value.entries.push_back({std::string(key.str()), line_of(key.source()), convert(child)});
  }
  // In the order of the file, so that the first mistake is the one reported.
  std::stable_sort(value.entries.begin(), value.entries.end(),
                   [](const TomlEntry& a, const TomlEntry& b) { return a.line < b.line; });
  return value;
}

TomlValue convert(const toml::node& node) {
  TomlValue value;
  if (const auto* table = node.as_table()) value = convert_table(*table);
  if (const auto* array = node.as_array()) {
    value.type = TomlValue::Type::array;
    value.items.reserve(array->size());
    for (const auto& item : *array) value.items.push_back(convert(item));
  }
  if (const auto* text = node.as_string()) {
    value.type = TomlValue::Type::string;
    value.text = text->get();
  }
  if (const auto* integer = node.as_integer()) {
    value.type = TomlValue::Type::integer;
    value.integer = integer->get();
    value.number = static_cast<double>(integer->get());
  }
  if (const auto* number = node.as_floating_point()) {
    value.type = TomlValue::Type::number;
    value.number = number->get();
  }
  if (const auto* boolean = node.as_boolean()) {
    value.type = TomlValue::Type::boolean;
    value.boolean = boolean->get();
  }
  if (node.is_date() || node.is_time() || node.is_date_time()) {
    value.type = TomlValue::Type::date;
    std::ostringstream text;
    if (const auto* date = node.as_date()) text << date->get();
    if (const auto* time = node.as_time()) text << time->get();
    if (const auto* both = node.as_date_time()) text << both->get();
    value.text = text.str();
  }
  value.line = line_of(node.source());
  return value;
}

// Tables nest as deeply as a dotted key has parts, and are taken apart recursively: a key of a million parts
// must not get that far. Dots that nothing but names and blanks separate are counted; a number array has
// commas between.
void refuse_endless_keys(std::string_view text, const std::string& name) {
  constexpr int most_parts = 1000;
  int dots = 0;
  int line = 1;
  for (const char c : text) {
    if (c == '\n') ++line;
    if (c == '\n' || c == ',' || c == '=' || c == '[' || c == '{') dots = 0;
    if (c == '.' && ++dots > most_parts) {
      throw Error(
          Error::Kind::input,
          fmt::format("{}:{}: not valid TOML: more than {} dots in one key or text", name, line, most_parts));
    }
  }
}

}  // namespace

const TomlEntry* TomlValue::find(std::string_view key) const {
  for (const TomlEntry& entry : entries) {
    if (entry.key == key) return &entry;
  }
  return nullptr;
}

TomlValue parse_toml(std::string_view text, const std::string& name) {
  if (const auto zero = text.find('\0'); zero != std::string_view::npos) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n');
    throw Error(Error::Kind::input,
                fmt::format("{}:{}: a zero byte: this is no text file; a TOML text is needed", name, line));
  }
  refuse_endless_keys(text, name);
  try {
    const toml::table document = toml::parse(text, std::string_view(name));
    return convert_table(document);
  } catch (const toml::parse_error& error) {
    throw Error(Error::Kind::input, fmt::format("{}:{}: not valid TOML: {}", name, line_of(error.source()),
                                                one_line(error.description(), 200)));
  }
}

std::string written(const TomlValue& value) {
  constexpr std::size_t most = 60;
  switch (value.type) {
    case TomlValue::Type::table:
      return value.is_inline ? "{...}" : "a table";
    case TomlValue::Type::string:
      return in_quotes(value.text, most);
    case TomlValue::Type::date:
      return value.text;
    case TomlValue::Type::boolean:
      return value.boolean ? "true" : "false";
    case TomlValue::Type::integer:
      return fmt::format("{}", value.integer);
    case TomlValue::Type::number: {
      const std::string digits = fmt::format("{}", value.number);
      const bool whole = std::isfinite(value.number) && digits.find_first_of(".e") == std::string::npos;
      return whole ? digits + ".0" : digits;
    }
    case TomlValue::Type::array:
      break;
  }
  std::string text = "[";
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    if (i > 0) text += ", ";
    if (text.size() > most) return text + "...]";
    text += written(value.items[i]);
  }
  return text + "]";
}

}  // namespace rheo
