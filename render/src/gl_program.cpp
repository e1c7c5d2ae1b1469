#include "gl_program.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "shader_text.hpp"

namespace render {
namespace {

constexpr const char* version_line = "#version 330 core\n";

std::string shader_text(const std::string& file) {
  if (const char* directory = std::getenv("RHEO_SHADER_DIR")) {
    std::ifstream in(std::string(directory) + "/" + file, std::ios::binary);
    if (in) return {std::istreambuf_iterator<char>(in), {}};
  }
  return std::string(embedded_shader(file));
}

// A driver's log in one line.
std::string first_message(const std::array<char, 1024>& log) {
  std::string text(log.data());
  for (char& c : text) {
    if (c == '\n') c = ' ';
  }
  return text;
}

GLuint compile(const Gl& gl, GLenum stage, const std::string& file) {
  const std::string body = shader_text(file);
  const std::array<const char*, 2> parts{version_line, body.c_str()};
  const GLuint shader = gl.CreateShader(stage);
  gl.ShaderSource(shader, 2, parts.data(), nullptr);
  gl.CompileShader(shader);
  GLint ok = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok) return shader;
  std::array<char, 1024> log{};
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  gl.DeleteShader(shader);
  throw std::runtime_error(fmt::format("shader {} does not compile: {}", file, first_message(log)));
}

}  // namespace

GlProgram::GlProgram(const Gl& gl, const std::string& name, const std::vector<const char*>& attributes)
    : gl_(gl) {
  const GLuint vertex = compile(gl, GL_VERTEX_SHADER, name + ".vert");
  GLuint fragment = 0;
  try {
    fragment = compile(gl, GL_FRAGMENT_SHADER, name + ".frag");
  } catch (...) {
    gl.DeleteShader(vertex);
    throw;
  }
  id_ = gl.CreateProgram();
  gl.AttachShader(id_, vertex);
  gl.AttachShader(id_, fragment);
  for (GLuint i = 0; i < attributes.size(); ++i) gl.BindAttribLocation(id_, i, attributes[i]);
  gl.LinkProgram(id_);
  gl.DeleteShader(vertex);
  gl.DeleteShader(fragment);
  GLint ok = 0;
  gl.GetProgramiv(id_, GL_LINK_STATUS, &ok);
  if (ok) return;
  std::array<char, 1024> log{};
  gl.GetProgramInfoLog(id_, static_cast<GLsizei>(log.size()), nullptr, log.data());
  gl.DeleteProgram(id_);
  throw std::runtime_error(fmt::format("shaders {} do not link: {}", name, first_message(log)));
}

GlProgram::~GlProgram() {
  gl_.DeleteProgram(id_);
}

}  // namespace render
