// How Ui's texts and widgets look: their size, font and colours.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "view/ui.hpp"

namespace app::view {
namespace {

constexpr float font_pixels = 15.0f;
constexpr float largest_scale = 4.0f, smallest_share = 0.75f;

}  // namespace

float interface_scale(float of_display, int width, int height) {
  const float room = std::min(static_cast<float>(width) / 1280.0f, static_cast<float>(height) / 720.0f);
  // Beside a small picture without panels smaller words do.
  const bool small = room < 0.5f * of_display;
  return std::clamp(std::floor(8.0f * room) / 8.0f, small ? smallest_share * of_display : of_display,
                    std::max(of_display, largest_scale));
}

void Ui::load_fonts() {
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  ImFontGlyphRangesBuilder builder;
  builder.AddRanges(io.Fonts->GetGlyphRangesDefault());
  builder.AddText("\u03bb\u03bc\u03c9\u03c1\u2013\u2026\u2192\u2265\u2264");
  ImVector<ImWchar> ranges;
  builder.BuildRanges(&ranges);
  const auto font = render::embedded_font();
  io.Fonts->AddFontFromMemoryTTF(const_cast<unsigned char*>(font.data()), static_cast<int>(font.size()),
                                 std::round(font_pixels * scale_), &config, ranges.Data);
  io.Fonts->Build();
  screen_.upload_fonts(*io.Fonts);
}

void Ui::set_scale(float scale) {
  if (scale == scale_) return;
  scale_ = scale;
  load_fonts();
  set_style_colors();
}

void Ui::set_style_colors() {
  ImGuiStyle style;
  if (style_.dark)
    ImGui::StyleColorsDark(&style);
  else
    ImGui::StyleColorsLight(&style);
  style.WindowRounding = 0.0f;
  style.FrameRounding = 3.0f;
  style.GrabRounding = 3.0f;
  style.WindowBorderSize = 1.0f;
  style.FrameBorderSize = style_.dark ? 0.0f : 1.0f;
  style.WindowPadding = {10.0f, 8.0f};
  style.ItemSpacing = {6.0f, 5.0f};
  style.ScaleAllSizes(scale_);
  style.Colors[ImGuiCol_WindowBg] =
      style_.dark ? ImVec4(0.115f, 0.125f, 0.15f, 1.0f) : ImVec4(0.955f, 0.96f, 0.97f, 1.0f);
  ImGui::GetStyle() = style;
  dark_set_ = style_.dark;
}

}  // namespace app::view
