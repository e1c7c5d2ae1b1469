#include "canvas.hpp"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "imgui_renderer.hpp"
#include "theme.hpp"
#include "typeset.hpp"

extern "C" {
extern const unsigned char rheo_font_begin[];
extern const unsigned char rheo_font_end[];
}

namespace render {
namespace {

constexpr float sub_scale = 0.74f;    // lowered and raised text
constexpr float cap_middle = 0.484f;  // middle of DejaVu Sans' capitals, from the top of the line
constexpr std::size_t chunk = 4000;   // points in one primitive: well below what 16-bit indices reach

// Line breaks and other control characters become spaces.
std::string one_line(std::string_view s) {
  std::string line(s);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return line;
}

constexpr Rect no_ink{FLT_MAX, FLT_MAX, -FLT_MAX, -FLT_MAX};

Rect joined(const Rect& a, const Rect& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

ImVec2 vec(Point p) {
  return {p.x, p.y};
}
ImU32 packed(Color c) {
  return IM_COL32(c.r, c.g, c.b, c.a);
}

}  // namespace

int text_height(int picture_width, int picture_height) {
  return std::max(13, static_cast<int>(std::lround(std::min(picture_height / 36.0, picture_width / 56.0))));
}

struct Canvas::Impl {
  Impl(const Gl& gl, int w, int h, std::string_view characters) : renderer(gl), width(w), height(h) {
    const float normal = static_cast<float>(text_height(w, h));
    sizes = {std::max(std::round(normal * 0.84f), 12.0f), normal, std::round(normal * 1.14f)};
    ImFontGlyphRangesBuilder builder;
    builder.AddRanges(atlas.GetGlyphRangesDefault());
    builder.AddText(characters.data(), characters.data() + characters.size());
    const std::string_view own = typeset_characters();
    builder.AddText(own.data(), own.data() + own.size());
    ImVector<ImWchar> ranges;
    builder.BuildRanges(&ranges);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      fonts[i] = add_font(sizes[i], ranges.Data);
      sub_fonts[i] = add_font(std::max(std::round(sizes[i] * sub_scale), 9.0f), ranges.Data);
    }
    atlas.TexDesiredWidth = normal > 40 ? 4096 : 0;
    if (!atlas.Build()) throw std::runtime_error("the embedded font cannot be read");
    renderer.upload_fonts(atlas);
    atlas.ClearTexData();

    shared.TexUvWhitePixel = atlas.TexUvWhitePixel;
    shared.TexUvLines = atlas.TexUvLines;
    shared.Font = fonts[1];
    shared.FontSize = sizes[1];
    shared.CurveTessellationTol = 1.25f;
    shared.SetCircleTessellationMaxError(0.2f);
    shared.ClipRectFullscreen = ImVec4(0, 0, static_cast<float>(w), static_cast<float>(h));
    shared.InitialFlags =
        ImDrawListFlags_AntiAliasedLines | ImDrawListFlags_AntiAliasedFill | ImDrawListFlags_AllowVtxOffset;
    begin();
  }

  ImFont* add_font(float size, const ImWchar* ranges) {
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.OversampleH = 2;
    config.OversampleV = 1;
    const auto bytes = static_cast<int>(rheo_font_end - rheo_font_begin);
    ImFont* font =
        atlas.AddFontFromMemoryTTF(const_cast<unsigned char*>(rheo_font_begin), bytes, size, &config, ranges);
    if (!font) throw std::runtime_error("the embedded font cannot be read");
    return font;
  }

  void begin() {
    list._ResetForNewFrame();
    list.PushClipRectFullScreen();
    list.PushTextureID(atlas.TexID);
  }

  static float measure(const ImFont& font, std::string_view text) {
    const std::string s = one_line(text);
    return font.CalcTextSizeA(font.FontSize, FLT_MAX, 0, s.data(), s.data() + s.size()).x;
  }

  // Returns where the ink lies; an empty box, x1 < x0, without any.
  Rect draw(ImFont& font, float x, float middle, Color color, std::string_view text) {
    const std::string s = one_line(text);
    const ImVec2 corner(std::round(x), std::round(middle - cap_middle * font.FontSize));
    list.AddText(&font, font.FontSize, corner, packed(color), s.data(), s.data() + s.size());
    Rect ink = no_ink;
    float pen = corner.x;
    for (const char *c = s.data(), *end = c + s.size(); c < end;) {
      unsigned int code = 0;
      c += std::max(ImTextCharFromUtf8(&code, c, end), 1);
      const ImFontGlyph* glyph = font.FindGlyph(static_cast<ImWchar>(code));
      if (!glyph) continue;
      if (glyph->Visible) {
        ink = joined(ink, {pen + glyph->X0, corner.y + glyph->Y0, pen + glyph->X1, corner.y + glyph->Y1});
      }
      pen += glyph->AdvanceX;
    }
    return ink;
  }

