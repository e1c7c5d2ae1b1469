// The bytes of a Gmsh file, read number by number: text or binary of either byte order behind the same calls.
//
// Errors   Error::Kind::input, "file:line: ..." in text, "file: byte N: ..." in binary: a file that ends
// early, something
//          that is no number, a count that the rest of the file cannot hold (before memory is asked for)
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace rheo {

class MshInput {
 public:
  MshInput(std::string bytes, std::string name) : bytes_(std::move(bytes)), name_(std::move(name)) {}

  enum class Encoding { text, binary, binary_swapped };
  void set_encoding(Encoding encoding) { encoding_ = encoding; }
  bool is_text() const { return encoding_ == Encoding::text; }

  std::string_view rest() const { return std::string_view(bytes_).substr(position_); }
  const std::string& name() const { return name_; }

  // The next line that is not blank, without blanks around it; empty at the end of the file.
  std::string_view line();
  // Passes over the one line end that stands before binary numbers.
  void pass_line_end();
  // $PhysicalNames is text in binary files too.
  Encoding use_text() { return std::exchange(encoding_, Encoding::text); }
  // Passes over everything up to and with the line "$End<section>".
  void skip_section(std::string_view section);
  // Reads the line "$End<section>".
  void end_section(std::string_view section);

  // One number; 4 bytes, 8 bytes and 8 bytes in binary. `what` in messages: "a node's tag".
  int integer(const char* what);
  std::int64_t size(const char* what);
  double real(const char* what);
  // A 4-byte 1 that shows the byte order; sets the encoding.
  void read_byte_order();
  // How many of something; each takes at least `bytes` in binary and `numbers` numbers in text.
  std::size_t count_integer(const char* what, std::size_t bytes, std::size_t numbers);
  std::size_t count_size(const char* what, std::size_t bytes, std::size_t numbers);
  std::size_t checked_count(std::int64_t count, const char* what, std::size_t bytes, std::size_t numbers);

  // Where the last number or line began.
  template <typename... Arguments>
  [[noreturn]] void refuse(fmt::format_string<Arguments...> text, Arguments&&... arguments) const {
    refuse_text(fmt::format(text, std::forward<Arguments>(arguments)...));
  }

 private:
  [[noreturn]] void refuse_text(const std::string& text) const;
  void skip_blanks();
  std::string_view token(const char* what);
  template <typename T>
  T binary(const char* what);
  template <typename T>
  T number(const char* what);

  std::string bytes_;
  std::string name_;
  Encoding encoding_ = Encoding::text;
  std::size_t position_ = 0;
  std::size_t begin_ = 0;  // of the last number or line
};

}  // namespace rheo
