// One scene in motion: fixed steps between events and outputs, energies, reactions, divergence.
//
//   u'        = v
//   M v'      = f - J_lambda p_lambda - J_mu p_mu + A L
//   A^T v'    = b'' - 2 omega (A^T v - b') - omega^2 (A^T u - b)
//   w_lambda' = -(lambda_ela / lambda_vis) w_lambda + lambda_ela v        for each branch
//   w_mu'     = -(mu_ela / mu_vis) w_mu + mu_ela v
//   p_lambda  = sum over the branches of w_lambda + elastic_lambda u + viscous_lambda v, p_mu likewise
//
// Source   Hirai and Tomokuni, eq. (3), (4)
// Units    u [m], v [m/s], w [Pa m], forces [N], energies [J], time [s]
// Shapes   u, v, w_lambda, w_mu, reaction: n x 2, node by node (x0, y0, x1, y1, ...)
// Errors   the constructor: Error::Kind::input (values, contradictory or dependent constraints, a step beyond
// the stable
//          limit, more memory than may be taken); advance: a Divergence, never an exception, never a reset
// Threads  inside a step only; one Simulation is used by one thread at a time, several are independent
// Not here files, pictures
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rheo/accuracy.hpp"
#include "rheo/scene.hpp"
#include "rheo/stability.hpp"

namespace rheo {

class Hands;
struct HeldDof;

struct Energies {
  double kinetic = 0.0;     // 1/2 v^T M v
  double stored = 0.0;      // 1/2 w_l^T J_l w_l / lambda_ela + 1/2 w_m^T J_m w_m / mu_ela, of each branch,
                            // + 1/2 u^T (elastic_l J_l + elastic_m J_m) u
  double dissipated = 0.0;  // since the start, by a quadrature of the integrator's order
  double work = 0.0;        // of loads, moving constraints, impulses and changes of parameters, likewise
  // Not known (NaN) with the exponential and implicit integrators, whose steps are too long for a quadrature:
  // dissipated, unless nothing relaxes or is viscous; work, where nodes are moved or a traction has several
  // keys.
};

struct Divergence {
  double t = 0.0;            // when it was noticed [s]
  int node = 0;              // the fastest node, or the first with a non-finite number
  double energy = 0.0;       // kinetic + stored
  double allowed = 0.0;      // what the start and the work done can explain, where the work is known
  double stable_step = 0.0;  // the largest stable step of the integrator in use
};

struct ProbeReading {
  Vec2 displacement;  // mean over the nodes
  Vec2 force;         // reaction + traction, summed over the nodes
};

struct Counters {
  std::int64_t steps = 0;
  std::int64_t force_evaluations = 0;  // products with J_lambda and J_mu together count once
  std::int64_t branch_updates = 0;  // residual forces advanced, lambda and mu of each branch: of one branch
                                    // 2 an evaluation; 1 where the two relax at
                                    // one rate or one is off, 0 where nothing relaxes (edge kernel)
  std::int64_t displacement_updates = 0;  // times that u was advanced: once a step where no force hangs on it
  std::int64_t mass_solves = 0;           // sparse solves with the consistent mass
  std::int64_t constraint_solves = 0;     // solves for Lagrange multipliers
  std::int64_t projections = 0;           // velocity jumps where constraints begin
  std::int64_t energy_samples = 0;        // looks at the energies: each costs about one evaluation
  std::int64_t steps_at_rest = 0;         // not taken, because nothing moved and nothing acted
  std::int64_t flushed_steps = 0;         // with denormal numbers taken for zero: all, on x86-64
  std::int64_t factors = 0;               // implicit: made, for a step size and set of constraints each
  std::int64_t shifted_solves = 0;        // implicit: sparse solves with them
};

// All of the state at a time: what another simulation of the same mesh goes on from.
struct SavedState {
  double t = 0.0;
  std::vector<double> u, v;                         // 2n
  std::vector<std::vector<double>> w_lambda, w_mu;  // by branch, 2n each; where materials meet their mean
  // Each material's own, where there are several.
  struct Part {
    bool lambda = true;
    std::size_t material = 0, branch = 0;
    std::vector<double> w;
  };
  std::vector<Part> parts;
  std::optional<Energies> energies;  // of then, where books are to go on; save() leaves it open
};

// All of a simulation, to the bit, between two calls of advance.
struct Snapshot {
  SavedState state;
  std::string course;  // what else its next steps and energies hang on: bytes for restore() alone
};

// Ways to the same rheological force.

enum class Kernel {
  automatic,  // the fastest that the scene allows: edge, element, csr
  csr,        // assembled matrices: every scene; the reference
  edge,    // by edges, vectorised: lumped mass, fixed and moved nodes eliminated, one material and thickness
  element  // by triangles, vectorised: lumped mass, fixed and moved nodes eliminated
};

// What an explicit integrator's stable limit is worth on bodies too large for all their eigenvalues, where it
// hangs on more than omega_max. Steps between one and the next are refused by the latter.
enum class Nearness {
  near,   // Euler: by the eigenvalues that it hangs on, up to half a minute for each set of constraints
  range,  // some hundred to thousand products with the connection matrices; stable whatever is held besides
  safe    // none
};

struct SimulationOptions {
  bool allow_unstable = false;  // run a step beyond the stable limit instead of refusing it
  Kernel kernel = Kernel::automatic;
  bool energies = true;        // without: dissipated and work are not known (NaN), and a step costs less
  double stable_share = 0.25;  // of the stable limit: the largest step where the scene gives none
  Nearness nearness = Nearness::near;
  int threads = 0;      // of edge and element; 0: as many as pay. The result does not depend on it.
  double memory = 0.0;  // [bytes] that it may take (memory_need.hpp); 0: what this machine has available
  // Where the scene asks for an accuracy: told at each output which trial run of the choice (1, 2, ...) has
  // come how far (up to 1).
  std::function<void(int, double)> planning = {};
  // Where Nearness::near takes long: told now and then what part of the longest search there may be is done.
  std::function<void(double)> searching = {};
};

class Simulation {
 public:
  explicit Simulation(Scene scene, SimulationOptions options = {});
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  const Scene& scene() const;

