// Names of quantities as a paper sets them: "|w_lambda|" becomes |w| with a small lambda, "10^-3" a raised
// exponent.
//
// After `_` or `^` a run in braces, or letters and digits (after `^` also a sign), is set lower or higher;
// whole words that name a Greek letter become it. Anything else stays as it is.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace render {

enum class Level { lower, base, raised };

struct Run {
  std::string text;
  Level level = Level::base;
};

std::vector<Run> typeset(std::string_view label);

// Every character that typeset() may bring in by itself.
std::string_view typeset_characters();

}  // namespace render
