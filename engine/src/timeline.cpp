#include "timeline.hpp"

#include <algorithm>
#include <cmath>

#include "rheo/simulation.hpp"

namespace rheo {

bool same_time(double a, double b) {
  if (std::isinf(a) || std::isinf(b)) return a == b;
  return std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b));
}

std::int64_t steps_in(double length, double refinement, double bound) {
  constexpr double slack = 1.0 - 1e-12;
  const double steps = std::max(1.0, std::ceil(length / bound * slack));
  return static_cast<std::int64_t>(std::ceil(refinement * steps * slack));
}

std::vector<double> event_times(const Scene& scene) {
  std::vector<double> times{0.0};
  const auto add = [&](double t) {
    if (t > 0.0 && std::isfinite(t)) times.push_back(t);
  };
  const auto add_window = [&](const Window& window) {
    add(window.from);
    add(window.until);
  };
  const auto add_keys = [&](const auto& item) {
    for (const auto& key : item.keys) {
      if (is_active(item.window, key.t)) add(key.t);
    }
  };
  for (const Fix& fix : scene.fixes) add_window(fix.window);
  for (const Move& move : scene.moves) {
    add_window(move.window);
    add_keys(move);
  }
  for (const Traction& traction : scene.tractions) {
    add_window(traction.window);
    if (traction.keys.size() > 1) add_keys(traction);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end(), same_time), times.end());
  return times;
}

std::int64_t output_count(const TimeSettings& time) {
  // The slack takes duration * rate = 299.99999999999994 for the 300 that was meant.
  return static_cast<std::int64_t>(std::floor(time.duration * time.frame_rate * (1.0 + 1e-12))) + 1;
}

double output_time(const TimeSettings& time, std::int64_t k) {
  return std::min(static_cast<double>(k) / time.frame_rate, time.duration);
}

}  // namespace rheo
