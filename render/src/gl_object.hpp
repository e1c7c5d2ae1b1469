// Owners of OpenGL names: made and deleted with the context of `gl` current.
#pragma once

#include <utility>

#include "gl.hpp"

namespace render {

// `Traits` has make(gl) and drop(gl, id).
template <class Traits>
class GlObject {
 public:
  explicit GlObject(const Gl& gl) : gl_(&gl), id_(Traits::make(gl)) {}
  ~GlObject() {
    if (id_) Traits::drop(*gl_, id_);
  }
  GlObject(GlObject&& other) noexcept : gl_(other.gl_), id_(std::exchange(other.id_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(id_, other.id_);
    return *this;
  }
  GLuint id() const { return id_; }

 private:
  const Gl* gl_;
  GLuint id_;
};

#define RHEO_GL_TRAITS(NAME, PLURAL)                                         \
  struct NAME##Traits {                                                      \
    static GLuint make(const Gl& gl) {                                       \
      GLuint id = 0;                                                         \
      gl.Gen##PLURAL(1, &id);                                                \
      return id;                                                             \
    }                                                                        \
    static void drop(const Gl& gl, GLuint id) { gl.Delete##PLURAL(1, &id); } \
  };                                                                         \
  using Gl##NAME = GlObject<NAME##Traits>;

RHEO_GL_TRAITS(Buffer, Buffers)
RHEO_GL_TRAITS(Texture, Textures)
RHEO_GL_TRAITS(VertexArray, VertexArrays)
RHEO_GL_TRAITS(Framebuffer, Framebuffers)
RHEO_GL_TRAITS(Renderbuffer, Renderbuffers)
#undef RHEO_GL_TRAITS

}  // namespace render
