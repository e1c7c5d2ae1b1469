// The table of OpenGL functions in use, filled once a context is current; nothing links a GL library.
//
// Only calls that WebGL 2 has too (no base vertex, no texture buffers, no polygon mode).
// Errors   std::runtime_error names a missing function
#pragma once

#include <GL/glcorearb.h>

#include <functional>

namespace render {

// X(type suffix, name): PFNGL<type suffix>PROC becomes Gl::<name>, loaded as "gl<name>".
#define RHEO_GL_FUNCTIONS(X)                          \
  X(ACTIVETEXTURE, ActiveTexture)                     \
  X(ATTACHSHADER, AttachShader)                       \
  X(BINDATTRIBLOCATION, BindAttribLocation)           \
  X(BINDBUFFER, BindBuffer)                           \
  X(BINDFRAMEBUFFER, BindFramebuffer)                 \
  X(BINDRENDERBUFFER, BindRenderbuffer)               \
  X(BINDTEXTURE, BindTexture)                         \
  X(BINDVERTEXARRAY, BindVertexArray)                 \
  X(BLENDEQUATION, BlendEquation)                     \
  X(BLENDFUNCSEPARATE, BlendFuncSeparate)             \
  X(BUFFERDATA, BufferData)                           \
  X(BUFFERSUBDATA, BufferSubData)                     \
  X(BLITFRAMEBUFFER, BlitFramebuffer)                 \
  X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus)   \
  X(CLEAR, Clear)                                     \
  X(CLEARCOLOR, ClearColor)                           \
  X(COMPILESHADER, CompileShader)                     \
  X(CREATEPROGRAM, CreateProgram)                     \
  X(CREATESHADER, CreateShader)                       \
  X(DELETEBUFFERS, DeleteBuffers)                     \
  X(DELETEFRAMEBUFFERS, DeleteFramebuffers)           \
  X(DELETEPROGRAM, DeleteProgram)                     \
  X(DELETERENDERBUFFERS, DeleteRenderbuffers)         \
  X(DELETESHADER, DeleteShader)                       \
  X(DELETETEXTURES, DeleteTextures)                   \
  X(DELETEVERTEXARRAYS, DeleteVertexArrays)           \
  X(DISABLE, Disable)                                 \
  X(DRAWARRAYS, DrawArrays)                           \
  X(DRAWELEMENTS, DrawElements)                       \
  X(ENABLE, Enable)                                   \
  X(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) \
  X(FINISH, Finish)                                   \
  X(FRAMEBUFFERRENDERBUFFER, FramebufferRenderbuffer) \
  X(GENBUFFERS, GenBuffers)                           \
  X(GENFRAMEBUFFERS, GenFramebuffers)                 \
  X(GENRENDERBUFFERS, GenRenderbuffers)               \
  X(GENTEXTURES, GenTextures)                         \
  X(GENVERTEXARRAYS, GenVertexArrays)                 \
  X(GETERROR, GetError)                               \
  X(GETINTEGERV, GetIntegerv)                         \
  X(GETPROGRAMINFOLOG, GetProgramInfoLog)             \
  X(GETPROGRAMIV, GetProgramiv)                       \
  X(GETSHADERINFOLOG, GetShaderInfoLog)               \
  X(GETSHADERIV, GetShaderiv)                         \
  X(GETSTRING, GetString)                             \
  X(GETUNIFORMLOCATION, GetUniformLocation)           \
  X(LINKPROGRAM, LinkProgram)                         \
  X(PIXELSTOREI, PixelStorei)                         \
  X(READPIXELS, ReadPixels)                           \
  X(RENDERBUFFERSTORAGE, RenderbufferStorage)         \
  X(SCISSOR, Scissor)                                 \
  X(SHADERSOURCE, ShaderSource)                       \
  X(TEXIMAGE2D, TexImage2D)                           \
  X(TEXPARAMETERI, TexParameteri)                     \
  X(TEXSUBIMAGE2D, TexSubImage2D)                     \
  X(UNIFORM1F, Uniform1f)                             \
  X(UNIFORM1I, Uniform1i)                             \
  X(UNIFORM2F, Uniform2f)                             \
  X(UNIFORM4F, Uniform4f)                             \
  X(USEPROGRAM, UseProgram)                           \
  X(VERTEXATTRIBIPOINTER, VertexAttribIPointer)       \
  X(VERTEXATTRIBPOINTER, VertexAttribPointer)         \
  X(VIEWPORT, Viewport)

struct Gl {
#define RHEO_GL_MEMBER(TYPE, NAME) PFNGL##TYPE##PROC NAME = nullptr;
  RHEO_GL_FUNCTIONS(RHEO_GL_MEMBER)
#undef RHEO_GL_MEMBER
};

using GlFunction = void (*)();

// `find` gives the address of "glName", or null. The context must be current.
Gl load_gl(const std::function<GlFunction(const char*)>& find);

}  // namespace render
