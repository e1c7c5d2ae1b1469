#include "io/msh_input.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>

#include "io/message.hpp"
#include "rheo/error.hpp"

namespace rheo {
namespace {

constexpr std::string_view blanks = " \t\r\n";

}  // namespace

std::string_view MshInput::line() {
  skip_blanks();
  const std::string_view all = rest();
  std::string_view text = all.substr(0, all.find('\n'));
  position_ += text.size();
  const auto last = text.find_last_not_of(blanks);
  return text.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

void MshInput::pass_line_end() {
  if (rest().starts_with('\r')) ++position_;
  if (rest().starts_with('\n')) ++position_;
}

void MshInput::skip_section(std::string_view section) {
  const std::string end = fmt::format("\n$End{}", section);
  const auto found = bytes_.find(end, position_);
  if (found == std::string::npos) refuse("the file ends before $End{}", one_line(section));
  position_ = found + end.size();
}

void MshInput::end_section(std::string_view section) {
  const std::string_view text = line();
  if (text == fmt::format("$End{}", section)) return;
  if (text.empty()) refuse("the file ends before $End{}", section);
  refuse("{} where $End{} is expected: the counts do not fit the contents", in_quotes(text, 30), section);
}

int MshInput::integer(const char* what) {
  return number<int>(what);
}
std::int64_t MshInput::size(const char* what) {
  return number<std::int64_t>(what);
}
double MshInput::real(const char* what) {
  return number<double>(what);
}

void MshInput::read_byte_order() {
  encoding_ = Encoding::binary;
  const int one = binary<int>("the byte order");
  if (one == 1) return;
  if (one == 1 << 24) {
    encoding_ = Encoding::binary_swapped;
    return;
  }
  refuse("the byte order mark is {}: a binary MSH file has the number 1 here in one byte order or the other",
         one);
}

std::size_t MshInput::count_integer(const char* what, std::size_t bytes, std::size_t numbers) {
  return checked_count(integer(what), what, bytes, numbers);
}

std::size_t MshInput::count_size(const char* what, std::size_t bytes, std::size_t numbers) {
  return checked_count(size(what), what, bytes, numbers);
}

std::size_t MshInput::checked_count(std::int64_t count, const char* what, std::size_t bytes,
                                    std::size_t numbers) {
  const std::size_t left = bytes_.size() - position_;
  const std::size_t each = is_text() ? 2 * numbers : bytes;  // a digit and a blank
  if (count < 0) refuse("{} = {}: it cannot be negative", what, count);
  if (each > 0 && static_cast<std::uint64_t>(count) > left / each) {
    refuse("{} = {}: the {} bytes left in the file cannot hold so many; it is damaged or cut short", what,
           count, left);
  }
  return static_cast<std::size_t>(count);
}

void MshInput::skip_blanks() {
  while (position_ < bytes_.size() && blanks.find(bytes_[position_]) != std::string_view::npos) ++position_;
  begin_ = position_;
}

std::string_view MshInput::token(const char* what) {
  skip_blanks();
  while (position_ < bytes_.size() && blanks.find(bytes_[position_]) == std::string_view::npos) ++position_;
  if (position_ == begin_) refuse("the file ends where {} is expected", what);
  return std::string_view(bytes_).substr(begin_, position_ - begin_);
}

template <typename T>
T MshInput::binary(const char* what) {
  begin_ = position_;
  if (bytes_.size() - position_ < sizeof(T)) refuse("the file ends where {} is expected", what);
  char raw[sizeof(T)];
  std::memcpy(raw, bytes_.data() + position_, sizeof(T));
  if (encoding_ == Encoding::binary_swapped) std::reverse(raw, raw + sizeof(T));
  position_ += sizeof(T);
  return std::bit_cast<T>(raw);
}

template <typename T>
T MshInput::number(const char* what) {
  if (!is_text()) return binary<T>(what);
  const std::string_view text = token(what);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const char* const kind = std::is_integral_v<T> ? "whole " : "";
  if (error == std::errc::result_out_of_range)
    refuse("{} = {}: a {}number from {} to {} is needed", what, in_quotes(text, 30), kind,
           std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max());
  if (error != std::errc{} || end != text.data() + text.size()) {
    refuse("{} where {} is expected: a {}number is needed", in_quotes(text, 30), what, kind);
  }
  return value;
}

void MshInput::refuse_text(const std::string& text) const {
  if (!is_text()) throw Error(Error::Kind::input, fmt::format("{}: byte {}: {}", name_, begin_, text));
  const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(std::min(begin_, bytes_.size()));
  throw Error(Error::Kind::input,
              fmt::format("{}:{}: {}", name_, 1 + std::count(bytes_.begin(), end, '\n'), text));
}

}  // namespace rheo