  // Where the scene asked for an accuracy: what was chosen for it. scene().time then has the choice, and asks
  // for none.
  const std::optional<AccuracyPlan>& plan() const;

  // The stable limits (over all sets of constraints that the scene goes through) and the largest step that
  // will be used; both infinite for the exponential and the implicit integrator (then from event to event and
  // output to output), the second unless a step is given.
  const Spectrum& spectrum() const;
  double stable_step() const;
  double step_bound() const;
  // The largest taken so far; 0 before the first.
  double largest_step() const;
  // Steps from 0 to the scene's duration with outputs at its frame rate. Costs nothing: counted, not run,
  // those at rest too.
  std::int64_t planned_steps() const;

  // The kernel in use: "csr", "edge" or "element".
  std::string_view kernel() const;
  // How many threads its steps have.
  int threads() const;
  // Memory of the implicit integrator's factor for one step size [bytes]; 0 for the others.
  std::size_t factor_bytes() const;

  double time() const;
  // Runs to time t >= time(), in equal steps between the events on the way; nullopt when all is well.
  // After a divergence the state is the one in which it was noticed, and further calls return it again.
  std::optional<Divergence> advance(double t);

  // The state now; and going on from one that a simulation of the same mesh had, with this one's parameters.
  // Branches that are not in both begin at zero. What the scene holds or moves is held where it is then.
  // dissipated and work count from there. Where saved.energies are given (energies() of then), they go on
  // from these, and what kinetic + stored jump by, because density or moduli are others now or because the
  // scene stops what it holds, is booked as work: kinetic + stored + dissipated - work is what it was.
  SavedState save() const;
  void resume(const SavedState& saved);

  // The same to the bit, energies, counters and all: for a simulation of the same scene with the same kernel.
  // Not of one under hands (live.hpp) or one that has diverged. io/checkpoint.hpp keeps it in a file.
  // Errors of restore: Error::Kind::input where it is another scene's or kernel's.
  Snapshot snapshot() const;
  void restore(const Snapshot& snapshot);

  std::span<const double> u() const;
  std::span<const double> v() const;
  // All residual forces but the elastic part's: sum over the branches of w + viscous v. Valid until the next
  // call or step. Where materials meet, a node has residual forces of its own for each of them; here and
  // below it is given their mean, weighted by the area of each material's triangles at the node.
  std::span<const double> w_lambda() const;
  std::span<const double> w_mu() const;
  // Of one branch (Material::branch); zeros where it is off.
  std::span<const double> w_lambda(std::size_t branch) const;
  std::span<const double> w_mu(std::size_t branch) const;
  // p, with the elastic part: what the stress comes from (deformation.hpp). Without one the same as w.
  std::span<const double> pull_lambda() const;
  std::span<const double> pull_mu() const;
  // Of every triangle, from its own material's p: m x 3 (xx, yy, xy) [Pa].
  void stress(std::span<double> out) const;

  Energies energies() const;
  // Force of the constraints on the nodes, now (just after an event at this time).
  std::span<const double> reaction();
  // Tractions and body force on the nodes, now.
  std::span<const double> external_force();
  // Lagrange multipliers of the general constraints, in the scene's order, now.
  std::span<const double> multipliers();
  ProbeReading read(const Probe& probe);

  // What acts now, for pictures: indices into scene().tractions with their value [Pa], and the degrees of
  // freedom, 2 node + axis, that a fix or a move holds, in ascending order.
  struct ActiveTraction {
    int index = 0;
    Vec2 p;
  };
  std::vector<ActiveTraction> active_tractions() const;
  std::vector<int> held_dofs() const;
  // The same into what the caller keeps: no allocation where it had room for as many before.
  void active_tractions(std::vector<ActiveTraction>& out) const;
  void held_dofs(std::vector<int>& out) const;

  const Counters& counters() const;

 private:
  friend class Live;
  // From now on hands act beside the scene; they must outlive this.
  void attach(Hands& hands);
  // At the current time they begin to do something else.
  void hands_changed();
  // reaction() where only these are looked at.
  std::span<const double> reaction_at(std::span<const HeldDof> held);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Outputs of a run: t_k = k / frame_rate for k = 0 .. output_count - 1, the last not after the duration.
std::int64_t output_count(const TimeSettings& time);
double output_time(const TimeSettings& time, std::int64_t k);

}  // namespace rheo
