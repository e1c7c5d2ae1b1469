#include "option_values.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "failure.hpp"
#include "nearest.hpp"
#include "rheo/limits.hpp"
#include "rheo/memory_limit.hpp"
#include "rheo/scene.hpp"

namespace app {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& allowed) {
  throw Failure(ExitCode::usage, fmt::format("{} '{}': {}", option, text, allowed));
}

template <typename Number>
std::optional<Number> whole_text(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

template <typename Value>
using Choices = std::vector<std::pair<std::string, Value>>;

const Choices<rheo::IntegratorKind>& integrators() {
  static const Choices<rheo::IntegratorKind> all{{"rk4", rheo::IntegratorKind::rk4},
                                                 {"euler", rheo::IntegratorKind::euler},
                                                 {"exponential", rheo::IntegratorKind::exponential},
                                                 {"implicit", rheo::IntegratorKind::implicit}};
  return all;
}

const Choices<rheo::Kernel>& kernels() {
  static const Choices<rheo::Kernel> all{{"auto", rheo::Kernel::automatic},
                                         {"csr", rheo::Kernel::csr},
                                         {"edge", rheo::Kernel::edge},
                                         {"element", rheo::Kernel::element}};
  return all;
}

const Choices<rheo::ColorBy>& colors() {
  static const Choices<rheo::ColorBy> all{{"w_lambda", rheo::ColorBy::w_lambda},
                                          {"w_mu", rheo::ColorBy::w_mu},
                                          {"w", rheo::ColorBy::w},
                                          {"speed", rheo::ColorBy::speed},
                                          {"none", rheo::ColorBy::none}};
  return all;
}

const Choices<DrawBackend>& backends() {
  static const Choices<DrawBackend> all{
      {"auto", DrawBackend::automatic}, {"osmesa", DrawBackend::osmesa}, {"egl", DrawBackend::egl}};
  return all;
}

template <typename Value>
Value choose(const std::string& option, const std::string& text, const Choices<Value>& choices) {
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) {
    if (name == text) return value;
    names.push_back(name);
  }
  const std::string close = nearest(text, names);
  refuse(option, text,
         fmt::format("must be one of {}{}", fmt::join(names, ", "),
                     close.empty() ? "" : fmt::format("; did you mean {}?", close)));
}

template <typename Value>
const char* name_in(const Choices<Value>& choices, Value value) {
  for (const auto& [name, each] : choices)
    if (each == value) return name.c_str();
  return "?";
}

}  // namespace

double positive_number(const std::string& option, const std::string& text, const std::string& unit) {
  const std::optional<double> value = whole_text<double>(text);
  if (!value || !std::isfinite(*value) || *value <= 0.0)
    refuse(option, text, fmt::format("must be a number greater than 0 ({})", unit));
  if (!rheo::of_usable_size(*value))
    refuse(option, text,
           fmt::format("must be a number from {:g} to {:g} ({})", rheo::smallest_size, rheo::largest_size,
                       unit));
  return *value;
}

namespace {

double number_between(const std::string& option, const std::string& text, double low, double high) {
  const std::optional<double> value = whole_text<double>(text);
  if (!value || !(*value >= low && *value <= high))
    refuse(option, text, fmt::format("must be a number from {:g} to {:g}", low, high));
  return *value;
}

}  // namespace

double checkpoint_interval(const std::string& option, const std::string& text) {
  if (text == "never") return std::numeric_limits<double>::infinity();
  const std::optional<double> value = whole_text<double>(text);
  constexpr double longest = 1e9;
  if (!value || !(*value >= 0.0 && *value <= longest))
    refuse(option, text, fmt::format("must be never or seconds from 0 to {:g}", longest));
  return *value;
}

double tolerance_value(const std::string& option, const std::string& text) {
  return number_between(option, text, rheo::finest_tolerance, rheo::coarsest_tolerance);
}

double accuracy_value(const std::string& option, const std::string& text) {
  return number_between(option, text, rheo::finest_accuracy, rheo::coarsest_accuracy);
}

double step_value(const std::string& option, const std::string& text) {
  if (text == "auto") return 0.0;
  const std::optional<double> value = whole_text<double>(text);
  if (!value || !std::isfinite(*value) || *value <= 0.0)
    refuse(option, text, "must be auto or a number greater than 0 (seconds)");
  return *value;
}

int whole_number(const std::string& option, const std::string& text, int low, int high) {
  const std::optional<int> value = whole_text<int>(text);
  if (!value || *value < low || *value > high)
    refuse(option, text, fmt::format("must be a whole number from {} to {}", low, high));
  return *value;
}

std::string picture_sizes() {
  return fmt::format("from {}x{} to {}x{}", rheo::min_picture_size[0], rheo::min_picture_size[1],
                     rheo::max_picture_side, rheo::max_picture_side);
}

namespace {

// What a picture that is too large would take; empty where the text says no size.
std::string need_of_picture(std::string_view text, std::size_t cross) {
  if (cross == std::string_view::npos) return {};
  const auto width = whole_text<double>(text.substr(0, cross)),
             height = whole_text<double>(text.substr(cross + 1));
  if (!width || !height || !(*width > rheo::max_picture_side || *height > rheo::max_picture_side)) return {};
  return fmt::format("; this one needs about {} of memory",
                     rheo::memory_text(rheo::bytes_a_pixel * *width * *height));
}

}  // namespace

std::array<int, 2> picture_size(const std::string& option, const std::string& text) {
  const std::size_t cross = text.find_first_of("xX");
  const std::string need = need_of_picture(text, cross);
  const auto side = [&](std::string_view part, int smallest) {
    const std::optional<int> value = whole_text<int>(part);
    if (!value || *value < smallest || *value > rheo::max_picture_side)
      refuse(option, text,
             fmt::format("must be WIDTHxHEIGHT in pixels, {}, such as 1280x720{}", picture_sizes(), need));
    return *value;
  };
  const std::string_view whole = text;
  const auto [width, height] = rheo::min_picture_size;
  if (cross == std::string::npos) side("", width);
  return {side(whole.substr(0, cross), width), side(whole.substr(cross + 1), height)};
}

ColorRange color_range(const std::string& option, const std::string& text) {
  if (text == "auto") return {};
  const std::size_t comma = text.find(',');
  ColorRange range{.automatic = false};
  if (comma != std::string::npos) {
    const auto low = whole_text<double>(std::string_view(text).substr(0, comma));
    const auto high = whole_text<double>(std::string_view(text).substr(comma + 1));
    if (low && high && std::isfinite(*low) && std::isfinite(*high) && *low < *high) {
      range.limits = {*low, *high};
      return range;
    }
  }
  refuse(option, text, "must be auto or LOW,HIGH: two numbers, LOW less than HIGH, in the colour's unit");
}

rheo::IntegratorKind integrator_kind(const std::string& option, const std::string& text) {
  return choose(option, text, integrators());
}

rheo::Kernel kernel_choice(const std::string& option, const std::string& text) {
  return choose(option, text, kernels());
}

rheo::ColorBy color_by(const std::string& option, const std::string& text) {
  return choose(option, text, colors());
}

DrawBackend draw_backend(const std::string& option, const std::string& text) {
  return choose(option, text, backends());
}

const char* name_of(rheo::IntegratorKind kind) {
  return name_in(integrators(), kind);
}
const char* name_of(rheo::Kernel kernel) {
  return name_in(kernels(), kernel);
}
const char* name_of(rheo::ColorBy color) {
  return name_in(colors(), color);
}
const char* name_of(DrawBackend backend) {
  return name_in(backends(), backend);
}

}  // namespace app
