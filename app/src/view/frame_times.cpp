#include "view/frame_times.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace app::view {

Percentiles percentiles_of(const std::deque<double>& values) {
  if (values.empty()) return {};
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double share) {
    return sorted[static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)))];
  };
  return {at(0.5), at(0.99)};
}

void FrameTimes::begin_again() {
  frames_.clear();
  now_ = 0.0;
}

void FrameTimes::add(double interval, const FrameCost& cost) {
  if (!frames_.empty()) now_ += interval;
  frames_.push_back({now_, cost});
  // Slow frames are told by the last two, however long ago.
  while (frames_.size() > 2 && (frames_.size() > most_frames || frames_.front().at < now_ - cost_window))
    frames_.pop_front();
}

double FrameTimes::frames_per_second() const {
  if (frames_.size() < 2) return 0.0;
  auto first = std::find_if(frames_.begin(), frames_.end(),
                            [&](const Frame& frame) { return frame.at >= now_ - rate_window; });
  first = std::min(first, frames_.end() - 2);
  const double span = frames_.back().at - first->at;
  return span > 0.0 ? static_cast<double>(frames_.end() - first - 1) / span : 0.0;
}

Percentiles FrameTimes::percentiles(double FrameCost::*which) const {
  std::deque<double> values;
  for (const Frame& frame : frames_) values.push_back(frame.cost.*which);
  return percentiles_of(values);
}

}  // namespace app::view
