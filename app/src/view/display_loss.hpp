// The window system that goes away under a window: an X server that ends, a connection that breaks.
//
// Xlib would then write its own lines and call exit(1) in the middle of whatever was drawn, and a program
// that goes on hangs in the next wait. Here `lost` is called instead, on the thread that found out, and must
// end the process: nothing of the window or its context can be used any more.
//
// Errors   none: with an Xlib older than 1.7, or without X, nothing is done
// Threads  lost may be called on any
#pragma once

#include <functional>

namespace app::view {

class DisplayLoss {
 public:
  // While GLFW has its window open.
  explicit DisplayLoss(std::function<void()> lost);
  ~DisplayLoss();
  DisplayLoss(const DisplayLoss&) = delete;
  DisplayLoss& operator=(const DisplayLoss&) = delete;

 private:
  std::function<void()> lost_;
  std::function<void()> undo_;
};

}  // namespace app::view
