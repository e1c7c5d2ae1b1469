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

// Where the text that begins with the quotes at `begin` ends: behind its last quote, or where it breaks off.
std::size_t end_of_text(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string three(3, quote);
  const bool long_form = text.substr(begin, 3) == three;
  for (std::size_t i = begin + (long_form ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (!long_form && (text[i] == quote || text[i] == '\n')) {
      return text[i] == quote ? i + 1 : i;
    } else if (long_form && text.substr(i, 3) == three) {
      i += 3;
      for (int more = 0; more < 2 && i < text.size() && text[i] == quote; ++more)
        ++i;  // quotes before the last three
      return i;
    }
  }
  return text.size();
}

// Refuses what the library does not stand, outside of texts and comments:
// - characters beyond ASCII, which no valid TOML has there (some lead to undefined behaviour in version 3.3);
// - keys of very many parts: tables nest as deeply, and are taken apart recursively.
void check_characters(std::string_view text, const std::string& name) {
  constexpr int most_parts = 1000;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  int dots = 0;
  int line = 1;
  const auto refuse = [&](const std::string& what) {
    throw Error(Error::Kind::input, fmt::format("{}:{}: not valid TOML: {}", name, line, what));
  };
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (c == '"' || c == '\'') {
      const std::size_t end = end_of_text(text, i);
      const std::string_view skipped = text.substr(i, end - i);
      line += static_cast<int>(std::count(skipped.begin(), skipped.end(), '\n'));
      i = end - 1;
    } else if (static_cast<unsigned char>(c) >= 0x80) {
      refuse(fmt::format("{}: characters beyond ASCII are allowed in quotes and comments only",
                         in_quotes(text.substr(i, 4), 12)));
    } else if (c == '.' && ++dots > most_parts) {
      refuse(fmt::format("a key of more than {} parts", most_parts));
    }
    if (c == '\n') ++line;
    if (c == '\n' || c == ',' || c == '=' || c == '[' || c == '{') dots = 0;
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
  check_characters(text, name);
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
