#include "render/context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "context_backends.hpp"

namespace render {

std::string describe_driver(const Gl& gl, const char* backend) {
  const auto text = [&gl](GLenum name) {
    const GLubyte* s = gl.GetString(name);
    return s ? std::string(reinterpret_cast<const char*>(s)) : std::string("unknown");
  };
  return fmt::format("{}: {}, OpenGL {}", backend, text(GL_RENDERER), text(GL_VERSION));
}

void check_picture_size(const Gl& gl, int width, int height) {
  GLint texture = 0, buffer = 0;
  std::array<GLint, 2> viewport{};
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
  gl.GetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &buffer);
  gl.GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  const int limit_x = std::min({texture, buffer, viewport[0]});
  const int limit_y = std::min({texture, buffer, viewport[1]});
  if (width > limit_x || height > limit_y) {
    throw PictureTooLarge(fmt::format("a picture of {} x {} pixels is beyond this driver's limit of {} x {}",
                                      width, height, limit_x, limit_y));
  }
}

std::unique_ptr<Context> open_either(const Opener& first, const Opener& second) {
  std::string reason;
  std::string limit;
  try {
    return first();
  } catch (const PictureTooLarge& error) {
    limit = error.what();
  } catch (const std::runtime_error& error) {
    reason = error.what();
  }
  try {
    return second();
  } catch (const std::runtime_error& error) {
    if (!limit.empty()) throw PictureTooLarge(limit);
    throw std::runtime_error(
        fmt::format("no OpenGL for drawing without a window: {}; {}", reason, error.what()));
  }
}

namespace {

class AdoptedContext final : public Context {
 public:
  AdoptedContext(const std::function<FunctionAddress(const char*)>& find, std::function<void()> make_current,
                 std::string name, int width, int height)
      : make_current_(std::move(make_current)), name_(std::move(name)), width_(width), height_(height) {
    make_current_();
    gl_ = load_gl(find);
  }
  const Gl& gl() const override { return gl_; }
  int width() const override { return width_; }
  int height() const override { return height_; }
  std::string description() const override { return describe_driver(gl_, name_.c_str()); }
  void make_current() override { make_current_(); }

 private:
  std::function<void()> make_current_;
  std::string name_;
  int width_, height_;
  Gl gl_;
};

}  // namespace

std::unique_ptr<Context> adopt_context(const std::function<FunctionAddress(const char*)>& find,
                                       std::function<void()> make_current, std::string name, int width,
                                       int height) {
  return std::make_unique<AdoptedContext>(find, std::move(make_current), std::move(name), width, height);
}

std::unique_ptr<Context> open_context(Backend backend, int width, int height) {
  if (width < 1 || height < 1) {
    throw std::runtime_error(
        fmt::format("a picture of {} x {} pixels: width and height must be at least 1", width, height));
  }
  switch (backend) {
    case Backend::osmesa:
      return open_osmesa(width, height);
    case Backend::egl:
      return open_egl(width, height);
    case Backend::automatic:
      break;
  }
  return open_either([=] { return open_osmesa(width, height); }, [=] { return open_egl(width, height); });
}

}  // namespace render
