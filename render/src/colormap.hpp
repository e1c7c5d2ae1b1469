// The colour map: blue over green to yellow, perceptually uniform, readable with any colour vision.
//
//   L(s) rises linearly with s in [0, 1]; (a(s), b(s)) walks a Bezier curve at constant speed; so every step
//   in s is the same distance in OKLab, and lightness alone tells the values apart. The low end stays light
//   enough that black lines remain visible on it.
//
// Source   OKLab: B. Ottosson, "A perceptual color space for image processing" (2020), its matrices
// Shapes   256 colours, sRGB, 8 bits a channel; colour i stands for i / 255
// Errors   none
#pragma once

#include <array>
#include <cstdint>

namespace render {

using Rgb = std::array<std::uint8_t, 3>;

struct Oklab {
  double L = 0, a = 0, b = 0;
};

Oklab oklab_of(const Rgb& srgb);
std::array<double, 3> linear_rgb_of(const Oklab& color);  // outside of [0, 1] when sRGB has no such colour

std::array<Rgb, 256> make_colormap();

// The point of the map's curve at s in [0, 1], before it is rounded to 8 bits.
Oklab colormap_at(double s);

}  // namespace render
