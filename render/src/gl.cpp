#include "gl.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace render {

Gl load_gl(const std::function<GlFunction(const char*)>& find) {
  Gl gl;
#define RHEO_GL_LOAD(TYPE, NAME)                                   \
  gl.NAME = reinterpret_cast<PFNGL##TYPE##PROC>(find("gl" #NAME)); \
  if (!gl.NAME)                                                    \
    throw std::runtime_error("the OpenGL driver has no function gl" #NAME "; OpenGL 3.3 is needed");
  RHEO_GL_FUNCTIONS(RHEO_GL_LOAD)
#undef RHEO_GL_LOAD
  return gl;
}

}  // namespace render
