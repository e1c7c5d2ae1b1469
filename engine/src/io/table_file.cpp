#include "io/table_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "io/message.hpp"
#include "io/read_file.hpp"
#include "rheo/error.hpp"

namespace rheo {
namespace {

constexpr std::size_t most_bytes = std::size_t{64} << 20;

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::optional<double> number_in(std::string_view field) {
  if (field.size() > 1 && field[0] == '+' && field[1] != '-') field.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) return std::nullopt;
  return value;
}

// As laboratories write it: a semicolon goes before a comma, which may be a decimal one then, and is refused
// as such.
char separator_of(std::string_view line) {
  for (const char separator : {';', ',', '\t'})
    if (line.find(separator) != std::string_view::npos) return separator;
  return ',';
}

// Up to one more field than wanted, so that a line of any length costs no more.
std::vector<std::string_view> split(std::string_view line, std::size_t columns) {
  const char separator = separator_of(line);
  std::vector<std::string_view> fields;
  while (fields.size() <= columns) {
    const auto end = line.find(separator);
    fields.push_back(trim(line.substr(0, end)));
    if (end == std::string_view::npos) break;
    line.remove_prefix(end + 1);
  }
  return fields;
}

}  // namespace

NumberTable parse_table(std::string_view text, const std::string& name, std::size_t columns,
                        std::string_view form) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
  NumberTable table;
  bool header_allowed = true;
  int number = 0;
  while (!text.empty()) {
    const auto end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++number;
    line = trim(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    const auto refuse = [&](const std::string& what) {
      throw Error(
          Error::Kind::input,
          fmt::format("{}:{}: {}: {} are needed ({}, separated by commas, semicolons or tabs)", name, number,
                      what, columns == 1 ? "1 number" : fmt::format("{} numbers", columns), form));
    };
    const auto fields = split(line, columns);
    // A row with one number in it is a mistyped row, not a header.
    const bool header = header_allowed && std::none_of(fields.begin(), fields.end(), number_in) &&
                        (fields[0].empty() || fields[0][0] == '"' ||
                         std::isalpha(static_cast<unsigned char>(fields[0][0])) != 0);
    header_allowed = false;
    if (header && fields.size() == columns) continue;
    if (fields.size() != columns) {
      const std::size_t count = std::min(fields.size(), columns);
      refuse(fmt::format("{} has {} {} column{}", in_quotes(line, 40),
                         fields.size() > columns ? "more than" : "only", count, count == 1 ? "" : "s"));
    }
    std::vector<double> row;
    row.reserve(columns);
    for (const std::string_view field : fields) {
      const auto value = number_in(field);
      if (!value || !std::isfinite(*value))
        refuse(fmt::format("{} is no finite number", in_quotes(field, 40)));
      row.push_back(*value);
    }
    table.rows.push_back(std::move(row));
    table.lines.push_back(number);
  }
  if (table.rows.empty()) {
    throw Error(Error::Kind::input, fmt::format("{}:{}: no numbers: at least one row ({}) is needed", name,
                                                std::max(1, number), form));
  }
  return table;
}

NumberTable read_table(const std::filesystem::path& file, std::size_t columns, std::string_view form,
                       MemoryBudget& memory) {
  // A row's own memory, its line, and the key or point that it becomes.
  const double bytes_a_row = 120.0 + 16.0 * static_cast<double>(columns);
  book_file(file, memory);
  const std::string text = read_file(file, "table", most_bytes);
  const auto rows = 1.0 + static_cast<double>(std::count(text.begin(), text.end(), '\n'));
  try {
    memory.take(bytes_a_row * rows, fmt::format("{:.0f} rows", rows), "take fewer");
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}: {}", file.string(), error.what()));
  }
  return parse_table(text, file.string(), columns, form);
}

}  // namespace rheo
