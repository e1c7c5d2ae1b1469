#include "ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace render {
namespace {

// A real minus sign.
std::string written(double value, int decimals) {
  std::string s = fmt::format("{:.{}f}", value == 0 ? 0.0 : value, decimals);
  if (s.front() != '-') return s;
  if (s.find_first_of("123456789") == std::string::npos) return s.substr(1);
  return s.replace(0, 1, "−");
}

}  // namespace

Ticks linear_ticks(double low, double high, int most) {
  Ticks ticks;
  const double span = high - low;
  if (!(span > 0) || !std::isfinite(span) || most < 1) return ticks;
  const double rough = span / std::max(most - 1, 1);
  double power = std::pow(10.0, std::floor(std::log10(rough)));
  if (!(power > 0) || !std::isfinite(power)) return ticks;
  double step = 10 * power;
  for (const double m : {1.0, 2.0, 5.0}) {
    if (m * power >= rough * (1 - 1e-9)) {
      step = m * power;
      break;
    }
  }
  double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
  // One number is no scale: the next smaller steps, along 5, 2, 1.
  while (most > 1 && last - first < 1 && step > 1e-3 * span) {
    const double leading = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    step /= leading > 4 ? 2.5 : 2;
    first = std::ceil(low / step - 1e-9);
    last = std::floor(high / step + 1e-9);
  }
  if (last - first > 1000) return ticks;
  // Close ranges far from zero: the step is lost in rounding.
  if (std::max(std::abs(low), std::abs(high)) > 1e12 * step) return ticks;
  const double largest = std::max(std::abs(first), std::abs(last)) * step;
  const int magnitude = largest > 0 ? static_cast<int>(std::floor(std::log10(largest) + 1e-9)) : 0;
  if (magnitude >= 5 || magnitude <= -3) ticks.exponent = magnitude;
  const double unit = std::pow(10.0, ticks.exponent);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step / unit) + 1e-9)));
  for (double k = first; k <= last; ++k) {
    ticks.at.push_back(k * step);
    ticks.labels.push_back(written(k * step / unit, decimals));
  }
  return ticks;
}

Ticks log_ticks(double low, double high, int most) {
  Ticks ticks;
  if (!(low > 0) || !(high >= low) || !std::isfinite(high) || most < 1) return ticks;
  const int first = static_cast<int>(std::ceil(std::log10(low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(high) + 1e-9));
  if (last - first < 1) {
    for (int k = first - 1; k <= last; ++k) {
      for (const int m : {1, 2, 5}) {
        const double value = m * std::pow(10.0, k);
        if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
        ticks.at.push_back(value);
        ticks.labels.push_back(m == 1 ? fmt::format("10^{{{}}}", k) : fmt::format("{}×10^{{{}}}", m, k));
      }
    }
    if (ticks.at.size() < 2 && most > 1 && high > low * (1 + 1e-9)) return linear_ticks(low, high, most);
    return ticks;
  }
  const int every = std::max(1, (last - first + most) / most);
  // Multiples of `every`; where the range has but one of them, from its first power on.
  const auto multiples = [&] {
    int n = 0;
    for (int k = first; k <= last; ++k) n += k % every == 0 ? 1 : 0;
    return n;
  };
  const int start = multiples() < 2 && most > 1 ? first : 0;
  for (int k = first - 1; k <= last && every == 1; ++k) {
    for (int m = 2; m < 10; ++m) {
      const double value = m * std::pow(10.0, k);
      if (value >= low && value <= high) ticks.minor.push_back(value);
    }
  }
  for (int k = first; k <= last; ++k) {
    if ((k - start) % every != 0) {
      ticks.minor.push_back(std::pow(10.0, k));
      continue;
    }
    ticks.at.push_back(std::pow(10.0, k));
    ticks.labels.push_back(fmt::format("10^{{{}}}", k));
  }
  return ticks;
}

std::string with_unit(double value, const std::string& unit) {
  static constexpr const char* prefixes[] = {"n", "µ", "m", "", "k", "M", "G", "T"};
  const double size = std::abs(value);
  int k = 3;
  if (size > 0 && std::isfinite(size)) {
    k = std::clamp(3 + static_cast<int>(std::floor((std::log10(size) + 1e-9) / 3)), 0, 7);
  }
  return fmt::format("{:.3g} {}{}", value / std::pow(1000.0, k - 3), prefixes[k], unit);
}

namespace {

struct TimeUnit {
  const char* name;
  double factor;
};

TimeUnit time_unit(double longest) {
  if (longest == 0 || longest >= 0.0095) return {"s", 1};
  if (longest >= 0.95e-5) return {"ms", 1e3};
  return {"µs", 1e6};
}

}  // namespace

std::string time_text(double seconds) {
  return time_text(seconds, std::abs(seconds));
}

std::string time_text(double seconds, double longest) {
  if (!std::isfinite(seconds)) return "t = ?";
  const TimeUnit unit = time_unit(longest);
  const double value = seconds * unit.factor;
  if (unit.factor == 1e6) return fmt::format("t = {:.3g} {}", value, unit.name);
  return fmt::format("t = {:.{}f} {}", value, longest >= 1000 ? 1 : 3, unit.name);
}

std::vector<std::string> short_times(std::span<const double> seconds) {
  double longest = 0;
  for (const double t : seconds)
    if (std::isfinite(t)) longest = std::max(longest, std::abs(t));
  const TimeUnit unit = time_unit(longest);
  const double digits = std::max(std::log10(longest * unit.factor), 0.0);
  const int most = std::max(3 - std::max(static_cast<int>(digits) - 1, 0), 0);
  int decimals = 0;
  for (; decimals < most; ++decimals) {
    const double power = std::pow(10.0, decimals);
    const bool exact = std::ranges::all_of(seconds, [&](double t) {
      const double scaled = t * unit.factor * power;
      return !std::isfinite(t) || std::abs(scaled - std::round(scaled)) < 5e-4 * power;
    });
    if (exact) break;
  }
  std::vector<std::string> texts;
  for (const double t : seconds)
    texts.push_back(std::isfinite(t) ? fmt::format("{} {}", written(t * unit.factor, decimals), unit.name)
                                     : "?");
  return texts;
}

}  // namespace render
