// GLFW's functions, opened when a window is wanted: the program is linked to no window system.
//
// Errors   std::runtime_error, one line that names the Debian package
#pragma once

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace app::view {

#define RHEO_GLFW_FUNCTIONS(X) \
  X(CreateWindow)              \
  X(DestroyWindow)             \
  X(GetCurrentContext)         \
  X(GetError)                  \
  X(GetFramebufferSize)        \
  X(GetMonitorWorkarea)        \
  X(GetMouseButton)            \
  X(GetPrimaryMonitor)         \
  X(GetProcAddress)            \
  X(GetVideoMode)              \
  X(GetWindowAttrib)           \
  X(GetWindowContentScale)     \
  X(GetWindowSize)             \
  X(GetWindowUserPointer)      \
  X(Init)                      \
  X(MakeContextCurrent)        \
  X(PollEvents)                \
  X(PostEmptyEvent)            \
  X(SetCharCallback)           \
  X(SetCursorEnterCallback)    \
  X(SetCursorPosCallback)      \
  X(SetDropCallback)           \
  X(SetKeyCallback)            \
  X(SetMouseButtonCallback)    \
  X(SetScrollCallback)         \
  X(SetWindowFocusCallback)    \
  X(SetWindowTitle)            \
  X(SetWindowSizeLimits)       \
  X(SetWindowUserPointer)      \
  X(SwapBuffers)               \
  X(SwapInterval)              \
  X(Terminate)                 \
  X(WaitEventsTimeout)         \
  X(WindowHint)                \
  X(WindowShouldClose)

struct Glfw {
#define RHEO_GLFW_MEMBER(NAME) decltype(&glfw##NAME) NAME = nullptr;
  RHEO_GLFW_FUNCTIONS(RHEO_GLFW_MEMBER)
#undef RHEO_GLFW_MEMBER
};

// Opened at the first call; it stays open, for drivers do not survive being closed.
const Glfw& glfw();

}  // namespace app::view
