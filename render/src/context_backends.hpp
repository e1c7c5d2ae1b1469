// The backends behind open_context, and what they share.
#pragma once

#include <dlfcn.h>

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "gl.hpp"
#include "render/context.hpp"

namespace render {

// Each throws std::runtime_error in one line when the backend cannot be had.
std::unique_ptr<Context> open_osmesa(int width, int height);
std::unique_ptr<Context> open_egl(int width, int height);

// A picture beyond a driver's limit: a mistake of the one who asks for it, not a driver that does not work.
class PictureTooLarge : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What `first` opens, or else `second`. When neither gives a context, one line says why for both, or the
// limit alone where the size was too large for the first.
using Opener = std::function<std::unique_ptr<Context>()>;
std::unique_ptr<Context> open_either(const Opener& first, const Opener& second);

// "OSMesa: llvmpipe (...), OpenGL 4.5 ..."
std::string describe_driver(const Gl& gl, const char* backend);

// Throws PictureTooLarge naming the driver's limit when a picture of this size cannot be drawn.
void check_picture_size(const Gl& gl, int width, int height);

// A function of an opened library; null when it has none.
template <class Function>
Function symbol(void* library, const char* name) {
  return reinterpret_cast<Function>(dlsym(library, name));
}

}  // namespace render
