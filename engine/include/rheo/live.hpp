// A scene under a user's hands, in real time: between ticks push edges, grab nodes and drag them, let go; a
// tick goes on by a fixed time in fixed stable steps; then read forces, positions, residual forces.
//
//   push   a traction on the handle's edges: from the present value to the new one along the next tick's line
//   grab   holds the handle's nodes from now on, at first each with its own velocity v0, which goes over into
//          the hand's within grab_time T:  b(t) = u(from) + course(t) + v0 s (1 - s/T)^3,  s = t - from,
//          at the ends of ticks, the cubic between; neither place nor velocity jumps: no impulse
//   drag   where the hand is to be at the end of the next tick, relative to where it grabbed; the course is
//          the cubic with places and velocities at both ends: C1, and C2 where the caller's own course is a
//          cubic spline with knots at the ticks; a velocity not given is (new - old) / tick
//   tick   k ends at k / rate; the scene's own loads, moves and events go on as scripted
//
// Tractions with keys and hermite moves of a scene say the same: session() is that scene.
// Hands hold exactly: where a scene has constraints = "baumgarte" they push, and a grab holds nothing.
// The stable step is that of the scene: whatever is held beside its constraints lowers the largest frequency
// (eigenvalues of a held body interlace with those of the free one).
//
// Units    SI
// Memory   all of it is taken at construction. A tick and what is called between ticks allocate nothing and
//          take no lock, except: with consistent mass or [[constraint]] the first grab of a set of nodes that
//          no handle is declared with needs a factor; a scene with more than 16 different sets of constraints
//          makes some again at its events; session() and the vectors of active tractions.
// Calls    of the system: on one thread none. On several, those by which OpenMP's threads wait for each other
//          and wake each other (futex, sched_yield), from the second tick on. Where another program has a
//          thread's processor a tick can take milliseconds; one thread then makes the next ones alone, so
//          that this happens in few of them. Excluded only by one thread (SimulationOptions::threads = 1).
// Errors   the constructor: Error::Kind::input as Simulation's, handles with nodes that are not there. Later:
// false for what cannot be done (not finite,
//          beyond the capacity, not grabbed), a Divergence from tick, never an exception.
// Threads  one Live is used by one thread at a time
// Not here clocks and waiting (the caller's), other materials between ticks, contact
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rheo/simulation.hpp"

namespace rheo {

// What a hand can take hold of.
struct Handle {
  std::string name;         // for messages
  std::vector<int> nodes;   // a grab holds these and the edges' own
  std::vector<Edge> edges;  // a push acts on these
  Axis axis = Axis::both;   // in which a grab holds
  int capacity = 0;         // most nodes and most edges that pick() may give it, where more than here
};

struct LiveSettings {
  double rate = 90.0;  // ticks a second
  std::vector<Handle> handles;
  double grab_time = 0.02;  // [s]; shorter than a tick: a tick
  int record = 0;           // keys, nodes and edges (each) that are remembered for session()
  SimulationOptions simulation;
};

struct HandReading {
  Vec2 displacement;  // mean over the handle's nodes
  Vec2 force;         // of the hand on the body: hold and push [N]; the hand feels the opposite
};

class Live {
 public:
  Live(Scene scene, LiveSettings settings);
  // Goes on from the state of another one with the same mesh and rate, at a tick's end, with other parameters
  // as it may be; given the energies of then (SavedState), they balance over the change. Hands hold and push
  // nothing yet, and a session says nothing of what was before.
  Live(Scene scene, LiveSettings settings, const SavedState& saved);
  Live(Live&&) noexcept;
  Live& operator=(Live&&) noexcept;
  ~Live();

  // Handles go by their number in LiveSettings.
  int handle_count() const;

  // Gives an idle handle other nodes and edges.
  bool pick(int handle, std::span<const int> nodes, std::span<const Edge> edges);
  bool push(int handle, Vec2 traction);
  // The same at once, of a handle that pushes nothing: for a hand that goes on where another simulation was
  // left.
  bool press(int handle, Vec2 traction);
  // How many degrees of freedom it holds now: none under constraints = "baumgarte", and not those that the
  // scene holds now or later, or another hand does, or a [[constraint]] binds.
  int grab(int handle);
  bool drag(int handle, Vec2 displacement);
  bool drag(int handle, Vec2 displacement, Vec2 velocity);
  // Lets go of what it grabbed.
  bool release(int handle);
  bool is_grabbed(int handle) const;
  Vec2 traction(int handle) const;

  // On by 1 / rate; nullopt when all is well. After a divergence the state is the one in which it was
  // noticed, and further ticks return it again.
  std::optional<Divergence> tick();

  double time() const;
  std::int64_t ticks() const;
  HandReading read(int handle);
  // Force of all constraints, the hands' too, on the nodes: n x 2.
  std::span<const double> reaction();
  ProbeReading read(const Probe& probe);

  // The rest of the state: u, v, w_lambda, w_mu, energies (work: the hands' too), limits, counters.
  const Simulation& simulation() const;

  // The scene so far with the hands' doings as its moves and tractions, ending now: run with the same step
  // and outputs at the rate it ends in the same state, bit for bit.
  Scene session() const;
  // Whether `record` was enough for all of it.
  bool session_is_complete() const;

 private:
  std::unique_ptr<Hands> hands_;
  std::unique_ptr<Simulation> simulation_;
  double rate_ = 0.0;
  std::int64_t ticks_ = 0;
  std::optional<Divergence> diverged_;
};

}  // namespace rheo
