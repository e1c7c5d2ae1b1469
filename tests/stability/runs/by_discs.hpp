// Euler's largest step of a small body as if it were too large for all its eigenvalues, beside the truth.
//
// Units    steps [s]
#pragma once

#include "stability/runs/true_limit.hpp"

namespace rheo::test {

struct ByDiscs {
  bool counts = false;   // it hangs on more than omega_max and rates, and rounding leaves the truth
  bool is_near = false;  // what is predicted is known to be near
  double safe = 0.0, predicted = 0.0;
  TrueLimit truth;

  bool is_beyond() const { return predicted > truth.high * (1.0 + 1e-9); }
  bool is_far() const { return predicted < 0.95 * truth.high; }
};

ByDiscs euler_by_discs(Scene scene);

}  // namespace rheo::test
