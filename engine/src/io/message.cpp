#include "io/message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace rheo {
namespace {

// Bytes of the valid UTF-8 sequence at the front of `text`; 0 where there is none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  return length;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

}  // namespace

std::string one_line(std::string_view text, std::size_t most) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const auto first = static_cast<unsigned char>(text[0]);
    const bool printable = length > 1
                               ? !(length == 2 && first == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0)
                               : length == 1 && first >= 0x20 && first != 0x7F;
    const std::string piece = printable ? std::string(text.substr(0, length))
                                        : fmt::format("\\x{:02X}", static_cast<unsigned>(first));
    if (result.size() + piece.size() > most) return result + "...";
    result += piece;
    text.remove_prefix(printable ? length : 1);
  }
  return result;
}

std::string in_quotes(std::string_view text, std::size_t most) {
  return '"' + one_line(text, most) + '"';
}

std::string word_list(std::span<const std::string> words, std::string_view last) {
  constexpr std::size_t shown = 12;
  std::string result;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i == shown) return result + fmt::format(" and {} more", words.size() - shown);
    if (i > 0) result += i + 1 == words.size() ? fmt::format(" {} ", last) : ", ";
    result += in_quotes(words[i]);
  }
  return result;
}

std::string nearest_word(std::string_view word, std::span<const std::string> known) {
  constexpr std::size_t longest = 64;  // no slip of the pen is longer, and the distance costs length squared
  if (word.size() > longest) return {};
  std::string best;
  std::size_t smallest = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    if (candidate.size() > longest) continue;
    const std::size_t distance = edit_distance(lower(word), lower(candidate));
    if (distance < smallest && distance < candidate.size()) {
      smallest = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace rheo
