// The backends behind open_context, and what they share.
#pragma once

#include <dlfcn.h>

#include <memory>
#include <string>

#include "gl.hpp"
#include "render/context.hpp"

namespace render {

// Each throws std::runtime_error in one line when the backend cannot be had.
std::unique_ptr<Context> open_osmesa(int width, int height);
std::unique_ptr<Context> open_egl(int width, int height);

// Is the backend's library on this machine? (It stays open: drivers do not survive being closed.)
bool osmesa_present();
bool egl_present();

// "OSMesa: llvmpipe (...), OpenGL 4.5 ..."
std::string describe_driver(const Gl& gl, const char* backend);

// Throws std::runtime_error naming the driver's limit when a picture of this size cannot be drawn.
void check_picture_size(const Gl& gl, int width, int height);

// A function of an opened library; null when it has none.
template <class Function>
Function symbol(void* library, const char* name) {
  return reinterpret_cast<Function>(dlsym(library, name));
}

}  // namespace render
