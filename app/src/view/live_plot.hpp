// A small plot with axes in a user interface: titles, ticks, legend, the values under the cursor.
//
// Units    of x: seconds; y: as labelled
// Errors   none: what is not finite is left out
#pragma once

#include <span>
#include <string>
#include <vector>

struct ImVec2;

namespace app::view {

struct Curve {
  const char* name;
  std::span<const double> y;
  unsigned color;  // ImGui's packed
};

// Takes `size` at the interface's cursor.
void live_plot(const char* title, const char* unit, std::span<const double> t, std::span<const Curve> curves,
               const ImVec2& size);

// Steps of 1, 2 or 5 times a power of ten with about `count` ticks.
std::vector<double> axis_ticks(double low, double high, int count);
// "1.5m", "20k": three digits and a prefix.
std::string short_number(double value);

}  // namespace app::view
