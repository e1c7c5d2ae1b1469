// OSMesa: Mesa's software renderer drawing into memory. Opened with dlopen; linked to nothing.
#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <vector>

#include "context_backends.hpp"

namespace render {
namespace {

// The part of OSMesa's interface in use (its header pulls in GL/gl.h, which does not live beside
// glcorearb.h).
using Handle = struct osmesa_context*;
using Create = Handle (*)(const int* attributes, Handle share);
using Destroy = void (*)(Handle);
using MakeCurrent = GLboolean (*)(Handle, void* buffer, GLenum type, GLsizei width, GLsizei height);
using Current = Handle (*)();
using Address = GlFunction (*)(const char* name);

constexpr int format = 0x22, depth_bits = 0x30, profile = 0x33, core_profile = 0x34;
constexpr int version_major = 0x36, version_minor = 0x37;

// It stays open: drivers do not survive being closed.
void* open_library() {
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6"}) {
    if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return library;
  }
  return nullptr;
}

class OsmesaContext final : public Context {
 public:
  OsmesaContext(int width, int height) : width_(width), height_(height) {
    void* library = open_library();
    if (!library) {
      throw std::runtime_error(
          "OSMesa cannot be loaded (libOSMesa.so.8): install the Debian package libosmesa6");
    }
    const auto create = symbol<Create>(library, "OSMesaCreateContextAttribs");
    const auto address = symbol<Address>(library, "OSMesaGetProcAddress");
    destroy_ = symbol<Destroy>(library, "OSMesaDestroyContext");
    make_current_ = symbol<MakeCurrent>(library, "OSMesaMakeCurrent");
    current_ = symbol<Current>(library, "OSMesaGetCurrentContext");
    if (!create || !address || !destroy_ || !make_current_ || !current_) {
      throw std::runtime_error(
          "this OSMesa is too old to give OpenGL 3.3: install the Debian package libosmesa6");
    }
    const std::array<int, 11> wanted{
        format, GL_RGBA, profile, core_profile, version_major, 3, version_minor, 3, depth_bits, 0, 0};
    context_ = create(wanted.data(), nullptr);
    if (!context_) throw std::runtime_error("OSMesa gives no OpenGL 3.3 core context");
    try {
      make_current();
      gl_ = load_gl([address](const char* name) { return address(name); });
      check_picture_size(gl_, width, height);
    } catch (...) {
      release();
      throw;
    }
  }

  ~OsmesaContext() override { release(); }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  const Gl& gl() const override { return gl_; }
  int width() const override { return width_; }
  int height() const override { return height_; }
  std::string description() const override { return describe_driver(gl_, "OSMesa"); }

  void make_current() override {
    // Always, and released first: OSMesa shares Mesa's dispatch with EGL and does not see when that took it
    // over.
    make_current_(nullptr, nullptr, 0, 0, 0);
    if (!make_current_(context_, buffer_.data(), GL_UNSIGNED_BYTE, side, side)) {
      throw std::runtime_error("OSMesa cannot make its context current");
    }
  }

 private:
  void release() {
    if (current_() == context_) make_current_(nullptr, nullptr, 0, 0, 0);
    destroy_(context_);
  }

  // OSMesa wants a buffer of its own; pictures are drawn into a framebuffer object instead, so a small one
  // will do.
  static constexpr int side = 16;

  int width_;
  int height_;
  std::vector<unsigned char> buffer_ = std::vector<unsigned char>(static_cast<std::size_t>(side) * side * 4);
  Handle context_ = nullptr;
  Destroy destroy_ = nullptr;
  MakeCurrent make_current_ = nullptr;
  Current current_ = nullptr;
  Gl gl_;
};

}  // namespace

std::unique_ptr<Context> open_osmesa(int width, int height) {
  return std::make_unique<OsmesaContext>(width, height);
}

}  // namespace render
