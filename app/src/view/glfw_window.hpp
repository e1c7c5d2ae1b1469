// A window of GLFW's with OpenGL 3.3, and its events as the interface's input.
//
// Button and key events come one a frame, so that a quick click or a drag's start is not lost.
//
// Units    pixels of the framebuffer from the top left
// Errors   std::runtime_error, one line: no display, no OpenGL 3.3
// Threads  wake() from any, all else from the one that made it
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <string>

#include "render/context.hpp"
#include "view/ui.hpp"

struct GLFWwindow;

namespace app::view {

class GlfwWindow {
 public:
  GlfwWindow(const std::string& title, int width, int height);
  ~GlfwWindow();
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  render::Context& context() { return *context_; }
  float scale() const { return scale_; }
  void set_title(const std::string& title);
  bool is_closed() const;
  bool is_visible() const;  // not minimised

  // Takes what has happened; waits for something to happen, at most so long.
  void poll() { collect(0.0); }
  void wait(double at_most) { collect(at_most); }
  void wake();
  Input next_input(double seconds);
  bool has_more() const { return !events_.empty(); }
  void swap();
  double frame_period() const { return period_; }

  struct Event {
    enum class Kind { cursor, button, wheel, key, text, drop } kind = Kind::cursor;
    int code = 0;
    bool down = false;
    float x = 0.0f, y = 0.0f;
    std::string path;
  };

 private:
  struct Library {
    Library();
    ~Library();
  };
  void collect(double at_most);
  void install_callbacks();

  Library library_;
  GLFWwindow* window_ = nullptr;
  std::unique_ptr<render::Context> context_;
  float scale_ = 1.0f;
  double period_ = 1.0 / 60.0;
  std::atomic<bool> waiting_{false};
  std::deque<Event> events_;
  Input input_;
};

}  // namespace app::view
