// A root of one mode's equation, sharpened.
//
//   s + dashpots + sum over k of springs_k / (s + rates_k) = 0
//
// A general eigenvalue solver's error is one part of the largest number in the mode; a vibration's damping,
// on which Euler's limit hangs, may be far below that. Newton's steps on the equation itself keep the real
// part's own digits, since real and imaginary parts are added up apart.
//
// There is one such pair at most: with k springs the equation has k + 1 roots, and on the real axis one lies
// between each two neighbouring rates. Hence what Newton's steps come to in the same half plane is the root
// that was meant.
//
// Units    [1/s], springs [1/s^2]
// Errors   none
#pragma once

#include <complex>
#include <span>

namespace rheo {

struct ModeSpring {
  double stiffness = 0.0;
  double rate = 0.0;
};

// From `s`, a root but for a solver's rounding; itself where the steps do not converge. A real part above 0
// is taken for 0.
std::complex<double> sharpened_root(std::complex<double> s, std::span<const ModeSpring> springs,
                                    double dashpots);

}  // namespace rheo
