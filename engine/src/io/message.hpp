// Pieces of error messages: user's text on one line, sizes, the nearest known word.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace rheo {

// A user's text fit for one line of a message: control and non-ASCII-safe bytes as \xNN (valid UTF-8 stays),
// cut to `most` bytes with "..." behind.
std::string one_line(std::string_view text, std::size_t most = 60);

// The same in double quotes.
std::string in_quotes(std::string_view text, std::size_t most = 60);

// "left", "right" or "top"; `last` stands before the last word.
std::string word_list(std::span<const std::string> words, std::string_view last = "or");

// The known word with the smallest edit distance, where that is small enough to be a slip (at most a third of
// the letters, at least 2; equal but for upper and lower case counts as a slip too); else empty.
std::string nearest_word(std::string_view word, std::span<const std::string> known);

}  // namespace rheo
