// A body through the scene's intervals: equal steps to the next event, the passage of the event, rest, and
// the watch over divergence.
//
// Where mass and loads have spent all energy but a rounding of it, or where nothing goes on under loads that
// stay as they are (rest_watch.hpp), nothing is stepped: v = 0 and w' = - rate w, exactly. Looked for where a
// stretch of steps begins and every 64 of them (every one that is long), until an event or a hand.
//
// Units    time [s], energies [J]
// Errors   advance: a Divergence, never an exception
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "energy_book.hpp"
#include "hands.hpp"
#include "holds.hpp"
#include "readings.hpp"
#include "rest_watch.hpp"
#include "step_choice.hpp"

namespace rheo {

class ByteReader;
class ByteWriter;

class Stepping {
 public:
  // All must outlive this. stride: steps from one look at the energies to the next.
  Stepping(const Scene& scene, const Model& model, Schedule& schedule, Body& body, Integrator& integrator,
           StepLimits limits, std::int64_t stride);

  double time() const { return time_; }
  std::optional<Divergence> advance(double t);

  // From now on hands act beside the scene. Takes all memory that they will need.
  void attach(Hands& hands, StepLimits limits);
  // At a time in the current interval the hands changed what they do.
  void enter_now() { enter_from(time_); }

  // Goes on from a state in the mesh's order at a time, as if the scene began there. before: of that state by
  // the parameters of then; what the energies jump by is work.
  void resume(double t, std::span<const double> y, const std::optional<Energies>& before);

  // All but the state of what the next calls hang on (Snapshot), and back with that state in the mesh's
  // order. Not of one under hands.
  void put_course(ByteWriter& out);
  void get_course(ByteReader& in, std::span<const double> y);

  const StepLimits& limits() const { return limits_; }
  double largest_step() const { return largest_step_; }
  const Interval& interval() const { return interval_; }
  std::size_t interval_index() const { return index_; }
  const EnergyBook& book() const { return book_; }
  // Whether the quadrature over a step gives all of the work, and of what is dissipated.
  bool books_work() const;
  bool has_constant_loads() const;
  bool is_beyond_limit() const { return limits_.bound > limits_.stable; }  // as the user allowed
  double explained_energy() const;
  double cancelled_way();
  bool books_dissipated() const;
  Readings& readings() { return readings_; }

 private:
  void enter(std::size_t i);
  void enter_from(double begin);
  bool looks_at_rest();
  // Instead of so many steps.
  void pass_at_rest(double end, std::int64_t steps);
  std::int64_t steps_to(double end) const;
  std::optional<Divergence> run_segment(double end);
  double violation(std::size_t column);
  void note_violations();
  void note_motions();
  std::optional<Divergence> check_divergence();
  Divergence divergence_now();

  const Scene& scene_;
  const Model& model_;
  Schedule& schedule_;
  Body& body_;
  Integrator& integrator_;
  StepLimits limits_;
  std::int64_t stride_ = 1;

  Readings readings_;
  EnergyBook book_;
  RestWatch rest_;
  bool resting_ = false;
  std::int64_t steps_since_look_ = 0;
  Holds holds_;
  Hands* hands_ = nullptr;
  Interval interval_, next_;
  // The energy and the book when it began; and what its loads' work can be late by, as Euler's is: by a step.
  struct Begun {
    double energy = 0.0, work = 0.0, turnover = 0.0, net_turnover = 0.0;
    double late = 0.0;
  } begun_;
  bool entered_ = false;
  std::size_t index_ = 0;
  double time_ = 0.0;
  double largest_step_ = 0.0;
  std::vector<double> allowed_violation_;
  double cancelled_way_ = 0.0;  // [m]
  int excuses_ = 0;             // for energy beyond the work by quadrature
  std::optional<Divergence> diverged_;
};

}  // namespace rheo
