// The few colours of all pictures.
#pragma once

#include <algorithm>
#include <array>

#include "canvas.hpp"

namespace render::theme {

inline constexpr Palette light{.paper = {252, 252, 253},
                               .ink = {31, 36, 48},
                               .soft_ink = {98, 107, 123},
                               .force = {200, 62, 38},
                               .plain_fill = {198, 210, 226},
                               .wire = {16, 20, 32, 120}};
inline constexpr Palette dark{.paper = {24, 27, 33},
                              .ink = {226, 230, 238},
                              .soft_ink = {140, 149, 165},
                              .force = {255, 122, 92},
                              .plain_fill = {72, 88, 112},
                              .wire = {8, 10, 16, 130}};

// Of all pictures that are written to files.
inline constexpr Color paper = light.paper;
inline constexpr Color ink = light.ink;
inline constexpr Color soft_ink = light.soft_ink;
inline constexpr Color faint{226, 229, 235};  // grids, separators

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
