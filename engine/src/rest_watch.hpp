// Whether a body under constant loads and constraints that stand still has come to rest: u is where it was,
// but for roundings, for as long as anything slow in the body would take to show.
//
//   |u - u(t0)|_max <= share |u|_max   at every look from t0 to t0 + L
//   L = max(slowest retardation time, 10 u_top / v_top, 1 / omega)
//
// u_top, v_top: the largest |u|_max and |v|_max so far, whose ratio is about that of the slowest swing, 1
// over its frequency; omega: Baumgarte's, where there are general constraints. What creeps or swings by less
// than `share` of u within L has about as much before it. (v is no measure: rounding of u leaves it at about
// a rounding of |u| a step.) Nothing is absolute: other units or larger loads change no answer.
//
// The retardation time of a spring E_0 beside Maxwell branches of E_k and rate r_k: (E_0 + sum E_k) /
// (E_0 r_k), without a spring 1 / r_k; beside a dashpot c: c / E_0. With several materials: the slowest of
// them beside the stiffest and the softest spring of all. Where nothing relaxes or is viscous, no answer is
// ever yes: such a body swings for ever.
//
// Units    u [m], v [m/s], times [s], omega [1/s]
// Shapes   u, v: 2n
// Not here a body without any load, whose energies tell at once (Stepping)
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "rheo/material.hpp"

namespace rheo {

class ByteReader;
class ByteWriter;

class RestWatch {
 public:
  // size: of u. All memory is taken here.
  RestWatch(std::span<const Material> materials, std::size_t size, double share);

  // Loads or constraints are others from now on.
  void restart() { marked_ = false; }
  // Of a run that is to go on: what it has seen.
  void put(ByteWriter& out) const;
  void get(ByteReader& in);
  // omega: 0 without general constraints. Looks are at rising times.
  bool look(double t, std::span<const double> u, std::span<const double> v, double omega);

 private:
  double share_;
  double slowest_ = 0.0;  // 0: nothing ever comes to rest
  double u_top_ = 0.0, v_top_ = 0.0;
  bool marked_ = false;
  double mark_time_ = 0.0;
  std::vector<double> mark_;  // u then
};

}  // namespace rheo
