#include "chebyshev.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace rheo {
namespace {

enum class Family { j, i };

void backward(double z, std::span<double> out, Family family) {
  assert(z >= 0.0);
  if (out.empty()) return;
  std::fill(out.begin(), out.end(), 0.0);
  if (z == 0.0) {
    out[0] = 1.0;
    return;
  }
  // So far beyond the last order wanted, and beyond z, that the start's error has died down to rounding.
  const double far = std::max(static_cast<double>(out.size()), z);
  const auto start = static_cast<long>(std::ceil(far + 30.0 + 8.0 * std::sqrt(far)));
  constexpr double large = 1e200;
  const double sign = family == Family::j ? -1.0 : 1.0;
  double next = 0.0;       // order k + 1
  double current = 1e-30;  // order k
  double sum = 0.0;
  for (long k = start; k >= 0; --k) {
    if (std::abs(current) > large) {
      next /= large;
      current /= large;
      sum /= large;
      for (std::size_t i = static_cast<std::size_t>(k) + 1; i < out.size(); ++i) out[i] /= large;
    }
    if (static_cast<std::size_t>(k) < out.size()) out[static_cast<std::size_t>(k)] = current;
    if (k == 0) {
      sum += current;
    } else if (family == Family::i || k % 2 == 0) {
      sum += 2.0 * current;
    }
    const double before = 2.0 * static_cast<double>(k) / z * current + sign * next;
    next = current;
    current = before;
  }
  for (double& value : out) value /= sum;
}

}  // namespace

void bessel_j(double z, std::span<double> out) {
  backward(z, out, Family::j);
}

void bessel_i_scaled(double z, std::span<double> out) {
  backward(z, out, Family::i);
}

}  // namespace rheo
