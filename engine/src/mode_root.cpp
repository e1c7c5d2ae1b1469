#include "mode_root.hpp"

#include <algorithm>

namespace rheo {

std::complex<double> sharpened_root(std::complex<double> s, std::span<const ModeSpring> springs,
                                    double dashpots) {
  std::complex<double> root = s;
  double moved = 1.0;
  for (int k = 0; k < 6 && s.imag() != 0.0; ++k) {
    std::complex<double> value = root + dashpots, slope = 1.0;
    for (const ModeSpring& spring : springs) {
      const std::complex<double> inverse = 1.0 / (root + spring.rate);
      const std::complex<double> part = spring.stiffness * inverse;
      value += part;
      slope -= part * inverse;
    }
    const std::complex<double> step = value / slope;
    root -= step;
    moved = std::abs(step) / std::abs(root);
    if (moved < 1e-15) break;
  }
  // Else far from quadratic convergence, as at pairs that are one real root but for rounding.
  const bool is_pair = root.imag() * s.imag() > 0.0 && std::abs(root.imag()) > 1e-9 * std::abs(root);
  if (moved < 1e-12 && is_pair) return {std::min(root.real(), 0.0), root.imag()};
  return {std::min(s.real(), 0.0), s.imag()};
}

}  // namespace rheo
