// Coefficients of the exponential in Chebyshev polynomials: Bessel functions of whole orders from 0 up.
//
//   exp(i z x) = J_0(z) + 2 sum i^k J_k(z) T_k(x),   exp(z x) = I_0(z) + 2 sum I_k(z) T_k(x),   -1 <= x <= 1
//
// By backward recurrence (Miller), which damps what is not wanted, from an order where both are negligible,
// normed by J_0 + 2 (J_2 + J_4 + ...) = 1 and I_0 + 2 (I_1 + I_2 + ...) = exp(z).
//
// Source   Abramowitz and Stegun, 9.1.27, 9.1.46, 9.6.26, 9.6.36; Olver, 1964
// Errors   none; z >= 0 is asserted. Relative errors stay near rounding for orders beyond z, absolute ones
//          below.
#pragma once

#include <span>

namespace rheo {

// out[k] = J_k(z).
void bessel_j(double z, std::span<double> out);

// out[k] = exp(-z) I_k(z).
void bessel_i_scaled(double z, std::span<double> out);

}  // namespace rheo
