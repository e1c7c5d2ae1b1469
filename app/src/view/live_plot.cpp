#include "view/live_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

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

std::vector<double> labelled_ticks(double low, double high, int most,
                                   const std::function<bool(const std::vector<double>&)>& fit) {
  std::vector<double> few;
  for (int count = std::max(most, 3); count > 0; --count) {
    std::vector<double> ticks = axis_ticks(low, high, count);
    if (!fit(ticks)) continue;
    if (ticks.size() >= 2) return ticks;
    if (few.empty()) few = std::move(ticks);
  }
  return few;
}

namespace {

constexpr const char* prefixes[]{"p", "n", "\u00b5", "m", "", "k", "M", "G", "T"};

// The prefix that gives one to three digits before the point; 0: none.
int group_of(double size) {
  return std::clamp(static_cast<int>(std::floor(std::log10(size * 1.0005) / 3.0)), -4, 4);
}

}  // namespace

PrefixedUnit prefixed_unit(double largest, const char* unit) {
  const double size = std::abs(largest);
  if (!(size > 0.0) || !std::isfinite(size)) return {1.0, unit};
  const int group = group_of(size);
  return {std::pow(1000.0, group), std::string(prefixes[group + 4]) + unit};
}

std::string short_number(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value == 0.0 ? "0" : "-";
  const double size = std::abs(value);
  if (size < 1e-13) return fmt::format("{:.1e}", value);
  const int group = group_of(size);
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
  const float width = 0.11f * ImGui::GetFontSize();
  const std::size_t stride = 1 + t.size() / 1200;
  for (std::size_t i = stride; i < t.size(); i += stride) {
    const double from = curve.y[i - stride], to = curve.y[i];
    if (std::isfinite(from) && std::isfinite(to))
      list.AddLine(frame.at(t[i - stride], from), frame.at(t[i], to), curve.color, width);
  }
}

}  // namespace

std::string live_plot(const PlotPlace& place, std::span<const double> t, std::span<const Curve> curves) {
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
  const bool flat = !(high > low);  // then it has no scale but its 0
  if (flat) high = low + 1.0;
  const double room = 0.06 * (high - low);
  const PrefixedUnit shown = flat ? PrefixedUnit{1.0, unit} : prefixed_unit(std::max(-low, high), unit);
  const std::string heading = fmt::format("{} [{}]", title, shown.name);
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
  const bool begun = frame.x1 > frame.x0 && t.size() > 1;
  if (!begun) frame.x1 = frame.x0 + 1.0;
  if (frame.high.x - frame.low.x < 20.0f || frame.high.y - frame.low.y < 20.0f) return heading;

  list.AddText({corner.x, corner.y}, ink, heading.c_str());
  float legend = corner.x + first, row = corner.y;
  for (const Curve& curve : curves) {
    const float width = ImGui::CalcTextSize(curve.name).x;
    if (legend + 1.2f * text + width > corner.x + size.x) {
      legend = corner.x + 3.4f * text;
      row += 1.2f * text;
    }
    list.AddLine({legend, row + 0.55f * text}, {legend + 0.9f * text, row + 0.55f * text}, curve.color,
                 0.17f * text);
    list.AddText({legend + 1.1f * text, row}, soft, curve.name);
    legend += 1.9f * text + width;
  }
  list.AddLine({frame.low.x, frame.high.y}, frame.high, soft);
  list.AddLine(frame.low, {frame.low.x, frame.high.y}, soft);
  if (!begun) {
    const char* const words = "nothing yet";
    const ImVec2 extent = ImGui::CalcTextSize(words);
    list.AddText({(frame.low.x + frame.high.x - extent.x) / 2, (frame.low.y + frame.high.y - extent.y) / 2},
                 soft, words);
    return heading;
  }

  const auto height_of = [&](double y) { return frame.at(frame.x0, y).y; };
  const auto apart = [&](const std::vector<double>& at) {
    return at.size() < 2 || height_of(at[0]) - height_of(at[1]) >= 1.3f * text;
  };
  const std::vector<double> levels =
      flat ? std::vector<double>{0.0}
           : labelled_ticks(frame.y0, frame.y1,
                            static_cast<int>((frame.high.y - frame.low.y) / (2.0f * text)), apart);
  for (const double y : levels) {
    const ImVec2 p = frame.at(frame.x0, y);
    if (!flat) list.AddLine(p, {frame.high.x, p.y}, grid);
    const std::string label =
        fmt::format("{:.4g}", std::abs(y) < 1e-12 * (frame.y1 - frame.y0) ? 0.0 : y / shown.size);
    list.AddText({p.x - ImGui::CalcTextSize(label.c_str()).x - 0.3f * text, p.y - 0.5f * text}, soft,
                 label.c_str());
  }
  const auto time_text = [](double x) { return fmt::format("{:.6g} s", x); };
  const auto extent_of = [&, corner = corner, size = size](double x) -> std::array<float, 2> {
    const float width = ImGui::CalcTextSize(time_text(x).c_str()).x, middle = frame.at(x, frame.y0).x;
    const float left =
        std::clamp(middle - width / 2, corner.x, std::max(corner.x, corner.x + size.x - width));
    return {left, left + width};
  };
  const auto beside = [&](const std::vector<double>& at) {
    for (std::size_t i = 1; i < at.size(); ++i)
      if (extent_of(at[i])[0] < extent_of(at[i - 1])[1] + 0.5f * text) return false;
    return true;
  };
  for (const double x : labelled_ticks(
           frame.x0, frame.x1, static_cast<int>((frame.high.x - frame.low.x) / (4.0f * text)), beside)) {
    const ImVec2 p = frame.at(x, frame.y0);
    list.AddLine({p.x, frame.high.y}, {p.x, frame.high.y + 0.25f * text}, soft);
    list.AddText({extent_of(x)[0], frame.high.y + 0.25f * text}, soft, time_text(x).c_str());
  }
  list.PushClipRect(frame.low, {frame.high.x, frame.high.y + 1.0f}, true);
  for (const Curve& curve : curves) draw_curve(list, frame, t, curve);
  list.PopClipRect();

  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (!hovered || mouse.x < frame.low.x || mouse.x > frame.high.x) return heading;
  const double x = frame.x0 + (mouse.x - frame.low.x) / (frame.high.x - frame.low.x) * (frame.x1 - frame.x0);
  const auto after = static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), x) - t.begin());
  const std::size_t i = std::min(after, t.size() - 1);
  list.AddLine({mouse.x, frame.low.y}, {mouse.x, frame.high.y}, soft);
  std::string values = fmt::format("t = {:.4g} s", t[i]);
  for (const Curve& curve : curves) values += fmt::format("\n{} {}", curve.name, with_unit(curve.y[i], unit));
  ImGui::SetTooltip("%s", values.c_str());
  return heading;
}

}  // namespace app::view
