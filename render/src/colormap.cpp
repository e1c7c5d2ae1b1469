#include "colormap.hpp"

#include <algorithm>
#include <cmath>

namespace render {
namespace {

struct Ab {
  double a, b;
};

constexpr double low_lightness = 0.46;
constexpr double high_lightness = 0.925;
constexpr std::array<Ab, 4> control{{{0.010, -0.150}, {-0.115, -0.125}, {-0.140, 0.080}, {-0.030, 0.160}}};

// Cubic Bezier curve through the first and the last control point.
Ab bezier(double t) {
  const double r = 1 - t;
  const std::array<double, 4> w{r * r * r, 3 * r * r * t, 3 * r * t * t, t * t * t};
  Ab sum{0, 0};
  for (std::size_t i = 0; i < control.size(); ++i) {
    sum.a += w[i] * control[i].a;
    sum.b += w[i] * control[i].b;
  }
  return sum;
}

double to_linear(double c) {
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
double to_srgb(double c) {
  return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

std::uint8_t to_byte(double c) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(to_srgb(std::max(c, 0.0)), 0.0, 1.0)));
}

// The curve's length up to t = i / pieces.
constexpr int pieces = 2048;
using Lengths = std::array<double, pieces + 1>;

Lengths curve_lengths() {
  Lengths length{};
  Ab last = bezier(0);
  for (std::size_t i = 1; i < length.size(); ++i) {
    const Ab next = bezier(static_cast<double>(i) / pieces);
    length[i] = length[i - 1] + std::hypot(next.a - last.a, next.b - last.b);
    last = next;
  }
  return length;
}

Oklab at(const Lengths& length, double s) {
  const double wanted = std::clamp(s, 0.0, 1.0) * length.back();
  const auto above = std::upper_bound(length.begin() + 1, length.end() - 1, wanted);
  const double before = *(above - 1);
  const double part = std::clamp((wanted - before) / (*above - before), 0.0, 1.0);
  const double t = (static_cast<double>(above - 1 - length.begin()) + part) / pieces;
  const Ab ab = bezier(t);
  return {low_lightness + s * (high_lightness - low_lightness), ab.a, ab.b};
}

}  // namespace

Oklab oklab_of(const Rgb& srgb) {
  const double r = to_linear(srgb[0] / 255.0), g = to_linear(srgb[1] / 255.0), b = to_linear(srgb[2] / 255.0);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

std::array<double, 3> linear_rgb_of(const Oklab& c) {
  const double l = std::pow(c.L + 0.3963377774 * c.a + 0.2158037573 * c.b, 3);
  const double m = std::pow(c.L - 0.1055613458 * c.a - 0.0638541728 * c.b, 3);
  const double s = std::pow(c.L - 0.0894841775 * c.a - 1.2914855480 * c.b, 3);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

Oklab colormap_at(double s) {
  return at(curve_lengths(), s);
}

std::array<Rgb, 256> make_colormap() {
  const Lengths length = curve_lengths();
  std::array<Rgb, 256> map{};
  for (std::size_t i = 0; i < map.size(); ++i) {
    const std::array<double, 3> rgb = linear_rgb_of(at(length, static_cast<double>(i) / 255.0));
    map[i] = {to_byte(rgb[0]), to_byte(rgb[1]), to_byte(rgb[2])};
  }
  return map;
}

}  // namespace render
