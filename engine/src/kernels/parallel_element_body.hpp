// ParallelBody by the element form (element_form.hpp), of one or several materials.
//
// Threads  as ElementBody: blocks of nodes by several threads give the same bits
#pragma once

#include <vector>

#include "kernels/element_force.hpp"
#include "kernels/element_sums.hpp"
#include "kernels/parallel_body.hpp"

namespace rheo {

class ParallelElementBody final : public ParallelBody {
 public:
  // `force` must outlive this. threads: 0 for as many as pay on this machine.
  ParallelElementBody(const Model& model, const ElementForce& force, int threads);

  std::string_view kernel() const override { return "element"; }

 protected:
  void sweep_force(const SweepArrays& arrays, double h, const BlockVisit& visit) override;
  void forms_of(const double* w, std::size_t stride, const double* x, std::span<Forms> forms) override;
  std::array<double, 2> force_of(const double* rows, std::size_t node) const override;

 private:
  void advance_interface(const ElementForm::Run& run, double h, const SweepArrays& arrays,
                         double* force) const;

  const ElementForce& element_force_;
  const ElementForm& form_;
  std::vector<ElementForm::Block> blocks_;
  ElementSums force_sums_;
  // Of energies, by block and region: added up in their order, which the number of threads does not change.
  std::vector<Forms> sums_;
};

}  // namespace rheo
