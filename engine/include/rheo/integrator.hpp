// Integrators for y' = A y + g(t) on flat arrays.
//
// They see an operator and nothing of the physics behind it: rheological bodies and scalar test equations go
// through the same few lines.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "rheo/scene.hpp"

namespace rheo {

// The forcing of one sweep: the sum of weight[k] times the k-th derivative of g at t. Between events g is a
// cubic, or by Baumgarte's stabilisation of a smooth motion of degree five.
struct Forcing {
  double t = 0.0;
  std::array<double, 6> weight{};
};

// What a sweep's result is for: only another sweep (parts of y that feed on nothing may be left as they are),
// or the step.
enum class Result { intermediate, step };

// A stretch of the state that holds one kind of numbers, in one unit, for errors relative to their size.
struct StatePart {
  std::size_t size = 0;
  double share = 1.0;  // where kinds are mixed: the smallest one's size over the whole part's; 0: follows
                       // from the other parts, and needs no bound of its own
};

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

  // Makes those numbers of y anew that follow from its others (StatePart::share 0), as a sweep does with
  // those that it writes: for sums of states, which would carry their rounding on.
  virtual void renew(std::span<double> /*y*/) {}

  // For implicit integrators, where solves_shifted(): d with (1 - s A) d = s (A x + forcing); out is not x.
  // prepare_shifted(s) comes first, the only one that may allocate; false where s cannot be solved for to
  // useful digits.
  virtual bool solves_shifted() const { return false; }
  virtual bool prepare_shifted(double /*s*/) { return false; }
  virtual void solve_shifted(double /*s*/, std::span<const double> /*x*/, const Forcing& /*forcing*/,
                             std::span<double> /*out*/) {
    assert(false && "this operator cannot solve");
  }

  // From the state's beginning to its end, at most 16; none: one part. The same for the operator's life.
  virtual std::span<const StatePart> parts() const { return {}; }
};

// What `exponential` has to know: a box that holds the spectrum, -rate <= Re s <= 0 and |Im s| <= frequency,
// and the error allowed a step, relative to the largest size so far of each part of the state. And
// `implicit`: a time that comes with the scene, beside which steps are alike that differ by rounding; with a
// time of its own the answer would hang on the unit.
struct IntegratorSettings {
  double frequency = 0.0;  // [1/s]
  double rate = 0.0;       // [1/s]
  double tolerance = 1e-12;
  double time = 1.0;  // [s]
};

class Integrator {
 public:
  virtual ~Integrator() = default;
  // y(t) -> y(t + h). `rate` = y'(t) where the caller has it already (saves one evaluation), else empty.
  virtual void step(LinearOperator& op, double t, double h, std::span<double> y,
                    std::span<const double> rate) = 0;
  // False where the last step missed the accuracy asked for, or could not be taken; the state is then short
  // of t + h.
  virtual bool converged() const { return true; }
  // What it carries from step to step beside y, for one that is to go on to the same bits; as many numbers
  // as always.
  virtual std::vector<double> memory() const { return {}; }
  virtual void remember(std::span<const double> /*memory*/) {}
  virtual std::string_view name() const = 0;
  // 0 where a step takes as many evaluations as its tolerance wants.
  virtual int order() const { return 0; }
  virtual int evaluations_per_step() const { return 0; }
};

// The integrator for a state of `size` numbers; all its memory is taken here.
std::unique_ptr<Integrator> make_integrator(IntegratorKind kind, std::size_t size,
                                            const IntegratorSettings& settings = {});

}  // namespace rheo
