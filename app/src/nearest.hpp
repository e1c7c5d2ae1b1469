// The known word that a misspelt one probably means.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace app {

// The candidate with the fewest edits (insert, delete, replace), or "" where none is within a third of its
// length + 1.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

}  // namespace app
