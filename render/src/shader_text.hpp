// GLSL files of shaders/, embedded at build time.
#pragma once

#include <string_view>

namespace render {

// The text of a file, by its name ("mesh.vert"); empty when there is none.
std::string_view embedded_shader(std::string_view name);

}  // namespace render
