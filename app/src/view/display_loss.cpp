#include "view/display_loss.hpp"

#include <dlfcn.h>

#include <utility>

namespace app::view {
namespace {

// Of Xlib.h, whose package this needs no more than the library itself: GLFW has opened that.
struct XDisplay;
using ErrorHandler = int (*)(XDisplay*);
using ExitHandler = void (*)(XDisplay*, void*);
using SetErrorHandler = ErrorHandler (*)(ErrorHandler);
using SetExitHandler = void (*)(XDisplay*, ExitHandler, void*);

template <class Function>
Function find(void* library, const char* name) {
  return library == nullptr ? nullptr : reinterpret_cast<Function>(dlsym(library, name));
}

}  // namespace

DisplayLoss::DisplayLoss(std::function<void()> lost) : lost_(std::move(lost)) {
  constexpr int only_if_open = RTLD_NOW | RTLD_NOLOAD;
  void* const glfw = dlopen("libglfw.so.3", only_if_open);
  void* const xlib = dlopen("libX11.so.6", only_if_open);
  const auto x11_display = find<XDisplay* (*)()>(glfw, "glfwGetX11Display");
  const auto set_error_handler = find<SetErrorHandler>(xlib, "XSetIOErrorHandler");
  const auto set_exit_handler = find<SetExitHandler>(xlib, "XSetIOErrorExitHandler");
  if (!x11_display || !set_error_handler || !set_exit_handler) return;
  XDisplay* const display = x11_display();
  if (display == nullptr) return;
  set_error_handler([](XDisplay*) { return 0; });  // in silence
  set_exit_handler(
      display, [](XDisplay*, void* self) { static_cast<DisplayLoss*>(self)->lost_(); }, this);
  undo_ = [=] {
    set_exit_handler(display, nullptr, nullptr);
    set_error_handler(nullptr);
  };
}

DisplayLoss::~DisplayLoss() {
  if (undo_) undo_();
}

}  // namespace app::view
