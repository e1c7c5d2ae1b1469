// Frames between two ticks of slow motion, where ticks are rarer than frames: the picture goes from the tick
// before the newest to the newest, one tick late.
//
//   x(s) = cubic Hermite through x and v at both ticks,  magnitudes linear;  error O(tick^4 x'''')
//
// Units    SI; now: seconds of any clock
// Errors   none
// Not here anything that is computed with: the newest state stays what it was
#pragma once

#include "view/display.hpp"

namespace app::view {

class SlowMotion {
 public:
  SlowMotion() { after_.ticks = -1; }  // nothing yet

  // What to show now: the newest itself unless it runs so slowly that frames would show each tick twice or
  // more.
  const Display& shown(const Display& newest, double rate, double now);

 private:
  void blend(double s);

  Display before_, after_, between_;
  double since_ = 0.0;  // when `after_` came
  bool has_before_ = false;
};

}  // namespace app::view
