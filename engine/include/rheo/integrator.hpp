// Fixed-step integrators for y' = A y + g(t) on flat arrays.
//
// They see an operator and nothing of the physics behind it: rheological bodies and scalar test equations go
// through the same few lines.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "rheo/scene.hpp"

namespace rheo {

// The forcing of one sweep: weight[0] g(t) + weight[1] g'(t) + weight[2] g''(t) + weight[3] g'''(t).
struct Forcing {
  double t = 0.0;
  std::array<double, 4> weight{};
};

// What a sweep's result is for: only another sweep (parts of y that feed on nothing may be left as they are),
// or the step.
enum class Result { intermediate, step };

// y' = A y + g(t), applied without forming A.
class LinearOperator {
 public:
  virtual ~LinearOperator() = default;
  virtual std::size_t size() const = 0;
  // out = base + h (A x + forcing); out may be base, not x.
  virtual void fma(double h, std::span<const double> x, std::span<const double> base, const Forcing& forcing,
                   std::span<double> out, Result result) = 0;

  // One fma with its arguments.
  struct Sweep {
    double h = 0.0;
    std::span<const double> x, base;
    Forcing forcing;
    std::span<double> out;
    Result result = Result::intermediate;
  };
  // Sweeps in a row, each but the first on the result of the one before; a sweep may write where the one
  // before it read, and only the last may write to the base that all share. An operator may let them follow
  // each other closely through its data instead of one after the other; the result is the same.
  virtual void chain(std::span<const Sweep> sweeps) {
    for (const Sweep& s : sweeps) fma(s.h, s.x, s.base, s.forcing, s.out, s.result);
  }
};

class Integrator {
 public:
  virtual ~Integrator() = default;
  // y(t) -> y(t + h). `rate` = y'(t) where the caller has it already (saves one evaluation), else empty.
  virtual void step(LinearOperator& op, double t, double h, std::span<double> y,
                    std::span<const double> rate) = 0;
  virtual std::string_view name() const = 0;
  virtual int order() const = 0;
  virtual int evaluations_per_step() const = 0;
};

// The integrator for a state of `size` numbers; all its memory is taken here.
std::unique_ptr<Integrator> make_integrator(IntegratorKind kind, std::size_t size);

}  // namespace rheo
