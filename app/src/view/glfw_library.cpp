#include "view/glfw_library.hpp"

#include <dlfcn.h>

#include <stdexcept>

namespace app::view {

namespace {

Glfw open_glfw() {
  void* library = dlopen("libglfw.so.3", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    throw std::runtime_error("GLFW cannot be loaded (libglfw.so.3): install the Debian package libglfw3");
  Glfw functions;
#define RHEO_GLFW_LOAD(NAME)                                                              \
  functions.NAME = reinterpret_cast<decltype(&glfw##NAME)>(dlsym(library, "glfw" #NAME)); \
  if (!functions.NAME)                                                                    \
    throw std::runtime_error("GLFW has no function glfw" #NAME ": install the Debian package libglfw3");
  RHEO_GLFW_FUNCTIONS(RHEO_GLFW_LOAD)
#undef RHEO_GLFW_LOAD
  return functions;
}

}  // namespace

const Glfw& glfw() {
  static const Glfw functions = open_glfw();
  return functions;
}

}  // namespace app::view
