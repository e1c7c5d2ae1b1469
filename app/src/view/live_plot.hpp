// A small plot with axes in a user interface: titles, ticks, legend, the values under the cursor.
//
// Units    of x: seconds; y: as labelled
// Errors   none: what is not finite is left out
#pragma once

#include <imgui.h>

#include <span>
#include <string>
#include <vector>

namespace app::view {

struct Curve {
  const char* name;
  std::span<const double> y;
  unsigned color;  // ImGui's packed
};

struct PlotPlace {
  const char* title;
  const char* unit;
  ImVec2 corner, size;  // pixels
  bool hovered;         // then the values under the cursor are told
};

void live_plot(const PlotPlace& place, std::span<const double> t, std::span<const Curve> curves);

// Steps of 1, 2 or 5 times a power of ten with about `count` ticks.
std::vector<double> axis_ticks(double low, double high, int count);
// "1.5m", "20k": three digits and a prefix.
std::string short_number(double value);
// "20 kPa": the prefix goes to the unit.
std::string with_unit(double value, const char* unit);

}  // namespace app::view
