#include "readings.hpp"

#include "kernels/flush_denormals.hpp"
#include "rheo/io/bytes.hpp"

namespace rheo {

Readings::Readings(const Model& model, Body& body)
    : model_(model), body_(body), y_(model.layout.size(), 0.0) {}

void Readings::state_changed() {
  y_known_ = false;
  sampled_ = state_sampled_ = false;
  reaction_known_ = false;
}

void Readings::loads_changed() {
  const bool known = sampled_;
  state_changed();
  state_sampled_ = known;
}

void Readings::put(ByteWriter& out) const {
  out.put(sample_);
  out.put(sample_time_);
  out.put(static_cast<std::uint64_t>(sampled_ ? 1 : 0));
  out.put(static_cast<std::uint64_t>(state_sampled_ ? 1 : 0));
}

void Readings::get(ByteReader& in) {
  state_changed();
  state();  // before anything asks what it was last
  sample_ = in.get<EnergySample>();
  sample_time_ = in.get<double>();
  sampled_ = in.get<std::uint64_t>() != 0;
  state_sampled_ = in.get<std::uint64_t>() != 0;
}

std::span<double> Readings::state() {
  if (!y_known_) {
    const FlushDenormals flush;  // whoever looks
    body_.store(y_);
  }
  y_known_ = true;
  return y_;
}

const EnergySample& Readings::sample(double t) {
  if (sampled_) return sample_;
  if (state_sampled_) {
    body_.resample(t, sample_);
  } else {
    sample_ = body_.sample(t);
    ++body_.counters().energy_samples;
  }
  sample_time_ = t;
  sampled_ = state_sampled_ = true;
  return sample_;
}

void Readings::know_reaction(double t) {
  if (reaction_known_) return;
  body_.reaction(t, reaction_);
  body_.external_force(t, external_);
  reaction_known_ = true;
}

std::span<const double> Readings::reaction(double t) {
  know_reaction(t);
  return all_of(reaction_);
}

std::span<const double> Readings::external_force(double t) {
  know_reaction(t);
  return all_of(external_);
}

std::span<const double> Readings::reaction_at(double t, std::span<const HeldDof> held) {
  if (!reaction_known_) body_.reaction_at(t, held, reaction_);
  return all_of(reaction_);
}

void Readings::reserve_reactions() {
  reaction_.setZero(static_cast<Eigen::Index>(model_.layout.part));
  external_ = reaction_;
}

}  // namespace rheo