  void note(std::string_view text, const Rect& ink) {
    if (ink.x1 > ink.x0) texts.push_back({std::string(text), ink.x0, ink.y0, ink.x1, ink.y1});
  }

  ImguiRenderer renderer;
  Palette palette = theme::light;
  int width;
  int height;
  ImFontAtlas atlas;
  ImDrawListSharedData shared;
  ImDrawList list{&shared};
  std::array<float, 3> sizes{};
  std::array<ImFont*, 3> fonts{};
  std::array<ImFont*, 3> sub_fonts{};
  std::vector<TextBox> texts;
};

Canvas::Canvas(const Gl& gl, int width, int height, std::string_view characters)
    : impl_(std::make_unique<Impl>(gl, width, height, characters)) {}
Canvas::~Canvas() = default;
Canvas::Canvas(Canvas&&) noexcept = default;

int Canvas::width() const {
  return impl_->width;
}
int Canvas::height() const {
  return impl_->height;
}
const Palette& Canvas::palette() const {
  return impl_->palette;
}
void Canvas::set_palette(const Palette& palette) {
  impl_->palette = palette;
}
float Canvas::unit() const {
  return impl_->sizes[1] / 20.0f;
}
float Canvas::text_size(TextSize size) const {
  return impl_->sizes[static_cast<std::size_t>(size)];
}

void Canvas::line(Point a, Point b, Color color, float width) {
  // ImGui's AddLine shifts by half a pixel; a path does not.
  const std::array<ImVec2, 2> ends{vec(a), vec(b)};
  impl_->list.AddPolyline(ends.data(), 2, packed(color), 0, width);
}

void Canvas::polyline(std::span<const Point> points, Color color, float width, float dash) {
  // Pieces end at sharp corners, where a mitre would grow without bound; a disk rounds the corner instead.
  std::vector<ImVec2> piece;
  const auto draw_piece = [&] {
    if (piece.size() > 1) {
      impl_->list.AddPolyline(piece.data(), static_cast<int>(piece.size()), packed(color), 0, width);
    }
    piece.clear();
  };
  float walked = 0;  // length since the start, for the dashes
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point p = points[i];
    if (i == 0) {
      piece.push_back(vec(p));
      continue;
    }
    const Point q = points[i - 1];
    const float dx = p.x - q.x, dy = p.y - q.y, size = std::hypot(dx, dy);
    if (size < 1e-3f) continue;
    if (i > 1 && piece.size() > 1) {
      const ImVec2 before = piece[piece.size() - 2], corner = piece.back();
      const float ex = corner.x - before.x, ey = corner.y - before.y;
      const float turn = (ex * dx + ey * dy) / (std::max(std::hypot(ex, ey), 1e-6f) * size);
      if (turn < 0.5f || piece.size() >= chunk) {
        draw_piece();
        piece.push_back(corner);
        if (turn < 0.5f && width > 1.2f && color.a == 255) disk({corner.x, corner.y}, width / 2, color);
      }
    }
    if (dash <= 0) {
      piece.push_back(vec(p));
      continue;
    }
    float s = 0;
    while (s < size) {
      const float phase = std::fmod(walked, dash);
      const bool on = phase < 0.6f * dash;
      const float until = (on ? 0.6f * dash : dash) - phase;
      const float step = std::max(std::min(until, size - s), 1e-3f);
      s += step;
      walked += step;
      const ImVec2 at(q.x + dx * std::min(s / size, 1.0f), q.y + dy * std::min(s / size, 1.0f));
      if (on) {
        piece.push_back(at);
        if (step >= until) draw_piece();
      } else {
        piece.assign(1, at);
      }
    }
  }
  draw_piece();
}

void Canvas::triangle(Point a, Point b, Point c, Color color) {
  impl_->list.AddTriangleFilled(vec(a), vec(b), vec(c), packed(color));
}

void Canvas::disk(Point center, float radius, Color color) {
  impl_->list.AddCircleFilled(vec(center), radius, packed(color));
}

void Canvas::rect(const Rect& r, Color color, float radius) {
  impl_->list.AddRectFilled({r.x0, r.y0}, {r.x1, r.y1}, packed(color), radius);
}

