#include "render/screen.hpp"

#include <imgui.h>

#include <algorithm>
#include <optional>

#include "context_backends.hpp"
#include "imgui_renderer.hpp"
#include "render/context.hpp"
#include "render/mesh_picture.hpp"
#include "target.hpp"

extern "C" {
extern const unsigned char rheo_font_begin[];
extern const unsigned char rheo_font_end[];
}

namespace render {

std::span<const unsigned char> embedded_font() {
  return {rheo_font_begin, rheo_font_end};
}

struct Screen::Impl {
  explicit Impl(Context& c) : context(c), gl(c.gl()), renderer(gl) {}

  Context& context;
  const Gl& gl;
  ImguiRenderer renderer;
  std::optional<Target> target;
  int width = 0, height = 0;
};

Screen::Screen(Context& context, int width, int height) {
  context.make_current();
  impl_ = std::make_unique<Impl>(context);
  resize(width, height);
}

Screen::~Screen() {
  impl_->context.make_current();
}

int Screen::width() const {
  return impl_->width;
}
int Screen::height() const {
  return impl_->height;
}

void Screen::resize(int width, int height) {
  if (width == impl_->width && height == impl_->height) return;
  impl_->context.make_current();
  check_picture_size(impl_->gl, width, height);
  impl_->target.emplace(impl_->gl, width, height);
  impl_->width = width;
  impl_->height = height;
}

void Screen::upload_fonts(ImFontAtlas& atlas) {
  impl_->context.make_current();
  impl_->renderer.upload_fonts(atlas);
}

void Screen::clear(const std::array<std::uint8_t, 3>& color) {
  const Gl& gl = impl_->gl;
  impl_->context.make_current();
  impl_->target->bind();
  gl.Disable(GL_SCISSOR_TEST);
  gl.ClearColor(color[0] / 255.0f, color[1] / 255.0f, color[2] / 255.0f, 1.0f);
  gl.Clear(GL_COLOR_BUFFER_BIT);
}

void Screen::place(const MeshPicture& picture, int x, int y) {
  const Gl& gl = impl_->gl;
  const int w = std::min(picture.width(), impl_->width - x),
            h = std::min(picture.height(), impl_->height - y);
  if (w <= 0 || h <= 0) return;
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer());
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, impl_->target->framebuffer());
  gl.BlitFramebuffer(0, 0, w, h, x, y, x + w, y + h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Screen::draw(const ImDrawData& data) {
  const Gl& gl = impl_->gl;
  impl_->target->bind();
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  impl_->renderer.draw(data, Rows::top_first);
}

void Screen::read(Image& out) const {
  impl_->context.make_current();
  impl_->target->read(out);
}

// A window's first row is its lowest.
void Screen::present() {
  const Gl& gl = impl_->gl;
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, impl_->target->framebuffer());
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  gl.Disable(GL_SCISSOR_TEST);
  gl.BlitFramebuffer(0, 0, impl_->width, impl_->height, 0, impl_->height, impl_->width, 0,
                     GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Screen::wait() {
  impl_->gl.Finish();
}

}  // namespace render
