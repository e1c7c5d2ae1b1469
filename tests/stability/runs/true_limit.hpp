// The true limit of a scene's explicit steps, from all eigenvalues of the full operator, independent of the
// engine: dense matrices from tests/support, in energy variables, where the operator is skew but for damping
// and its eigenvalues are well conditioned.
//
//   x = Z^T M^1/2 v,  z = (ela J)^1/2 v-like strain of each region's branch
//   x' = - sum C^T z - D x,  z' = C x - rate z,   C = (ela J)^1/2 M^-1/2 Z,  D = sum viscous C^T C
//
// Z spans what the constraints leave free. In long double: rates of 1e9 /s may stand beside vibrations of
// 1e-3.
//
// Units    steps [s]
// Not here constraints that begin later than t = 0
#pragma once

#include <complex>
#include <vector>

#include "rheo/scene.hpp"

namespace rheo::test {

// Between which bounds the limit lies, as far as the arithmetic can tell; infinite where every step is
// stable.
struct TrueLimit {
  double low = 0.0, high = 0.0;
  bool determined() const { return high <= 1.01 * low; }
};

// All eigenvalues, found once for any integrator.
class TrueSpectrum {
 public:
  explicit TrueSpectrum(const Scene& scene);
  TrueLimit limit(IntegratorKind integrator) const;
  // Of all motions that are stiff.
  std::vector<std::complex<double>> values() const;

 private:
  std::vector<std::complex<long double>> values_;
  std::vector<double> rates_;  // of what pulls at nothing, and Baumgarte's
  long double moved_ = 0.0L;   // what QR's rounding may move an eigenvalue by: the operator is nearly normal
};

TrueLimit true_limit(const Scene& scene, IntegratorKind integrator);

}  // namespace rheo::test