void Canvas::frame(const Rect& r, Color color, float width) {
  const std::array<ImVec2, 4> corners{ImVec2(r.x0, r.y0), ImVec2(r.x1, r.y0), ImVec2(r.x1, r.y1),
                                      ImVec2(r.x0, r.y1)};
  impl_->list.AddPolyline(corners.data(), 4, packed(color), ImDrawFlags_Closed, width);
}

void Canvas::gradient(const Rect& r, Color top, Color bottom) {
  impl_->list.AddRectFilledMultiColor({r.x0, r.y0}, {r.x1, r.y1}, packed(top), packed(top), packed(bottom),
                                      packed(bottom));
}

float Canvas::text_width(TextSize size, std::string_view s) const {
  return Impl::measure(*impl_->fonts[static_cast<std::size_t>(size)], s);
}

void Canvas::text(Point at, Align align, TextSize size, Color color, std::string_view s) {
  const float w = align == Align::left ? 0.0f : text_width(size, s);
  const float x = at.x - (align == Align::right ? w : w / 2);
  impl_->note(s, impl_->draw(*impl_->fonts[static_cast<std::size_t>(size)], x, at.y, color, s));
}

float Canvas::label_width(TextSize size, std::string_view s) const {
  const auto k = static_cast<std::size_t>(size);
  float w = 0;
  for (const Run& run : typeset(s)) {
    w += Impl::measure(run.level == Level::base ? *impl_->fonts[k] : *impl_->sub_fonts[k], run.text);
  }
  return w;
}

void Canvas::label(Point at, Align align, TextSize size, Color color, std::string_view s) {
  const auto k = static_cast<std::size_t>(size);
  const float w = label_width(size, s);
  float x = align == Align::left ? at.x : align == Align::right ? at.x - w : at.x - w / 2;
  Rect ink = no_ink;
  for (const Run& run : typeset(s)) {
    ImFont& font = run.level == Level::base ? *impl_->fonts[k] : *impl_->sub_fonts[k];
    const float shift = run.level == Level::base ? 0.0f : (run.level == Level::lower ? 0.24f : -0.30f);
    ink = joined(ink, impl_->draw(font, x, at.y + shift * impl_->sizes[k], color, run.text));
    x += Impl::measure(font, run.text);
  }
  impl_->note(s, ink);
}

void Canvas::label_upwards(Point at, TextSize size, Color color, std::string_view s) {
  // Drawn in the picture's middle, where nothing of it is clipped, then turned and moved.
  const Point center{std::round(static_cast<float>(impl_->width) / 2),
                     std::round(static_cast<float>(impl_->height) / 2)};
  const Point to{std::round(at.x), std::round(at.y)};
  const int first = impl_->list.VtxBuffer.Size;
  const std::size_t noted = impl_->texts.size();
  label(center, Align::center, size, color, s);
  for (int i = first; i < impl_->list.VtxBuffer.Size; ++i) {
    ImVec2& p = impl_->list.VtxBuffer[i].pos;
    p = {to.x + (p.y - center.y), to.y - (p.x - center.x)};
  }
  for (std::size_t i = noted; i < impl_->texts.size(); ++i) {
    TextBox& t = impl_->texts[i];
    const Rect lying{t.x0, t.y0, t.x1, t.y1};
    t.x0 = to.x + (lying.y0 - center.y);
    t.x1 = to.x + (lying.y1 - center.y);
    t.y0 = to.y - (lying.x1 - center.x);
    t.y1 = to.y - (lying.x0 - center.x);
  }
}

std::string Canvas::fit(TextSize size, std::string_view s, float width) const {
  if (text_width(size, s) <= width) return std::string(s);
  std::string text(s);
  while (!text.empty()) {
    // Whole UTF-8 characters.
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80) text.pop_back();
    if (!text.empty()) text.pop_back();
    if (text_width(size, text + "…") <= width) return text + "…";
  }
  return text;
}

const std::vector<TextBox>& Canvas::texts() const {
  return impl_->texts;
}
void Canvas::set_texts(std::vector<TextBox> texts) {
  impl_->texts = std::move(texts);
}

void Canvas::flush() {
  ImDrawList* lists = &impl_->list;
  ImDrawData data;
  data.Valid = true;
  data.CmdLists = &lists;
  data.CmdListsCount = 1;
  data.TotalIdxCount = impl_->list.IdxBuffer.Size;
  data.TotalVtxCount = impl_->list.VtxBuffer.Size;
  data.DisplayPos = ImVec2(0, 0);
  data.DisplaySize = ImVec2(static_cast<float>(impl_->width), static_cast<float>(impl_->height));
  data.FramebufferScale = ImVec2(1, 1);
  impl_->renderer.draw(data, Rows::top_first);
  impl_->begin();
}

}  // namespace render
