// fmt's own code, for the whole engine. It is part of the library, so that a consumer neither needs fmt nor
// collides with the one it has: the symbols are weak, as of all inline functions.
#include <fmt/format.h>

namespace {

// fmt::format is a call of this; being used keeps it and what it calls.
[[gnu::used]] std::string (*const kept)(fmt::string_view, fmt::format_args) = &fmt::vformat;

}  // namespace
