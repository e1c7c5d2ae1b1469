// Complex numbers that Eigen takes for real ones, conj(x) = x: its L D L^T is one of complex symmetric
// matrices then, which are not Hermitian.
//
// Not here pivoting: whoever factors looks at a residual.
#pragma once

#include <Eigen/SparseCholesky>
#include <complex>

namespace rheo {

struct SymmetricScalar {
  double re = 0.0, im = 0.0;

  SymmetricScalar() = default;
  SymmetricScalar(double real) : re(real) {}  // NOLINT: Eigen writes Scalar(0)
  explicit SymmetricScalar(std::complex<double> z) : re(z.real()), im(z.imag()) {}
  explicit operator std::complex<double>() const { return {re, im}; }

  SymmetricScalar& operator+=(const SymmetricScalar& o) { return re += o.re, im += o.im, *this; }
  SymmetricScalar& operator-=(const SymmetricScalar& o) { return re -= o.re, im -= o.im, *this; }
  SymmetricScalar& operator*=(const SymmetricScalar& o) { return *this = *this * o; }
  SymmetricScalar& operator/=(const SymmetricScalar& o) { return *this = *this / o; }
  friend SymmetricScalar operator+(SymmetricScalar a, const SymmetricScalar& b) { return a += b; }
  friend SymmetricScalar operator-(SymmetricScalar a, const SymmetricScalar& b) { return a -= b; }
  friend SymmetricScalar operator-(const SymmetricScalar& a) { return SymmetricScalar(-a.re, -a.im); }
  friend SymmetricScalar operator*(const SymmetricScalar& a, const SymmetricScalar& b) {
    return SymmetricScalar(a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re);
  }
  friend SymmetricScalar operator/(const SymmetricScalar& a, const SymmetricScalar& b) {
    return SymmetricScalar(std::complex<double>(a) / std::complex<double>(b));
  }
  friend bool operator==(const SymmetricScalar&, const SymmetricScalar&) = default;
  // Named by Eigen for its L L^T, which this is not for.
  friend bool operator<=(const SymmetricScalar& a, const SymmetricScalar& b) { return a.re <= b.re; }
  friend SymmetricScalar sqrt(const SymmetricScalar& a) {
    return SymmetricScalar(std::sqrt(std::complex<double>(a)));
  }

 private:
  SymmetricScalar(double real, double imaginary) : re(real), im(imaginary) {}
};

}  // namespace rheo

template <>
struct Eigen::NumTraits<rheo::SymmetricScalar> {
  using Real = rheo::SymmetricScalar;
  using NonInteger = rheo::SymmetricScalar;
  using Nested = rheo::SymmetricScalar;
  using Literal = rheo::SymmetricScalar;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 2,
    AddCost = 2,
    MulCost = 6
  };
};
