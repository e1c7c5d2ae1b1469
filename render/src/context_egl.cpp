// EGL without a display: Mesa's surfaceless platform, else the first device that gives a context (a GPU's
// driver). Opened with dlopen; linked to nothing.
#define EGL_NO_X11
#define EGL_EGL_PROTOTYPES 0
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string_view>

#include "context_backends.hpp"

namespace render {
namespace {

// It stays open: drivers do not survive being closed.
void* open_library() {
  return dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
}

struct Egl {
  PFNEGLGETPROCADDRESSPROC address = nullptr;
  PFNEGLQUERYSTRINGPROC query_string = nullptr;
  PFNEGLINITIALIZEPROC initialize = nullptr;
  PFNEGLBINDAPIPROC bind_api = nullptr;
  PFNEGLCHOOSECONFIGPROC choose_config = nullptr;
  PFNEGLCREATECONTEXTPROC create_context = nullptr;
  PFNEGLDESTROYCONTEXTPROC destroy_context = nullptr;
  PFNEGLMAKECURRENTPROC make_current = nullptr;
  PFNEGLGETCURRENTCONTEXTPROC current = nullptr;
};

Egl load_egl() {
  void* library = open_library();
  if (!library) {
    throw std::runtime_error(
        "EGL cannot be loaded (libEGL.so.1): install the Debian packages libegl1 and libgl1-mesa-dri");
  }
  Egl egl;
  const auto load = [library](auto& function, const char* name) {
    function = symbol<std::remove_reference_t<decltype(function)>>(library, name);
    if (!function) throw std::runtime_error(fmt::format("this EGL library has no function {}", name));
  };
  load(egl.address, "eglGetProcAddress");
  load(egl.query_string, "eglQueryString");
  load(egl.initialize, "eglInitialize");
  load(egl.bind_api, "eglBindAPI");
  load(egl.choose_config, "eglChooseConfig");
  load(egl.create_context, "eglCreateContext");
  load(egl.destroy_context, "eglDestroyContext");
  load(egl.make_current, "eglMakeCurrent");
  load(egl.current, "eglGetCurrentContext");
  return egl;
}

// An OpenGL 3.3 core context that needs no surface; EGL_NO_CONTEXT when this display has none.
EGLContext context_on(const Egl& egl, EGLDisplay display) {
  if (display == EGL_NO_DISPLAY || !egl.initialize(display, nullptr, nullptr)) return EGL_NO_CONTEXT;
  const std::array<EGLint, 5> kind{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                   EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!egl.choose_config(display, kind.data(), &config, 1, &count) || count < 1) return EGL_NO_CONTEXT;
  const std::array<EGLint, 7> wanted{EGL_CONTEXT_MAJOR_VERSION,
                                     3,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     3,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_NONE};
  return egl.create_context(display, config, EGL_NO_CONTEXT, wanted.data());
}

class EglContext final : public Context {
 public:
  EglContext(int width, int height) : width_(width), height_(height), egl_(load_egl()) {
    find_display();
    if (context_ == EGL_NO_CONTEXT) {
      throw std::runtime_error(
          "EGL gives no OpenGL 3.3 context without a display: install the Debian package libgl1-mesa-dri");
    }
    try {
      make_current();
      gl_ = load_gl([this](const char* name) { return egl_.address(name); });
      check_picture_size(gl_, width, height);
    } catch (...) {
      release();
      throw;
    }
  }

  ~EglContext() override { release(); }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  const Gl& gl() const override { return gl_; }
  int width() const override { return width_; }
  int height() const override { return height_; }
  std::string description() const override { return describe_driver(gl_, "EGL"); }

  void make_current() override {
    // Released first: where OSMesa, or a window's library, took Mesa's dispatch over meanwhile, EGL does not
    // know of it and would take its own context for the current one.
    egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (!egl_.bind_api(EGL_OPENGL_API) ||
        !egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
      throw std::runtime_error("EGL cannot make its context current");
    }
  }

 private:
  void find_display() {
    const char* extensions = egl_.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const std::string_view known = extensions ? extensions : "";
    const auto get_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(egl_.address("eglGetPlatformDisplayEXT"));
    if (!get_display || !egl_.bind_api(EGL_OPENGL_API)) return;
    if (known.find("EGL_MESA_platform_surfaceless") != std::string_view::npos) {
      display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
      context_ = context_on(egl_, display_);
    }
    const auto devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl_.address("eglQueryDevicesEXT"));
    if (!devices || known.find("EGL_EXT_platform_device") == std::string_view::npos) return;
    std::array<EGLDeviceEXT, 16> found{};
    EGLint count = 0;
    if (context_ == EGL_NO_CONTEXT) devices(static_cast<EGLint>(found.size()), found.data(), &count);
    for (EGLint i = 0; i < count && context_ == EGL_NO_CONTEXT; ++i) {
      display_ = get_display(EGL_PLATFORM_DEVICE_EXT, found[static_cast<std::size_t>(i)], nullptr);
      context_ = context_on(egl_, display_);
    }
  }

  // The display is not terminated: EGL hands the same one to every context of the process.
  void release() {
    if (context_ == EGL_NO_CONTEXT) return;
    if (egl_.current() == context_) {
      egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    egl_.destroy_context(display_, context_);
  }

  int width_;
  int height_;
  Egl egl_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  Gl gl_;
};

}  // namespace

std::unique_ptr<Context> open_egl(int width, int height) {
  return std::make_unique<EglContext>(width, height);
}

}  // namespace render
