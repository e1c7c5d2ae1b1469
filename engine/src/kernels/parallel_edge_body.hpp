// ParallelBody by the edge form (edge_form.hpp).
#pragma once

#include <vector>

#include "kernels/edge_force.hpp"
#include "kernels/parallel_body.hpp"

namespace rheo {

class ParallelEdgeBody final : public ParallelBody {
 public:
  // `force` must outlive this. threads: 0 for as many as pay on this machine.
  ParallelEdgeBody(const Model& model, const EdgeForce& force, int threads);

  std::string_view kernel() const override { return "edge"; }

 protected:
  void sweep_force(const SweepArrays& arrays, double h, const BlockVisit& visit) override;
  void forms_of(const double* w, std::size_t stride, const double* x, std::span<Forms> forms) override;
  std::array<double, 2> force_of(const double* rows, std::size_t node) const override;

 private:
  const EdgeForce& edge_force_;
  const EdgeForm& form_;
  std::vector<std::size_t> corner_begin_;  // by block, one more at the end
  std::vector<EdgeForms> sums_;  // by block: added up in their order, whatever the number of threads
};

}  // namespace rheo
