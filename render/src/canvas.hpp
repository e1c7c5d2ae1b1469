// Two-dimensional drawing in pixels: anti-aliased lines, shapes and text over Dear ImGui's draw lists.
//
// (0, 0) is the top left corner of the picture. What is drawn is collected; flush() brings it into the
// current framebuffer. Needs no ImGui context, so that any number may live beside a user interface.
//
// Units    pixels; a font's size is the height of a line of text
// Errors   std::runtime_error when the shaders fail; text in unknown characters shows replacement marks
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/text_box.hpp"

namespace render {

struct Gl;

struct Point {
  float x = 0, y = 0;
};

struct Rect {
  float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  float width() const { return x1 - x0; }
  float height() const { return y1 - y0; }
};

struct Color {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
};

// The colours of a picture.
struct Palette {
  Color paper;
  Color ink;         // text, outline
  Color soft_ink;    // axes, hatches, rest shape
  Color force;       // traction arrows
  Color plain_fill;  // a body without a scalar
  Color wire;        // mesh lines
};

enum class Align { left, center, right };
enum class TextSize { small, normal, title };

// The height of normal text in a picture: readable from 240 x 160 up to 3840 x 2160.
int text_height(int picture_width, int picture_height);

class Canvas {
 public:
  // `characters`: all texts that will be drawn must be made of these, ASCII, and typeset_characters().
  Canvas(const Gl& gl, int width, int height, std::string_view characters);
  ~Canvas();
  Canvas(Canvas&&) noexcept;

  int width() const;
  int height() const;
  const Palette& palette() const;  // light unless set
  void set_palette(const Palette& palette);
  float unit() const;  // lines' unit: 1 in a picture 720 pixels high
  float text_size(TextSize size) const;

  void line(Point a, Point b, Color color, float width);
  // Joined segments, with rounded sharp corners; dash > 0: period of the dashes in pixels.
  void polyline(std::span<const Point> points, Color color, float width, float dash = 0);
  void triangle(Point a, Point b, Point c, Color color);
  void disk(Point center, float radius, Color color);
  void rect(const Rect& r, Color color, float radius = 0);
  void frame(const Rect& r, Color color, float width);
  void gradient(const Rect& r, Color top, Color bottom);

  // `at.y` is the middle of the capital letters, `at.x` the left, the centre or the right end.
  void text(Point at, Align align, TextSize size, Color color, std::string_view s);
  float text_width(TextSize size, std::string_view s) const;
  // As text(), with typeset() names.
  void label(Point at, Align align, TextSize size, Color color, std::string_view s);
  float label_width(TextSize size, std::string_view s) const;
  // Turned by 90 degrees, reading upwards, centred at `at`.
  void label_upwards(Point at, TextSize size, Color color, std::string_view s);
  // `s` shortened to fit, with an ellipsis.
  std::string fit(TextSize size, std::string_view s, float width) const;

  // All that was written since the last call of set_texts(), in order.
  const std::vector<TextBox>& texts() const;
  void set_texts(std::vector<TextBox> texts);

  void flush();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace render
