// What Ui draws over the picture: the lit edges, the hand, the clock and what the user is told.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "view/live_plot.hpp"
#include "view/ui.hpp"

namespace app::view {
namespace {

struct OverlayColors {
  NoteColors plain, alarm, told, force;
  ImU32 lit;
};

OverlayColors colors_of(const PictureStyle& style) {
  const ImU32 paper = style.dark ? IM_COL32(24, 27, 33, 240) : IM_COL32(252, 252, 253, 240);
  return {{style.dark ? IM_COL32(226, 230, 238, 255) : IM_COL32(31, 36, 48, 255), paper},
          {IM_COL32(255, 255, 255, 255), IM_COL32(200, 62, 38, 240)},
          {IM_COL32(250, 250, 250, 255), style.dark ? IM_COL32(62, 70, 88, 245) : IM_COL32(31, 36, 48, 240)},
          {style.dark ? IM_COL32(255, 122, 92, 255) : IM_COL32(200, 62, 38, 255), paper},
          style.dark ? IM_COL32(255, 196, 64, 255) : IM_COL32(235, 140, 0, 255)};
}

// A sentence, and fewer words for less room.
using Wordings = std::array<std::string, 2>;

// What a linear model no longer means here; empty: nothing.
Wordings beyond_linear(const rheo::LinearityReport& report) {
  constexpr double degree = 0.017453292519943295;
  if (report.inverted > 0) {
    const std::string many =
        fmt::format("{} {} inside out", report.inverted, report.inverted == 1 ? "triangle" : "triangles");
    return {many + ": beyond what a linear model means", many};
  }
  if (report.strain > rheo::strain_limit)
    // Not "10 %, beyond 10 %".
    return {fmt::format("strain {:.{}f} %: beyond {:.0f} % a linear model loses its meaning",
                        100.0 * report.strain, report.strain < 2.0 * rheo::strain_limit ? 1 : 0,
                        100.0 * rheo::strain_limit),
            fmt::format("strain {:.0f} %: not linear", 100.0 * report.strain)};
  if (report.rotation > rheo::rotation_limit)
    return {fmt::format("rotation {:.0f} degrees: beyond {:.0f} a linear model swells",
                        report.rotation / degree, rheo::rotation_limit / degree),
            fmt::format("rotation {:.0f} degrees: not linear", report.rotation / degree)};
  return {};
}

void draw_arrow(ImDrawList& list, const ImVec2& a, const ImVec2& b, ImU32 color, float scale) {
  const float dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
  if (!(length > 6.0f * scale) || !std::isfinite(length)) return;
  const float head = std::min(12.0f * scale, 0.5f * length), ux = dx / length, uy = dy / length;
  list.AddLine(a, {b.x - ux * head * 0.8f, b.y - uy * head * 0.8f}, color, 3.0f * scale);
  list.AddTriangleFilled(b, {b.x - ux * head - uy * head * 0.45f, b.y - uy * head + ux * head * 0.45f},
                         {b.x - ux * head + uy * head * 0.45f, b.y - uy * head - ux * head * 0.45f}, color);
}

}  // namespace

// In plain sight whether the clock on the picture is the user's.
Ui::Clock Ui::clock() const {
  const Display& d = *display_;
  if (recording_.is_on()) {
    const std::string text = fmt::format("recording, frame {}", recording_.frames());
    if (recording_runs_) return {text, text, Clock::Kind::alarm};
    return {text + ": waits  (Space goes on)", text + ": waits", Clock::Kind::alarm};
  }
  if (!d.running) return {"paused  (Space runs)", "paused", Clock::Kind::plain};
  if (d.resting) return {"at rest", "at rest", Clock::Kind::plain};
  const std::string text = fmt::format("real time x{:.2f}", d.real_time_factor);
  if (d.real_time_factor < 0.9 * d.speed_wanted)
    return {text + ": the machine cannot keep up", text, Clock::Kind::alarm};
  return {text, text, Clock::Kind::plain};
}

void Ui::draw_overlay() {
  const Display& d = *display_;
  const float s = scale_, text = ImGui::GetFontSize();
  const OverlayColors colors = colors_of(style_);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto x0 = static_cast<float>(area_[0]), y0 = static_cast<float>(area_[1]);
  const float x1 = x0 + static_cast<float>(area_[2]), y1 = y0 + static_cast<float>(area_[3]);
  list.PushClipRect({x0, y0}, {x1, y1});
  const auto pixel = [&](const rheo::Vec2& p) {
    const auto [px, py] = picture_.plane().pixel(p.x, p.y);
    return ImVec2(x0 + static_cast<float>(px), y0 + static_cast<float>(py));
  };

  const bool held = d.hand.hold != Hold::nothing;
  for (const rheo::Edge& edge : held ? d.hand.edges : hovered_)
    list.AddLine(pixel(place_of({edge, 0.0}, d.positions)), pixel(place_of({edge, 1.0}, d.positions)),
                 colors.lit, 5.0f * s);
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool in_picture = mouse.x > x0 && mouse.x < x1 && mouse.y > y0 && mouse.y < y1;
  if (!hovered_.empty() && !dragging_ && in_picture)
    list.AddCircle(mouse, brush_ * s, colors.lit, 0, 1.2f * s);

  // Beside the colour bar, below the title.
  const render::PictureArea beside_bar = picture_.mesh_picture().body_area();
  Notes notes(list, {{x0 + 0.4f * text, y0 + beside_bar.y0}, {x0 + beside_bar.x1, y1 - 0.4f * text}}, text);
  const auto note = [&](std::string written) {
    if (!written.empty()) labels_.push_back(std::move(written));
  };
  for (const render::TextBox& box : picture_.mesh_picture().texts())
    if (std::ranges::any_of(d.scene->bodies, [&](const auto& body) { return body.name == box.text; }))
      notes.keep_clear_of({{x0 + box.x0, y0 + box.y0}, {x0 + box.x1, y0 + box.y1}});
  const Clock now = clock();
  note(notes.stack(std::array{now.full, now.brief},
                   now.kind == Clock::Kind::alarm ? colors.alarm : colors.plain));
  if (const Wordings beyond = beyond_linear(d.linearity); !beyond[0].empty())
    note(notes.stack(beyond, colors.plain));
  if (toast_left_ > 0.0 && !toast_.empty()) note(notes.stack(std::array{toast_}, colors.told));

  // A push is shown as what it is, at the scale of the hand's strength, and not before the physics has it; a
  // grab by where the hand is.
  if (dragging_ && held && d.hand.press == press_) {
    const bool push = d.hand.hold == Hold::push;
    const rheo::Vec2 from = place_of(grip_, d.positions), p = d.hand.traction;
    const rheo::Vec2 to =
        push ? rheo::Vec2{from.x + p.x / push_gain(), from.y + p.y / push_gain()} : drag_to_;
    draw_arrow(list, pixel(from), pixel(to), colors.force.ink, s);
    for (const render::TextBox& box : picture_.mesh_picture().texts())
      notes.keep_clear_of({{x0 + box.x0, y0 + box.y0}, {x0 + box.x1, y0 + box.y1}});
    const std::string newton = with_unit(std::hypot(d.hand.force.x, d.hand.force.y), "N");
    const char* const paused = is_running() ? "" : ", paused";
    note(notes.beside(
        mouse,
        push ? fmt::format("push {} ({}){}", with_unit(std::hypot(p.x, p.y), "Pa"), newton, paused)
             : fmt::format("reaction {}{}", newton, paused),
        colors.force));
  }
  plates_ = notes.plates();
  list.PopClipRect();
}

}  // namespace app::view
