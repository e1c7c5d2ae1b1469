// What Ui draws over the picture: the lit edges, the hand, the clock and what the user is told.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "view/live_plot.hpp"
#include "view/ui.hpp"

namespace app::view {
namespace {

// What a linear model no longer means here; empty: nothing.
std::string beyond_linear(const rheo::LinearityReport& report) {
  constexpr double degree = 0.017453292519943295;
  if (report.inverted > 0)
    return fmt::format("{} {} inside out: beyond what a linear model means", report.inverted,
                       report.inverted == 1 ? "triangle" : "triangles");
  if (report.strain > rheo::strain_limit)
    return fmt::format("strain {:.0f} %: beyond {:.0f} % a linear model loses its meaning",
                       100.0 * report.strain, 100.0 * rheo::strain_limit);
  if (report.rotation > rheo::rotation_limit)
    return fmt::format("rotation {:.0f} degrees: beyond {:.0f} a linear model swells",
                       report.rotation / degree, rheo::rotation_limit / degree);
  return {};
}

}  // namespace

void Ui::draw_overlay() {
  const Display& d = *display_;
  const float s = scale_, text = ImGui::GetFontSize();
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto x0 = static_cast<float>(area_[0]), y0 = static_cast<float>(area_[1]);
  const float x1 = x0 + static_cast<float>(area_[2]), y1 = y0 + static_cast<float>(area_[3]);
  list.PushClipRect({x0, y0}, {x1, y1});
  const auto pixel = [&](double x, double y) {
    const auto [px, py] = picture_.plane().pixel(x, y);
    return ImVec2(x0 + static_cast<float>(px), y0 + static_cast<float>(py));
  };
  const float most_width = std::max(8.0f * text, x1 - x0 - 1.6f * text);  // of words; longer ones take lines
  const auto plate = [&](ImVec2 at, const std::string& words, ImU32 ink, ImU32 paper) {
    const ImVec2 size = ImGui::CalcTextSize(words.c_str(), nullptr, false, most_width);
    const float bar = style_.color == rheo::ColorBy::none ? 0.4f : 6.5f;  // clear of the colour bar's numbers
    at.x = std::clamp(at.x, x0 + 0.4f * text, std::max(x0 + 0.4f * text, x1 - size.x - bar * text));
    at.y = std::clamp(at.y, y0 + 0.3f * text, std::max(y0 + 0.3f * text, y1 - size.y - 0.3f * text));
    list.AddRectFilled({at.x - 0.4f * text, at.y - 0.2f * text},
                       {at.x + size.x + 0.4f * text, at.y + size.y + 0.2f * text}, paper, 4.0f * s);
    list.AddText(nullptr, 0.0f, at, ink, words.c_str(), nullptr, most_width);
    labels_.push_back(words);
  };
  const ImU32 paper = style_.dark ? IM_COL32(24, 27, 33, 225) : IM_COL32(252, 252, 253, 225);
  const ImU32 ink = style_.dark ? IM_COL32(226, 230, 238, 255) : IM_COL32(31, 36, 48, 255);
  const ImU32 lit = style_.dark ? IM_COL32(255, 196, 64, 255) : IM_COL32(235, 140, 0, 255);
  const ImU32 force = style_.dark ? IM_COL32(255, 122, 92, 255) : IM_COL32(200, 62, 38, 255);

  const bool held = d.hand.hold != Hold::nothing;
  for (const rheo::Edge& edge : dragging_ || held ? (held ? d.hand.edges : hovered_) : hovered_) {
    const auto i = 2 * static_cast<std::size_t>(edge[0]), j = 2 * static_cast<std::size_t>(edge[1]);
    if (std::max(i, j) + 1 >= d.positions.size()) continue;
    list.AddLine(pixel(d.positions[i], d.positions[i + 1]), pixel(d.positions[j], d.positions[j + 1]), lit,
                 5.0f * s);
  }
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool in_picture = mouse.x > x0 && mouse.x < x1 && mouse.y > y0 && mouse.y < y1;
  if (!hovered_.empty() && !dragging_ && in_picture) list.AddCircle(mouse, brush_ * s, lit, 0, 1.2f * s);
  if (dragging_) {
    const rheo::Vec2 from = d.hand.edges.empty() || !held ? drag_from_ : middle_of(d.hand.edges, d.positions);
    // A push is shown as what it is, at the scale of the hand's strength; a grab by where the hand is.
    rheo::Vec2 to = drag_to_;
    if (held && mode_ == Hold::push && push_gain_ > 0.0)
      to = {from.x + d.hand.traction.x / push_gain_, from.y + d.hand.traction.y / push_gain_};
    const ImVec2 a = pixel(from.x, from.y), b = pixel(to.x, to.y);
    const float dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    if (length > 6.0f * s && std::isfinite(length)) {
      const float head = std::min(12.0f * s, 0.5f * length), ux = dx / length, uy = dy / length;
      list.AddLine(a, {b.x - ux * head * 0.8f, b.y - uy * head * 0.8f}, force, 3.0f * s);
      list.AddTriangleFilled(b, {b.x - ux * head - uy * head * 0.45f, b.y - uy * head + ux * head * 0.45f},
                             {b.x - ux * head + uy * head * 0.45f, b.y - uy * head - ux * head * 0.45f},
                             force);
    }
    const double newton = std::hypot(d.hand.force.x, d.hand.force.y);
    const ImVec2 at{mouse.x + 0.9f * text, mouse.y + 0.9f * text};
    if (mode_ == Hold::push)
      plate(at,
            fmt::format("push {} ({})", with_unit(std::hypot(d.hand.traction.x, d.hand.traction.y), "Pa"),
                        with_unit(newton, "N")),
            force, paper);
    else
      plate(at, fmt::format("reaction {}", with_unit(newton, "N")), force, paper);
  }

  if (const std::string beyond = beyond_linear(d.linearity); !beyond.empty())
    plate({x0 + 0.8f * text,
           y1 - 2.4f * text - ImGui::CalcTextSize(beyond.c_str(), nullptr, false, most_width).y},
          beyond, ink, paper);
  // In plain sight whether the clock on the picture is the user's.
  std::string clock = fmt::format("real time x{:.2f}", d.real_time_factor);
  bool slow = false;
  if (recording_.is_on()) {
    clock = fmt::format("recording, frame {}", recording_.frames());
    slow = true;
  } else if (!d.running) {
    clock = "paused  (Space runs)";
  } else if (d.resting) {
    clock = "at rest";
  } else {
    slow = d.real_time_factor < 0.9 * d.speed_wanted;
  }
  if (slow && !recording_.is_on()) clock += ": the machine cannot keep up";
  plate({x0 + 0.8f * text, y1 - 1.7f * text}, clock, slow ? IM_COL32(255, 255, 255, 255) : ink,
        slow ? IM_COL32(200, 62, 38, 235) : paper);
  if (toast_left_ > 0.0 && !toast_.empty()) {
    const float width = std::max(120.0f, x1 - x0 - 3.0f * text);
    const ImVec2 size = ImGui::CalcTextSize(toast_.c_str(), nullptr, false, width);
    const ImVec2 at{x0 + std::max(1.2f * text, (x1 - x0 - size.x) / 2), y1 - size.y - 3.2f * text};
    list.AddRectFilled({at.x - 0.6f * text, at.y - 0.4f * text},
                       {at.x + size.x + 0.6f * text, at.y + size.y + 0.4f * text}, IM_COL32(31, 36, 48, 235),
                       5.0f * s);
    list.AddText(nullptr, 0.0f, at, IM_COL32(250, 250, 250, 255), toast_.c_str(), nullptr, width);
    labels_.push_back(toast_);
  }
  list.PopClipRect();
}

}  // namespace app::view
