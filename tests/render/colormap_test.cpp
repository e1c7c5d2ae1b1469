#include "colormap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace {

using render::Oklab;
using render::Rgb;

double distance(const Oklab& p, const Oklab& q) {
  return std::hypot(p.L - q.L, p.a - q.a, p.b - q.b);
}

double to_linear(double c) {
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
double to_srgb(double c) {
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

// CIE lightness L* (0..100) of an sRGB colour.
double cie_lightness(const Rgb& c) {
  const double y =
      0.2126 * to_linear(c[0] / 255.0) + 0.7152 * to_linear(c[1] / 255.0) + 0.0722 * to_linear(c[2] / 255.0);
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

// Complete colour blindness of one kind. Source: G. M. Machado, M. M. Oliveira and L. A. F. Fernandes, "A
// physiologically-based model for simulation of color vision deficiency", IEEE TVCG 15 (2009), severity 1.0.
using Matrix = std::array<std::array<double, 3>, 3>;
struct Deficiency {
  std::string name;
  Matrix matrix;
};
const std::array<Deficiency, 3> deficiencies{
    {{"protanopia",
      {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}}},
     {"deuteranopia",
      {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}}},
     {"tritanopia",
      {{{1.255528, -0.076749, -0.178779},
        {-0.078411, 0.930809, 0.147602},
        {0.004733, 0.691367, 0.303900}}}}}};

Rgb seen_with(const Matrix& m, const Rgb& c) {
  Rgb seen{};
  for (std::size_t i = 0; i < 3; ++i) {
    double v = 0;
    for (std::size_t j = 0; j < 3; ++j) v += m[i][j] * to_linear(c[j] / 255.0);
    seen[i] = static_cast<std::uint8_t>(std::lround(255 * to_srgb(std::clamp(v, 0.0, 1.0))));
  }
  return seen;
}

TEST(Oklab, ReferenceWhiteAndRoundTrip) {
  const Oklab white = render::oklab_of({255, 255, 255});
  EXPECT_NEAR(white.L, 1, 1e-6);  // the matrices have ten digits
  EXPECT_NEAR(white.a, 0, 1e-6);
  EXPECT_NEAR(white.b, 0, 1e-6);
  const auto back = render::linear_rgb_of(render::oklab_of({200, 30, 90}));
  EXPECT_NEAR(to_srgb(back[0]) * 255, 200, 1e-3);
  EXPECT_NEAR(to_srgb(back[1]) * 255, 30, 1e-3);
  EXPECT_NEAR(to_srgb(back[2]) * 255, 90, 1e-3);
}

TEST(Colormap, EveryColourExistsInSrgb) {
  for (int i = 0; i < 256; ++i) {
    for (const double c : render::linear_rgb_of(render::colormap_at(i / 255.0))) {
      EXPECT_GE(c, 0) << "colour " << i;
      EXPECT_LE(c, 1) << "colour " << i;
    }
  }
}

TEST(Colormap, StepsAreOfEqualPerceptualSize) {
  const double mean = [] {
    double sum = 0;
    for (int i = 0; i < 255; ++i)
      sum += distance(render::colormap_at(i / 255.0), render::colormap_at((i + 1) / 255.0));
    return sum / 255;
  }();
  // Chords of a smooth curve walked at constant speed differ by their curvature only.
  for (int i = 0; i < 255; ++i) {
    const double step = distance(render::colormap_at(i / 255.0), render::colormap_at((i + 1) / 255.0));
    EXPECT_NEAR(step / mean, 1, 0.01) << "from colour " << i;
  }
  // Rounded to 8 bits, over fifths of the map: rounding moves an end by up to about 0.003 of some 0.19.
  const auto map = render::make_colormap();
  for (std::size_t i = 0; i + 51 < map.size(); i += 17) {
    EXPECT_NEAR(distance(render::oklab_of(map[i]), render::oklab_of(map[i + 51])) / (51 * mean), 1, 0.04);
  }
}

TEST(Colormap, LightnessRisesStrictly) {
  for (int i = 0; i < 255; ++i) {
    EXPECT_LT(render::colormap_at(i / 255.0).L, render::colormap_at((i + 1) / 255.0).L);
  }
  // One step of lightness is about as large as rounding; two steps are larger.
  const auto map = render::make_colormap();
  for (std::size_t i = 0; i + 2 < map.size(); ++i) {
    EXPECT_LT(render::oklab_of(map[i]).L, render::oklab_of(map[i + 2]).L) << "colour " << i;
    EXPECT_LT(cie_lightness(map[i]), cie_lightness(map[i + 2])) << "colour " << i;
  }
}

TEST(Colormap, RemainsReadableWithEveryColourVision) {
  const auto map = render::make_colormap();
  for (const Deficiency& d : deficiencies) {
    const double ends = distance(render::oklab_of(seen_with(d.matrix, map[0])),
                                 render::oklab_of(seen_with(d.matrix, map[255])));
    EXPECT_GT(ends, 0.35) << d.name;  // black to white is 1
    for (std::size_t i = 0; i + 16 < map.size(); i += 8) {
      const Rgb a = seen_with(d.matrix, map[i]), b = seen_with(d.matrix, map[i + 16]);
      EXPECT_LT(cie_lightness(a), cie_lightness(b)) << d.name << ", colour " << i;
      EXPECT_GT(distance(render::oklab_of(a), render::oklab_of(b)), 0.015) << d.name << ", colour " << i;
    }
  }
}

TEST(Colormap, BlackLinesAreVisibleOnTheLowEnd) {
  EXPECT_GT(cie_lightness(render::make_colormap()[0]), 30);  // lines are near L* = 6
}

}  // namespace
