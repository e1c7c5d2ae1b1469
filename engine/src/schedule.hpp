// The scene's course: from event to event, which constraints and loads act, as an Interval each.
//
// Constraint solvers are shared by intervals with the same active constraints.
// Errors   Error::Kind::input from held_dofs and ConstraintSolver, for every interval at construction
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "body.hpp"
#include "columns.hpp"
#include "constraints.hpp"
#include "rheo/stability.hpp"

namespace rheo {

// The automatic step's bound where smooth motions go on: RK4 leaves the residual forces of what is moved an
// error that hangs on the steps through such a motion alone, 1e-4 of them at 16. A given step is left as it
// is, and so are integrators that take forcing into account as it is.
double resolving_bound(const TimeSettings& settings, std::span<const std::array<Polynomial, 2>> courses,
                       double bound);

// Node and h l / 2, summed over a traction's edges; rising nodes.
using LoadPattern = std::vector<std::pair<int, double>>;
// Into memory of 2 entries an edge that `out` may have already.
void load_pattern(const Mesh& mesh, std::span<const Edge> edges, LoadPattern& out);
// A traction's part of an interval's force and its slope.
void add_traction(Interval& interval, const LoadPattern& pattern, const std::array<Polynomial, 2>& course);

class Schedule {
 public:
  // Both must outlive this. `memory`: of ConstraintSolver.
  Schedule(const Scene& scene, const Model& model, double memory = 0.0, Nearness nearness = Nearness::near,
           const std::function<void(double)>& searching = {});

  std::size_t interval_count() const { return events_.size(); }
  double begin(std::size_t i) const { return events_[i]; }
  double end(std::size_t i) const;  // infinite for the last

  Interval interval(std::size_t i) {
    Interval result;
    fill(i, begin(i), result);
    return result;
  }
  // What holds from `begin` on, a time in interval i. Allocates nothing where `out` was filled before, but
  // for sets of constraints beyond the first 16.
  void fill(std::size_t i, double begin, Interval& out);
  // The solver of interval i where `held` is eliminated beside its constraints (all of them in `held`);
  // lumped mass without [[constraint]]: one solver, made over at each call, without allocation; else made
  // where it was not asked for before.
  std::shared_ptr<const ConstraintSolver> solver_holding(std::size_t i, const std::vector<HeldDof>& held);
  // Whether that needs no factor.
  bool holding_is_free() const { return model_.is_lumped() && scene_.constraints.empty(); }
  std::size_t holder_count() const { return holders_.size(); }
  // Steps of at most `bound` through all intervals and outputs.
  std::int64_t planned_steps(double bound) const;
  void active_tractions(std::size_t i, double t, std::vector<Simulation::ActiveTraction>& out) const;

  // Over all sets of constraints that the scene goes through.
  Spectrum spectrum() const { return spectrum_; }

 private:
  using Signature = std::vector<char>;  // which holders are active

  double middle(std::size_t i) const;
  Signature signature(std::size_t i) const;
  // By holder: how it moves around t = inside; nothing where it is not active.
  void courses(const Signature& active, double inside, std::vector<std::array<Polynomial, 2>>& out) const;
  std::vector<Column> general_columns() const;
  // What a set of active holders holds, and the solver for it.
  struct Held {
    Signature active;
    std::vector<HeldDof> held;
    std::shared_ptr<const ConstraintSolver> solver;
  };
  Held make_held(const Signature& active) const;
  void make_spectrum(Nearness nearness, const std::function<void(double)>& searching);
  void find_range_step(Nearness nearness, const std::function<void(double)>& searching);
  // Of every set of constraints, or where they are many of none: a body that is held less has all of it.
  void for_each_bounding_solver(const std::function<void(const ConstraintSolver&)>& visit) const;

  const Scene& scene_;
  const Model& model_;
  double memory_;
  std::vector<double> events_;
  std::vector<Holder> holders_;
  std::vector<LoadPattern> patterns_;          // by traction
  std::vector<Held> sets_;                     // distinct; beyond those kept the signature alone
  std::vector<std::size_t> set_of_;            // by interval
  Held unkept_;                                // the last one made again
  std::shared_ptr<ConstraintSolver> working_;  // of solver_holding
  struct Holding {
    std::size_t set = 0;
    std::vector<HeldDof> held;
    std::shared_ptr<const ConstraintSolver> solver;
  };
  std::vector<Holding> holding_;
  Spectrum spectrum_;
};

}  // namespace rheo
