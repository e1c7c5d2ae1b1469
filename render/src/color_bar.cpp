#include "color_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "colormap.hpp"
#include "ticks.hpp"

namespace render {
namespace {

// The bar's numbers: none without a finite range, one for a single value.
Ticks bar_ticks(const ColorBar& bar, int most) {
  const auto [low, high] = bar.range;
  if (std::isfinite(low) && low == high) return {{low}, {fmt::format("{:.3g}", low)}, {}, 0};
  return linear_ticks(low, high, most);
}

std::string with_power(int exponent, const std::string& unit) {
  return fmt::format("10^{} {}", exponent, unit);
}

std::string bar_unit(const ColorBar& bar, const Ticks& ticks) {
  return ticks.exponent == 0 ? bar.unit : with_power(ticks.exponent, bar.unit);
}

// The longest that linear_ticks() writes of a range from 0 on, and the widest power.
constexpr const char* widest_number = "00000";
constexpr int widest_exponent = -88;

int bar_tick_count(const Canvas& canvas, float height) {
  return std::clamp(static_cast<int>(height / (2.2f * canvas.text_size(TextSize::small))), 2, 9);
}

// Leaves out numbers until those left do not touch: every second one, every third one, ...
void thin_out(const Canvas& canvas, const ColorBar& bar, float height, Ticks& ticks) {
  const double span = bar.range[1] - bar.range[0];
  if (ticks.at.size() < 2 || !(span > 0)) return;
  const double apart = (ticks.at[1] - ticks.at[0]) / span * static_cast<double>(height);
  const auto every =
      std::max(1, static_cast<int>(std::ceil(1.1 * canvas.text_size(TextSize::small) / apart)));
  Ticks kept;
  kept.exponent = ticks.exponent;
  for (std::size_t i = 0; i < ticks.at.size(); i += static_cast<std::size_t>(every)) {
    kept.at.push_back(ticks.at[i]);
    kept.labels.push_back(ticks.labels[i]);
  }
  ticks = std::move(kept);
}

}  // namespace

float color_bar_width(const Canvas& canvas, const ColorBar& bar) {
  const float text = canvas.text_size(TextSize::small);
  const Ticks ticks = bar_ticks(bar, bar_tick_count(canvas, 0.7f * static_cast<float>(canvas.height())));
  const bool fixed = bar.room == BarRoom::fixed;
  float numbers = fixed ? canvas.text_width(TextSize::small, widest_number) : 0.0f;
  for (const std::string& s : ticks.labels)
    numbers = std::max(numbers, canvas.text_width(TextSize::small, s));
  float name = std::max(canvas.label_width(TextSize::normal, bar.name),
                        canvas.label_width(TextSize::small, bar_unit(bar, ticks)));
  if (fixed)
    name = std::max(name, canvas.label_width(TextSize::small, with_power(widest_exponent, bar.unit)));
  return std::max(1.6f * text + numbers, name);
}

void draw_color_bar(Canvas& canvas, const ColorBar& bar, const Rect& area) {
  const float text = canvas.text_size(TextSize::small), normal = canvas.text_size(TextSize::normal);
  const Rect strip{std::round(area.x0), std::round(area.y0 + normal + 1.7f * text),
                   std::round(area.x0 + 0.9f * text), std::round(area.y1)};
  Ticks ticks = bar_ticks(bar, bar_tick_count(canvas, strip.height()));
  thin_out(canvas, bar, std::max(strip.height(), 1.0f), ticks);
  canvas.label({area.x0, area.y0 + 0.5f * normal}, Align::left, TextSize::normal, canvas.palette().ink,
               bar.name);
  canvas.label({area.x0, area.y0 + normal + 0.7f * text}, Align::left, TextSize::small,
               canvas.palette().soft_ink, bar_unit(bar, ticks));
  if (strip.height() < 2) return;

  const std::array<Rgb, 256> map = make_colormap();
  const auto color = [&map](std::size_t i) { return Color{map[i][0], map[i][1], map[i][2]}; };
  const bool spread = bar.range[1] > bar.range[0];
  constexpr std::size_t slices = 64;
  for (std::size_t i = 0; i < slices; ++i) {
    const auto edge = [&](std::size_t k) {
      return std::round(strip.y1 - strip.height() * static_cast<float>(k) / static_cast<float>(slices));
    };
    const std::size_t below = spread ? i * 255 / slices : 0, above = spread ? (i + 1) * 255 / slices : 0;
    canvas.gradient({strip.x0, edge(i + 1), strip.x1, edge(i)}, color(above), color(below));
  }
  canvas.frame(strip, canvas.palette().ink, std::max(1.0f, canvas.unit()));
  for (std::size_t i = 0; i < ticks.at.size(); ++i) {
    const double t = spread ? (ticks.at[i] - bar.range[0]) / (bar.range[1] - bar.range[0]) : 0.0;
    const float y = std::round(strip.y1 - strip.height() * static_cast<float>(t));
    canvas.line({strip.x1, y}, {strip.x1 + 0.3f * text, y}, canvas.palette().ink,
                std::max(1.0f, canvas.unit()));
    canvas.text({strip.x1 + 0.5f * text, y}, Align::left, TextSize::small, canvas.palette().ink,
                ticks.labels[i]);
  }
}

}  // namespace render
