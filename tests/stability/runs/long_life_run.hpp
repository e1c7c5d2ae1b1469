// A body pulled back and forth for a very long time, by a periodic traction of mean zero.
//
//   drift    largest |x(k) - x(1)| of a block over its largest size, x(k) the state at the end of the last
//   period
//            in the k-th tenth of the run: 0 for a periodic answer, but for rounding
//   balance  kinetic + stored + dissipated - work over what was dissipated, where both are known
//
// Rounding can move a body that remembers nothing of its place (a Maxwell material) by some eps of its way a
// step, and the time, steps * h, itself is known to eps: a drift of eps * steps, and of the tolerance that
// the exponential integrator is given for all of the run, is what double precision allows at worst.
//
// Units    SI; memory [bytes]
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rheo/live.hpp"

namespace rheo::test {

struct LongLife {
  std::string name;
  Scene scene;
  std::vector<Edge> pulled;
  Vec2 pull;                         // the largest
  double rate = 60.0;                // ticks a second
  std::int64_t ticks_a_period = 60;  // even
  std::int64_t periods = 100;        // a multiple of ten
  SimulationOptions options;
};

// Of a tenth of the run.
struct Tenth {
  std::int64_t steps = 0;
  double seconds = 0.0;
  double evaluations = 0.0;  // of the force, a step
  double drift = 0.0;
  double balance = 0.0;
  std::int64_t memory = 0;  // resident, at its end; 0: not known
};

struct LongLifeOutcome {
  std::vector<Tenth> tenths;
  bool diverged = false;
  bool finite = true;
  double tolerance = 0.0;  // of the run: the exponential integrator's
  std::int64_t steps() const;
  double worst_drift() const;  // from the second tenth on
  double allowed_drift() const;
};

// The paper's beam, pulled with a twentieth of its load; and a block of gel on a floor, pulled by its top,
// whose vibrations die out in a second. A tenth of a run must be longer than what they began with takes to
// die.
LongLife long_lived_beam(IntegratorKind integrator, std::int64_t periods);
LongLife long_lived_block(IntegratorKind integrator, int nx, int ny, std::int64_t periods);

LongLifeOutcome live_long(const LongLife& life);

}  // namespace rheo::test
