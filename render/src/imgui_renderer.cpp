#include "imgui_renderer.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace render {
namespace {

const void* offset_of(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

}  // namespace

ImguiRenderer::ImguiRenderer(const Gl& gl)
    : gl_(gl),
      program_(gl, "canvas", {"position", "uv", "tint"}),
      to_clip_(program_.uniform("to_clip")),
      array_(gl),
      vertices_(gl),
      indices_(gl),
      fonts_(gl) {
  gl.BindVertexArray(array_.id());
  for (GLuint i = 0; i < 3; ++i) gl.EnableVertexAttribArray(i);
}

void ImguiRenderer::upload_fonts(ImFontAtlas& atlas) {
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, fonts_.id());
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
  atlas.SetTexID(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(fonts_.id())));
}

void ImguiRenderer::draw(const ImDrawData& data, Rows rows) const {
  const float w = data.DisplaySize.x, h = data.DisplaySize.y;
  if (w <= 0 || h <= 0) return;
  const float sign = rows == Rows::top_first ? 1.0f : -1.0f;
  const float sx = 2 / w, sy = sign * 2 / h;
  program_.use();
  gl_.Uniform4f(to_clip_, sx, sy, -1 - data.DisplayPos.x * sx, -sign - data.DisplayPos.y * sy);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.Enable(GL_BLEND);
  gl_.BlendEquation(GL_FUNC_ADD);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl_.Enable(GL_SCISSOR_TEST);
  gl_.BindVertexArray(array_.id());
  for (int i = 0; i < data.CmdListsCount; ++i) draw_list(*data.CmdLists[i], data, rows);
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.Disable(GL_BLEND);
}

// A command's first vertex goes into the attribute pointers: WebGL 2 draws without a base vertex.
void ImguiRenderer::point_attributes(std::size_t first_vertex) const {
  constexpr GLsizei stride = sizeof(ImDrawVert);
  const std::size_t start = first_vertex * sizeof(ImDrawVert);
  gl_.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, offset_of(start + offsetof(ImDrawVert, pos)));
  gl_.VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride, offset_of(start + offsetof(ImDrawVert, uv)));
  gl_.VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                          offset_of(start + offsetof(ImDrawVert, col)));
}

void ImguiRenderer::draw_list(const ImDrawList& list, const ImDrawData& data, Rows rows) const {
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  gl_.BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                 GL_STREAM_DRAW);
  const ImVec2 scale = data.FramebufferScale;
  const int width = static_cast<int>(data.DisplaySize.x * scale.x);
  const int height = static_cast<int>(data.DisplaySize.y * scale.y);
  constexpr GLenum index_type = sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;

  for (const ImDrawCmd& command : list.CmdBuffer) {
    if (command.UserCallback) {
      if (command.UserCallback != ImDrawCallback_ResetRenderState) command.UserCallback(&list, &command);
      continue;
    }
    const ImVec4& r = command.ClipRect;
    const int x0 = std::max(static_cast<int>((r.x - data.DisplayPos.x) * scale.x), 0);
    const int y0 = std::max(static_cast<int>((r.y - data.DisplayPos.y) * scale.y), 0);
    const int x1 = std::min(static_cast<int>((r.z - data.DisplayPos.x) * scale.x), width);
    const int y1 = std::min(static_cast<int>((r.w - data.DisplayPos.y) * scale.y), height);
    if (x1 <= x0 || y1 <= y0 || command.ElemCount == 0) continue;
    gl_.Scissor(x0, rows == Rows::top_first ? y0 : height - y1, x1 - x0, y1 - y0);
    const auto texture = reinterpret_cast<std::uintptr_t>(command.GetTexID());
    gl_.BindTexture(GL_TEXTURE_2D, static_cast<GLuint>(texture));
    point_attributes(command.VtxOffset);
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), index_type,
                     offset_of(command.IdxOffset * sizeof(ImDrawIdx)));
  }
}

}  // namespace render
