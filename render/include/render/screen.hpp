// What a window shows: a picture of a mesh, and a user interface of Dear ImGui over and beside it.
//
// Drawn into a buffer of its own, so that with a window and without the same pixels come out.
//
// Units    pixels from the top left
// Errors   std::runtime_error: a size beyond the driver's limit
// Not here input, windows, what the interface consists of
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "render/image.hpp"

struct ImDrawData;
struct ImFontAtlas;

namespace render {

class Context;
class MeshPicture;

// The font of all pictures, a TrueType file.
std::span<const unsigned char> embedded_font();

class Screen {
 public:
  // `context` must outlive this.
  Screen(Context& context, int width, int height);
  ~Screen();

  int width() const;
  int height() const;
  void resize(int width, int height);
  void upload_fonts(ImFontAtlas& atlas);

  void clear(const std::array<std::uint8_t, 3>& color);
  // The picture's last frame, its top left corner at x, y.
  void place(const MeshPicture& picture, int x, int y);
  void draw(const ImDrawData& data);
  void read(Image& out) const;
  // Into the context's own framebuffer, a window's.
  void present();
  void wait();  // for the drawing

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace render
