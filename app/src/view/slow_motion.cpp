#include "view/slow_motion.hpp"

#include <algorithm>
#include <cstddef>

namespace app::view {
namespace {

constexpr double least_ticks_a_second = 40.0;  // fewer of the user's seconds are filled

}  // namespace

const Display& SlowMotion::shown(const Display& newest, double rate, double now) {
  const double ticks_a_second = rate * newest.speed_wanted;
  if (!newest.running || newest.resting || ticks_a_second >= least_ticks_a_second) {
    after_.ticks = -1;
    return newest;
  }
  if (newest.ticks != after_.ticks || newest.run != after_.run || newest.body != after_.body) {
    has_before_ = newest.ticks > after_.ticks && after_.ticks >= 0 && newest.run == after_.run &&
                  newest.body == after_.body;
    std::swap(before_, after_);
    after_ = newest;
    since_ = now;
  }
  if (!has_before_) return newest;
  const double s = (now - since_) * ticks_a_second / static_cast<double>(after_.ticks - before_.ticks);
  if (s >= 1.0) return newest;
  between_ = newest;
  blend(std::max(s, 0.0));
  return between_;
}

void SlowMotion::blend(double s) {
  const double h = after_.t - before_.t, r = 1.0 - s;
  const double x0 = (1.0 + 2.0 * s) * r * r, x1 = s * s * (3.0 - 2.0 * s), v0 = h * s * r * r,
               v1 = -h * s * s * r;
  for (std::size_t i = 0; i < between_.positions.size(); ++i)
    between_.positions[i] = x0 * before_.positions[i] + x1 * after_.positions[i] +
                            v0 * before_.velocities[i] + v1 * after_.velocities[i];
  for (const auto values : {&Display::w_lambda, &Display::w_mu, &Display::speed})
    for (std::size_t i = 0; i < (between_.*values).size(); ++i)
      (between_.*values)[i] = r * (before_.*values)[i] + s * (after_.*values)[i];
  between_.t = before_.t + s * h;
}

}  // namespace app::view
