// A window of GLFW's with OpenGL 3.3, and its events as the interface's input.
//
// All events since the last frame come in their order, a quick click and a drag's start too.
//
// Units    pixels of the framebuffer from the top left
// Errors   std::runtime_error, one line: no display, no OpenGL 3.3
// Threads  wake() from any, all else from the one that made it
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "render/context.hpp"
#include "view/input.hpp"

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
  // What has happened since the last call, `seconds` ago.
  std::vector<Input> inputs(double seconds);
  void swap();
  double frame_period() const { return period_; }

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
  std::atomic<bool> woken_{false};  // since inputs were taken
  InputQueue events_;
};

}  // namespace app::view
