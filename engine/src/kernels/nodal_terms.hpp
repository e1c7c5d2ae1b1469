// What acts on single nodes of a lumped body, beside the rheological force: loads, and degrees of freedom
// that are held or moved.
//
//   v' += f(t) / m        where something pulls
//   v'  = b''(t)          where a degree of freedom is eliminated (its inverse mass is zero)
//   R   = m b'' + F - f   what holds it
//
// One that is held where it is costs nothing from step to step: its v is exactly zero.
//
// Shapes   entries by slot: 2 x (the kernel's node) + axis; F: asked for node by node, where one is held
// Errors   none
// Not here what F is: the kernels'
#pragma once

#include <array>
#include <span>
#include <vector>

#include "aligned_vector.hpp"
#include "body.hpp"

namespace rheo {

// Of one node: the force F of the state, and with w' for w.
struct NodeForce {
  std::array<double, 2> force{}, rate{};
};

class NodalTerms {
 public:
  // `mass`: n x 2, `kernel_node`: by node of the mesh; both must outlive this. `ends`: node_blocks.hpp.
  NodalTerms(std::span<const double> mass, std::span<const std::int32_t> kernel_node,
             std::vector<std::int32_t> ends);

  // What holds from here on; the interval must stay alive until the next call. Allocates nothing.
  void enter(const Interval& interval);

  // n x 2, zero where held.
  const double* inverse_mass() const { return inverse_mass_.data(); }

  // h times these terms added to out_v at a block's nodes.
  void add(const Body& body, double h, const Forcing& forcing, double* out_v, std::size_t block) const;

  // Held degrees of freedom go where they are told to be at t: all of them once in an interval, then those
  // that move.
  void impose(const Body& body, double t, double* u, double* v);

  // The loads' and constraints' share of a sample; force_at(node) is a NodeForce.
  template <class ForceAt>
  void sample(const Body& body, double t, const double* u, const double* v, const ForceAt& force_at,
              EnergySample& sample) const {
    sample_loads(t, u, v, sample);
    sample.constraints = sample.constraints_rate = 0.0;
    if (!interval_->moving) return;
    NodeForce at;
    std::size_t node = mass_.size();
    for (const Held& held : held_) {
      if (!held.moves) continue;
      if (held.slot / 2 != node) at = force_at(node = held.slot / 2);
      add_power(body, t, held.dof, at, v, sample);
    }
  }

  // R of some eliminated degrees of freedom, in the mesh's order.
  template <class ForceAt>
  void reaction_at(const Body& body, double t, std::span<const HeldDof> held, const ForceAt& force_at,
                   Vector& out) const {
    NodeForce at;
    std::size_t node = mass_.size();
    for (const HeldDof& h : held) {
      if (slot(h.dof) / 2 != node) at = force_at(node = slot(h.dof) / 2);
      out[h.dof] = reaction(body, t, h, at);
    }
  }

  // R of all, zero elsewhere.
  template <class ForceAt>
  void reaction(const Body& body, double t, const ForceAt& force_at, Vector& out) const {
    out.setZero(static_cast<Eigen::Index>(mass_.size()));
    reaction_at(body, t, interval_->eliminated, force_at, out);
  }

 private:
  struct Load {
    std::size_t slot = 0;
    double force = 0.0, slope = 0.0;                      // at the interval's begin
    double acceleration = 0.0, acceleration_slope = 0.0;  // by mass; 0 where held
  };
  struct Held {
    std::size_t slot = 0;
    HeldDof dof;
    bool moves = false;  // in this interval; else v = 0 exactly
  };

  std::size_t slot(int dof) const {
    return 2 * static_cast<std::size_t>(kernel_node_[static_cast<std::size_t>(dof / 2)]) +
           static_cast<std::size_t>(dof % 2);
  }
  double slope(int dof) const { return interval_->force_rate.size() > 0 ? interval_->force_rate[dof] : 0.0; }
  void sample_loads(double t, const double* u, const double* v, EnergySample& sample) const;
  double reaction(const Body& body, double t, const HeldDof& held, const NodeForce& at) const;
  void add_power(const Body& body, double t, const HeldDof& held, const NodeForce& at, const double* v,
                 EnergySample& sample) const;

  std::span<const double> mass_;
  std::span<const std::int32_t> kernel_node_;
  std::vector<std::int32_t> ends_;
  const Interval* interval_ = nullptr;
  bool imposed_ = false;        // since the interval began
  AlignedVector inverse_mass_;  // n x 2
  std::vector<Load> loads_;     // where there are any
  std::vector<Held> held_;
  std::vector<std::size_t> load_begin_, held_begin_;  // by block, one more at the end
};

}  // namespace rheo
