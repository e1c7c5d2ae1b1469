// Text of a scene, a mesh or a path, fit for a terminal: control characters, which would colour it, clear it
// or break the line, as \xNN.
//
// Not here  bytes that are no UTF-8: a path may hold them, and no terminal obeys them
#pragma once

#include <string>
#include <string_view>

namespace app {

std::string printable(std::string_view text);

}  // namespace app
