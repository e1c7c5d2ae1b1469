#include "view/live_plot.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

namespace app::view {

std::vector<double> axis_ticks(double low, double high, int count) {
  std::vector<double> ticks;
  if (!(high > low) || !std::isfinite(high - low) || count < 1) return ticks;
  const double rough = (high - low) / count;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double s : {1.0, 2.0, 5.0})
    if (s * power >= rough) {
      step = s * power;
      break;
    }
  const double first = std::ceil(low / step - 1e-9);
  for (int k = 0; k < 100 && (first + k) * step <= high + 1e-9 * step; ++k)
    ticks.push_back((first + k) * step);
  return ticks;
}

std::string short_number(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value == 0.0 ? "0" : "-";
  static constexpr const char* prefixes[]{"p", "n", "\u00b5", "m", "", "k", "M", "G", "T"};
  const double size = std::abs(value);
  const int group = std::clamp(static_cast<int>(std::floor(std::log10(size * 1.0005) / 3.0)), -4, 4);
  if (size < 1e-13) return fmt::format("{:.1e}", value);
  return fmt::format("{:.3g}{}", value / std::pow(1000.0, group), prefixes[group + 4]);
}

std::string with_unit(double value, const char* unit) {
  std::string text = short_number(value);
  const bool prefixed = !text.empty() && !(text.back() >= '0' && text.back() <= '9');
  if (!prefixed) return fmt::format("{} {}", text, unit);
  // The prefix goes to the unit; it may take two bytes.
  const std::size_t at = text.find_first_not_of("0123456789.-+e");
  return fmt::format("{} {}{}", text.substr(0, at), text.substr(at), unit);
}

namespace {

struct Frame {
  ImVec2 low, high;  // corners in pixels
  double x0, x1, y0, y1;
  ImVec2 at(double x, double y) const {
    return {low.x + static_cast<float>((x - x0) / (x1 - x0)) * (high.x - low.x),
            high.y - static_cast<float>((y - y0) / (y1 - y0)) * (high.y - low.y)};
  }
};

// Piece by piece: a polyline's mitres leave gaps at sharp peaks.
void draw_curve(ImDrawList& list, const Frame& frame, std::span<const double> t, const Curve& curve) {
  const std::size_t stride = 1 + t.size() / 1200;
  for (std::size_t i = stride; i < t.size(); i += stride) {
    const double from = curve.y[i - stride], to = curve.y[i];
    if (std::isfinite(from) && std::isfinite(to))
      list.AddLine(frame.at(t[i - stride], from), frame.at(t[i], to), curve.color, 1.6f);
  }
}

}  // namespace

void live_plot(const PlotPlace& place, std::span<const double> t, std::span<const Curve> curves) {
  const auto& [title, unit, corner, size, hovered] = place;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float text = ImGui::GetFontSize();
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text), soft = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  const ImU32 grid = ImGui::GetColorU32(ImGuiCol_Border, 0.55f);

  double low = 0.0, high = 0.0;
  for (const Curve& curve : curves)
    for (const double y : curve.y)
      if (std::isfinite(y)) {
        low = std::min(low, y);
        high = std::max(high, y);
      }
  if (!(high > low)) high = low + 1.0;
  const double room = 0.06 * (high - low);
  const std::string heading = fmt::format("{} [{}]", title, unit);
  const float first = ImGui::CalcTextSize(heading.c_str()).x + 0.8f * text;
  float rows = 1.0f, end = first;  // of the legend
  for (const Curve& curve : curves) {
    const float width = ImGui::CalcTextSize(curve.name).x;
    if (end + 1.2f * text + width > size.x) {
      ++rows;
      end = 3.4f * text;
    }
    end += 1.9f * text + width;
  }
  Frame frame{{corner.x + 3.4f * text, corner.y + (0.35f + 1.15f * rows) * text},
              {corner.x + size.x - 0.6f * text, corner.y + size.y - 1.5f * text},
              t.empty() ? 0.0 : t.front(),
              t.empty() ? 1.0 : t.back(),
              low < 0.0 ? low - room : 0.0,
              high + room};
  if (!(frame.x1 > frame.x0)) frame.x1 = frame.x0 + 1.0;
  if (frame.high.x - frame.low.x < 20.0f || frame.high.y - frame.low.y < 20.0f) return;

  list.AddText({corner.x, corner.y}, ink, heading.c_str());
  float legend = corner.x + first, row = corner.y;
  for (const Curve& curve : curves) {
    const float width = ImGui::CalcTextSize(curve.name).x;
    if (legend + 1.2f * text + width > corner.x + size.x) {
      legend = corner.x + 3.4f * text;
      row += 1.2f * text;
    }
    list.AddLine({legend, row + 0.55f * text}, {legend + 0.9f * text, row + 0.55f * text}, curve.color, 2.5f);
    list.AddText({legend + 1.1f * text, row}, soft, curve.name);
    legend += 1.9f * text + width;
  }
  for (const double y : axis_ticks(
           frame.y0, frame.y1, std::max(2, static_cast<int>((frame.high.y - frame.low.y) / (2.0f * text))))) {
    const ImVec2 p = frame.at(frame.x0, y);
    list.AddLine(p, {frame.high.x, p.y}, grid);
    const std::string label = short_number(std::abs(y) < 1e-12 * (frame.y1 - frame.y0) ? 0.0 : y);
    list.AddText({p.x - ImGui::CalcTextSize(label.c_str()).x - 0.3f * text, p.y - 0.5f * text}, soft,
                 label.c_str());
  }
  float free = corner.x;  // of labels, from the left
  for (const double x : axis_ticks(
           frame.x0, frame.x1, std::max(2, static_cast<int>((frame.high.x - frame.low.x) / (5.0f * text))))) {
    const ImVec2 p = frame.at(x, frame.y0);
    list.AddLine(p, {p.x, p.y + 0.25f * text}, soft);
    const std::string label = fmt::format("{:.4g} s", x);
    const float width = ImGui::CalcTextSize(label.c_str()).x;
    const float left = std::clamp(p.x - width / 2, corner.x, std::max(corner.x, corner.x + size.x - width));
    if (left < free) continue;  // it would touch the one before
    free = left + width + 0.5f * text;
    list.AddText({left, p.y + 0.25f * text}, soft, label.c_str());
  }
  list.AddLine({frame.low.x, frame.high.y}, frame.high, soft);
  list.AddLine(frame.low, {frame.low.x, frame.high.y}, soft);
  list.PushClipRect(frame.low, {frame.high.x, frame.high.y + 1.0f}, true);
  for (const Curve& curve : curves) draw_curve(list, frame, t, curve);
  list.PopClipRect();

  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (!hovered || t.empty() || mouse.x < frame.low.x || mouse.x > frame.high.x) return;
  const double x = frame.x0 + (mouse.x - frame.low.x) / (frame.high.x - frame.low.x) * (frame.x1 - frame.x0);
  const auto after = static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), x) - t.begin());
  const std::size_t i = std::min(after, t.size() - 1);
  list.AddLine({mouse.x, frame.low.y}, {mouse.x, frame.high.y}, soft);
  std::string values = fmt::format("t = {:.4g} s", t[i]);
  for (const Curve& curve : curves)
    values += fmt::format("\n{} {} {}", curve.name, short_number(curve.y[i]), unit);
  ImGui::SetTooltip("%s", values.c_str());
}

}  // namespace app::view
