// Draws Dear ImGui's draw lists with our own table of functions, in any context.
//
// Needs no ImGui context: whoever has draw lists (the 2-D canvas, or a user interface) hands them over.
// Not here: input, fonts' choice, windows.
#pragma once

#include <imgui.h>

#include "gl_object.hpp"
#include "gl_program.hpp"

namespace render {

// Which row of the framebuffer is the picture's top: the first for our own targets, the last for a window.
enum class Rows { top_first, bottom_first };

class ImguiRenderer {
 public:
  explicit ImguiRenderer(const Gl& gl);

  // Uploads the atlas and sets its texture id; the texture lives as long as this object.
  void upload_fonts(ImFontAtlas& atlas);

  void draw(const ImDrawData& data, Rows rows) const;

 private:
  void draw_list(const ImDrawList& list, const ImDrawData& data, Rows rows) const;
  void point_attributes(std::size_t first_vertex) const;

  const Gl& gl_;
  GlProgram program_;
  GLint to_clip_;
  GlVertexArray array_;
  GlBuffer vertices_;
  GlBuffer indices_;
  GlTexture fonts_;
};

}  // namespace render
