// What is looked at between steps, worked out at most once a state: the state in the mesh's order, energies,
// reactions.
//
// Units    u [m], v [m/s], forces [N], energies [J]
// Shapes   state: Layout; reaction, external: 2n
#pragma once

#include <span>
#include <vector>

#include "body.hpp"

namespace rheo {

class ByteReader;
class ByteWriter;

class Readings {
 public:
  // Both must outlive this.
  Readings(const Model& model, Body& body);

  // The body's state is another one now.
  void state_changed();
  // The state is the same, loads and constraints may be others.
  void loads_changed();

  // Of a run that is to go on: the energies as they were worked out, on whichever side of an event.
  void put(ByteWriter& out) const;
  // The body has its state already.
  void get(ByteReader& in);

  // In the mesh's order; the body takes it back from there by Body::load.
  std::span<double> state();
  // As it was when last worked out.
  std::span<const double> last_state() const { return y_; }
  VectorMap u() { return part(model_.layout.u()); }
  VectorMap v() { return part(model_.layout.v()); }

  const EnergySample& sample(double t);
  // Likewise as it was.
  const EnergySample& last_sample() const { return sample_; }
  double last_sample_time() const { return sample_time_; }

  std::span<const double> reaction(double t);
  std::span<const double> external_force(double t);
  // Where only these are looked at; others may hold anything.
  std::span<const double> reaction_at(double t, std::span<const HeldDof> held);
  // Takes the memory for them at once.
  void reserve_reactions();

 private:
  VectorMap part(std::size_t offset) {
    return {state().data() + offset, static_cast<Eigen::Index>(model_.layout.part)};
  }
  void know_reaction(double t);
  static std::span<const double> all_of(const Vector& x) {
    return {x.data(), static_cast<std::size_t>(x.size())};
  }

  const Model& model_;
  Body& body_;
  std::vector<double> y_;
  bool y_known_ = true;  // zeros, as the body's
  EnergySample sample_;
  double sample_time_ = 0.0;
  bool sampled_ = false, state_sampled_ = false;  // all of it; what depends on the state alone
  Vector reaction_, external_;
  bool reaction_known_ = false;
};

}  // namespace rheo
