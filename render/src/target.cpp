#include "target.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace render {

Target::Target(const Gl& gl, int width, int height)
    : gl_(gl), width_(width), height_(height), framebuffer_(gl), color_(gl) {
  gl.BindRenderbuffer(GL_RENDERBUFFER, color_.id());
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_.id());
  if (gl.GetError() != GL_NO_ERROR || gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error(fmt::format("the driver gives no picture of {} x {} pixels", width, height));
  }
}

void Target::bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl_.Viewport(0, 0, width_, height_);
}

void Target::copy(const Target& from) const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, from.framebuffer_.id());
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.id());
  gl_.BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Target::read(Image& out) const {
  out.width = width_;
  out.height = height_;
  out.rgba.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 4);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, out.rgba.data());
}

}  // namespace render
