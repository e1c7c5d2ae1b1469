// A small plot with axes in a user interface: titles, ticks, legend, the values under the cursor.
//
// Units    of x: seconds; y: as labelled
// Errors   none: what is not finite is left out
#pragma once

#include <imgui.h>

#include <functional>
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

// Returns its heading: "u [mm]", in whose unit the ticks are.
std::string live_plot(const PlotPlace& place, std::span<const double> t, std::span<const Curve> curves);

// Steps of 1, 2 or 5 times a power of ten with about `count` ticks.
std::vector<double> axis_ticks(double low, double high, int count);
// The most ticks, up to about `most`, that `fit`; two at least, where two do.
std::vector<double> labelled_ticks(double low, double high, int most,
                                   const std::function<bool(const std::vector<double>&)>& fit);
// The unit with the prefix in which numbers up to `largest` have one to three digits before the point.
struct PrefixedUnit {
  double size = 1.0;  // in units without prefix
  std::string name;
};
PrefixedUnit prefixed_unit(double largest, const char* unit);
// "1.5m", "20k": three digits and a prefix.
std::string short_number(double value);
// "20 kPa": the prefix goes to the unit.
std::string with_unit(double value, const char* unit);

}  // namespace app::view
