// An OpenGL (core 3.3 or later) context without a window, opened with dlopen only when asked for.
//
// Errors   std::runtime_error: one line that names what is missing and the Debian package that brings it
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "render/image.hpp"

namespace render {

struct Gl;  // the table of functions, render/src/gl.hpp

enum class Backend {
  automatic,  // OSMesa where it gives a context, else EGL
  osmesa,
  egl  // surfaceless: no display
};

class Context {
 public:
  virtual ~Context() = default;
  virtual const Gl& gl() const = 0;
  virtual int width() const = 0;
  virtual int height() const = 0;
  virtual std::string description() const = 0;  // backend, driver, OpenGL and Mesa versions
  virtual void make_current() = 0;
};

// One that somebody else has made (a window's) and keeps alive. `find` gives the address of "glName", or
// null; `make_current` is called before. Errors: also where the driver has less than OpenGL 3.3.
using FunctionAddress = void (*)();
std::unique_ptr<Context> adopt_context(const std::function<FunctionAddress(const char*)>& find,
                                       std::function<void()> make_current, std::string name, int width,
                                       int height);

std::unique_ptr<Context> open_context(Backend backend, int width, int height);

}  // namespace render
