// The few colours of all pictures.
#pragma once

#include <algorithm>
#include <array>

#include "canvas.hpp"

namespace render::theme {

inline constexpr Color paper{252, 252, 253};
inline constexpr Color ink{31, 36, 48};            // text, outline
inline constexpr Color soft_ink{98, 107, 123};     // axes, hatches, rest shape
inline constexpr Color faint{226, 229, 235};       // grids, separators
inline constexpr Color force{200, 62, 38};         // traction arrows
inline constexpr Color plain_fill{198, 210, 226};  // a body without a scalar
inline constexpr Color wire{16, 20, 32, 120};      // mesh lines

// Line colours that all kinds of colour vision tell apart. Source: M. Okabe and K. Ito, "Color universal
// design" (2008).
inline constexpr std::array<Color, 6> series{
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}}};

// Where materials meet: a dark line with a light rim, to be seen on every colour of the map.
inline float interface_width(float unit) {
  return std::max(1.0f, 1.3f * unit);
}
inline float interface_rim_width(float unit) {
  return std::max(3.0f, 3.4f * unit);
}

// Of a body's outline, in a picture whose lines have the unit `unit`.
inline float outline_width(float unit) {
  return std::max(1.4f, 2.0f * unit);
}

}  // namespace render::theme
