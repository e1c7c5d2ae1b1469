// The scene's course: from event to event, which constraints and loads act, as an Interval each.
//
// Constraint solvers are shared by intervals with the same active constraints.
// Errors   Error::Kind::input from held_dofs and ConstraintSolver, for every interval at construction
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "body.hpp"
#include "constraints.hpp"
#include "rheo/stability.hpp"

namespace rheo {

// Whether some constraint of the scene is not eliminated but solved for (equation 4).
bool has_columns(const Scene& scene);

class Schedule {
 public:
  // Both must outlive this.
  Schedule(const Scene& scene, const Model& model);

  std::size_t interval_count() const { return events_.size(); }
  double begin(std::size_t i) const { return events_[i]; }
  double end(std::size_t i) const;  // infinite for the last

  Interval interval(std::size_t i);
  std::vector<Simulation::ActiveTraction> active_tractions(std::size_t i, double t) const;

  // Over all sets of constraints that the scene goes through.
  Spectrum spectrum() const { return spectrum_; }

 private:
  using Signature = std::vector<char>;  // which holders are active

  double middle(std::size_t i) const;
  Signature signature(std::size_t i) const;
  std::shared_ptr<const ConstraintSolver> solver(const Signature& signature);
  std::shared_ptr<const ConstraintSolver> make_solver(const Signature& signature) const;
  void make_spectrum(const std::vector<Signature>& signatures);

  const Scene& scene_;
  const Model& model_;
  std::vector<double> events_;
  std::vector<Holder> holders_;
  std::vector<std::vector<std::pair<int, double>>> patterns_;  // by traction: node, h l / 2 summed
  std::map<Signature, std::shared_ptr<const ConstraintSolver>> solvers_;
  Spectrum spectrum_;
};

}  // namespace rheo
