// A shader program from shaders/NAME.vert and shaders/NAME.frag.
//
// The files are embedded in the library. Developers: with the environment variable RHEO_SHADER_DIR set to a
// directory, files found there are compiled instead, without building again. The line "#version" is written
// here, so that the same text serves OpenGL 3.3 and WebGL 2.
//
// Errors   std::runtime_error: the file's name and the compiler's first message
#pragma once

#include <string>
#include <vector>

#include "gl.hpp"

namespace render {

class GlProgram {
 public:
  // attributes[i] is bound to location i.
  GlProgram(const Gl& gl, const std::string& name, const std::vector<const char*>& attributes);
  ~GlProgram();
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  void use() const { gl_.UseProgram(id_); }
  GLint uniform(const char* name) const { return gl_.GetUniformLocation(id_, name); }

 private:
  const Gl& gl_;
  GLuint id_ = 0;
};

}  // namespace render
