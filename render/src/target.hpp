// A framebuffer of our own, so that every backend draws into the same thing.
//
// Row 0 of the buffer is the picture's top row: everything is drawn upside down, and reading back needs no
// flip. Shapes   RGBA, 8 bits each Errors   std::runtime_error when the driver gives no such buffer
#pragma once

#include "gl_object.hpp"
#include "render/image.hpp"

namespace render {

class Target {
 public:
  Target(const Gl& gl, int width, int height);
  void bind() const;                    // draws go here from now on, over the whole picture
  void copy(const Target& from) const;  // all of its pixels; both have one size
  GLuint framebuffer() const { return framebuffer_.id(); }
  void read(Image& out) const;  // waits for the drawing; `out` is resized where needed

 private:
  const Gl& gl_;
  int width_;
  int height_;
  GlFramebuffer framebuffer_;
  GlRenderbuffer color_;
};

}  // namespace render
