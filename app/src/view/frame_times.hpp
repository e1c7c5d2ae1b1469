// What the last frames took, as the panel of truth tells it: of the last seconds only, whatever their number.
//
//   frames a second = (frames - 1) / (time of the last - time of the first), over the last rate_window
//
// Units    s
// Memory   at most most_frames
// Errors   none
#pragma once

#include <deque>

namespace app::view {

struct Percentiles {
  double median = 0.0, high = 0.0;  // the 99th
};
Percentiles percentiles_of(const std::deque<double>& values);

struct FrameCost {
  double drawing = 0.0, physics = 0.0, steps = 0.0;
};

class FrameTimes {
 public:
  static constexpr double rate_window = 2.0, cost_window = 5.0;  // [s]
  static constexpr std::size_t most_frames = 1000;

  // Nothing is known any more: what lies before was no row of frames (a pause, another scene).
  void begin_again();
  // A frame `interval` after the one before.
  void add(double interval, const FrameCost& cost);
  // 0: not known yet.
  double frames_per_second() const;
  Percentiles drawing() const { return percentiles(&FrameCost::drawing); }
  Percentiles physics() const { return percentiles(&FrameCost::physics); }
  Percentiles steps() const { return percentiles(&FrameCost::steps); }

 private:
  struct Frame {
    double at;
    FrameCost cost;
  };
  Percentiles percentiles(double FrameCost::*which) const;

  std::deque<Frame> frames_;
  double now_ = 0.0;  // since the last beginning
};

}  // namespace app::view
