// Stands in for view.cpp in a build without the window.
#include "failure.hpp"
#include "view/view.hpp"

namespace app {

void view_scene(const Options&) {
  throw Failure(
      ExitCode::usage,
      "view: this build of rheo has no window (configured with RHEO_WINDOW=OFF or without GLFW): use rheo "
      "render, or install the Debian package libglfw3-dev and build again");
}

}  // namespace app
