// What the live plots show: samples over the whole run, thinned out evenly when they grow many.
//
// Units    SI
// Errors   none
#pragma once

#include <vector>

#include "view/display.hpp"

namespace app::view {

class History {
 public:
  // One more where the display is a later one; begins anew where it is another run or an earlier time.
  void add(const Display& display);
  void clear();

  std::size_t size() const { return t.size(); }
  std::vector<double> t, w_lambda, w_mu, kinetic, stored, dissipated, work, drift, moved, force;

 private:
  void thin_out();
  std::int64_t body_ = -1;
  double least_ = 0.0;  // between samples [s]
};

// (kinetic + stored + dissipated - work) less what it was at the start. [J]
double drift_of(const Display& display);

}  // namespace app::view
