// What acts on single nodes of a lumped body, beside the rheological force: loads, and degrees of freedom
// that are held or moved.
//
//   v' += f(t) / m        where something pulls
//   v'  = b''(t)          where a degree of freedom is eliminated (its inverse mass is zero)
//
// Shapes   entries by slot: 2 x (the kernel's node) + axis
// Errors   none
#pragma once

#include <span>
#include <vector>

#include "body.hpp"

namespace rheo {

class NodalTerms {
 public:
  // `mass`: n x 2, `kernel_node`: by node of the mesh; both must outlive this. `block_ends`: by block of
  // nodes, one past its last, rising.
  NodalTerms(std::span<const double> mass, std::span<const std::int32_t> kernel_node,
             std::vector<std::int32_t> block_ends);

  // What holds from here on; the interval must stay alive until the next call.
  void enter(const Interval& interval);

  std::span<const double> inverse_mass() const { return inverse_mass_; }

  // h times these terms added to out_v at a block's nodes.
  void add(const Body& body, double h, const Forcing& forcing, double* out_v, std::size_t block) const;

  // Held degrees of freedom go where they are told to be at t.
  void impose(const Body& body, double t, double* u, double* v) const;

  // The loads' share of a sample.
  void sample_loads(double t, const double* u, const double* v, EnergySample& sample) const;
  // The moved degrees of freedom's, from F of w and of w'. Nothing where they stand still.
  void sample_constraints(const Body& body, double t, const double* force, const double* force_rate,
                          const double* v, EnergySample& sample) const;
  bool moving() const { return interval_->moving; }

  // M a + F - f where a degree of freedom is held: written in the mesh's order, zero elsewhere.
  void reaction(const Body& body, double t, const double* force, Vector& out) const;

 private:
  struct Load {
    std::size_t slot = 0;
    double force = 0.0, slope = 0.0;                      // at the interval's begin
    double acceleration = 0.0, acceleration_slope = 0.0;  // by mass; 0 where held
  };
  struct Held {
    std::size_t slot = 0;
    HeldDof dof;
    double force = 0.0, slope = 0.0;  // external ones on it
  };

  std::span<const double> mass_;
  std::span<const std::int32_t> kernel_node_;
  std::vector<std::int32_t> block_ends_;
  const Interval* interval_ = nullptr;
  std::vector<double> inverse_mass_;  // n x 2
  std::vector<Load> loads_;
  std::vector<Held> held_;
  std::vector<std::size_t> load_begin_, held_begin_;  // by block, one more at the end
};

}  // namespace rheo
