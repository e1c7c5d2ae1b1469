#include "printable.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <iterator>

namespace app {

std::string printable(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    // U+0080 to U+009F are control characters too, in UTF-8 C2 and the number itself.
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0;
    const bool two_bytes = byte == 0xC2 && next >= 0x80 && next < 0xA0;
    if (two_bytes) {
      fmt::format_to(std::back_inserter(result), "\\x{:02X}\\x{:02X}", byte, next);
      ++i;
    } else if (byte < 0x20 || byte == 0x7F) {
      fmt::format_to(std::back_inserter(result), "\\x{:02X}", byte);
    } else {
      result += text[i];
    }
  }
  return result;
}

}  // namespace app
