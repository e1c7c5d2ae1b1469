// From event to event: who holds which degree of freedom since when, and the velocity's jump where a hold
// begins or its motion changes speed.
//
//   b(t) = base + course(t),  base = u - course where the hold began
//   v+ = v + M^-1 A L,  A^T v+ = b'        an impulse, whose energy is work
//
// Source   Hirai and Tomokuni, eq. (4), started with consistent velocities
// Units    velocities [m/s], work [J]
// Shapes   base, jump, v: 2n
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "body.hpp"
#include "hands.hpp"

namespace rheo {

class ByteReader;
class ByteWriter;

class Holds {
 public:
  // `model` must outlive this. columns: general constraints that there will be.
  Holds(const Model& model, std::size_t columns);

  const Vector& base() const { return base_; }

  // Nobody holds anything.
  void forget() { std::fill(owner_.begin(), owner_.end(), -1); }

  // Of a run that is to go on: bases and owners; all else is found anew at each passage.
  void put(ByteWriter& out) const;
  void get(ByteReader& in);

  // Two halves of one passage. First: who holds what from now on; whether some hold begins. hands: may be
  // null.
  bool change_owners(const Interval& next, const Hands* hands);
  // Then: bases, and what v jumps by; whether something begins or jumps. u, v: looked at where a hold begins.
  bool find_jumps(const Interval& before, const Interval& next, const double* u, const double* v);

  // Projects v; the work of the impulse, or nothing where there is none. A constraint that begins takes A^T v
  // to b'; one that goes on changes A^T v by the jump of its b' only, so that Baumgarte's decay of what it
  // had is left alone.
  enum class General { begin, go_on };
  std::optional<double> project(const Interval& interval, General general, VectorMap v);

 private:
  const Model& model_;
  Vector base_, jump_, dv_, momentum_, target_, impulse_, nothing_;
  std::vector<int> owner_, next_owner_;  // -1: nobody
  std::vector<char> taken_;              // now, by its owner of now
};

}  // namespace rheo
