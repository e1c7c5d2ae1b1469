#include "view/glfw_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "view/glfw_library.hpp"

namespace app::view {
namespace {

constexpr int least_width = 300, least_height = 200;

InputQueue& events_of(GLFWwindow* window) {
  return *static_cast<InputQueue*>(glfw().GetWindowUserPointer(window));
}

std::string last_error() {
  const char* text = nullptr;
  glfw().GetError(&text);
  return text != nullptr ? text : "no reason given";
}

}  // namespace

GlfwWindow::Library::Library() {
  if (glfw().Init() == GLFW_FALSE) throw std::runtime_error(fmt::format("no display ({})", last_error()));
}
GlfwWindow::Library::~Library() {
  glfw().Terminate();
}

GlfwWindow::GlfwWindow(const std::string& title, int width, int height) {
  glfw().WindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfw().WindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfw().WindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfw().WindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfw().WindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfw().WindowHint(GLFW_SAMPLES, 0);
  GLFWmonitor* monitor = glfw().GetPrimaryMonitor();
  if (monitor != nullptr) {
    int x = 0, y = 0, w = 0, h = 0;
    glfw().GetMonitorWorkarea(monitor, &x, &y, &w, &h);
    if (w > least_width && h > least_height) {
      width = std::min(width, w);
      height = std::min(height, h);
    }
    if (const GLFWvidmode* mode = glfw().GetVideoMode(monitor); mode != nullptr && mode->refreshRate > 0)
      period_ = 1.0 / mode->refreshRate;
  }
  window_ = glfw().CreateWindow(std::max(width, least_width), std::max(height, least_height), title.c_str(),
                                nullptr, nullptr);
  if (window_ == nullptr)
    throw std::runtime_error(fmt::format("no window with OpenGL 3.3 ({})", last_error()));
  glfw().SetWindowSizeLimits(window_, least_width, least_height, GLFW_DONT_CARE, GLFW_DONT_CARE);
  float sx = 1.0f, sy = 1.0f;
  glfw().GetWindowContentScale(window_, &sx, &sy);
  scale_ = std::clamp(std::max(sx, sy), 0.75f, 4.0f);
  try {
    context_ = render::adopt_context(
        [](const char* name) {
          return reinterpret_cast<render::FunctionAddress>(glfw().GetProcAddress(name));
        },
        [window = window_] {
          if (glfw().GetCurrentContext() != window) glfw().MakeContextCurrent(window);
        },
        "GLFW", width, height);
  } catch (...) {
    glfw().DestroyWindow(window_);
    throw;
  }
  glfw().SwapInterval(1);
  install_callbacks();
}

GlfwWindow::~GlfwWindow() {
  context_.reset();
  glfw().DestroyWindow(window_);
}

void GlfwWindow::install_callbacks() {
  using Kind = Event::Kind;
  glfw().SetWindowUserPointer(window_, &events_);
  glfw().SetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
    int ww = 1, wh = 1, fw = 1, fh = 1;
    glfw().GetWindowSize(w, &ww, &wh);
    glfw().GetFramebufferSize(w, &fw, &fh);
    events_of(w).push({Kind::cursor,
                       0,
                       false,
                       static_cast<float>(x * fw / std::max(ww, 1)),
                       static_cast<float>(y * fh / std::max(wh, 1)),
                       {}});
  });
  glfw().SetCursorEnterCallback(window_, [](GLFWwindow* w, int entered) {
    if (entered == GLFW_FALSE && glfw().GetMouseButton(w, GLFW_MOUSE_BUTTON_LEFT) == GLFW_RELEASE)
      events_of(w).push({Kind::cursor, 0, false, -1e6f, -1e6f, {}});
  });
  glfw().SetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
    if (button >= 0 && button < 3)
      events_of(w).push({Kind::button, button, action == GLFW_PRESS, 0.0f, 0.0f, {}});
  });
  glfw().SetScrollCallback(window_, [](GLFWwindow* w, double, double y) {
    events_of(w).push({Kind::wheel, 0, false, 0.0f, static_cast<float>(y), {}});
  });
  glfw().SetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int) {
    if (key >= 0 && key < key_count && action != GLFW_REPEAT)
      events_of(w).push({Kind::key, key, action == GLFW_PRESS, 0.0f, 0.0f, {}});
  });
  glfw().SetCharCallback(window_, [](GLFWwindow* w, unsigned character) {
    events_of(w).push({Kind::text, static_cast<int>(character), false, 0.0f, 0.0f, {}});
  });
  glfw().SetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
    if (count > 0) events_of(w).push({Kind::drop, 0, false, 0.0f, 0.0f, paths[count - 1]});
  });
  // Without focus the releases of keys and buttons are not told.
  glfw().SetWindowFocusCallback(window_, [](GLFWwindow* w, int focused) {
    if (focused != GLFW_FALSE) return;
    for (int button = 0; button < 3; ++button)
      events_of(w).push({Kind::button, button, false, 0.0f, 0.0f, {}});
  });
}

bool GlfwWindow::is_closed() const {
  return glfw().WindowShouldClose(window_) != GLFW_FALSE;
}

bool GlfwWindow::is_visible() const {
  int w = 0, h = 0;
  glfw().GetFramebufferSize(window_, &w, &h);
  return w > 0 && h > 0 && glfw().GetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_FALSE;
}

void GlfwWindow::collect(double at_most) {
  if (at_most <= 0.0) {
    glfw().PollEvents();
    return;
  }
  waiting_ = true;
  // What came before it could wait is not slept over.
  if (woken_.exchange(false))
    glfw().PollEvents();
  else
    glfw().WaitEventsTimeout(at_most);
  waiting_ = false;
}

void GlfwWindow::set_title(const std::string& title) {
  glfw().SetWindowTitle(window_, title.c_str());
}

void GlfwWindow::wake() {
  woken_ = true;
  if (waiting_.exchange(false)) glfw().PostEmptyEvent();
}

std::vector<Input> GlfwWindow::inputs(double seconds) {
  woken_ = false;
  int width = 0, height = 0;
  glfw().GetFramebufferSize(window_, &width, &height);
  return events_.take(std::max(width, 1), std::max(height, 1), seconds);
}

void GlfwWindow::swap() {
  glfw().SwapBuffers(window_);
}

}  // namespace app::view
