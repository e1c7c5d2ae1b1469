// Tractions as arrows: one at the middle of every edge whose tractions do not cancel.
//
// Units    tractions [Pa], positions [m]
// Shapes   positions: n x 2, deformed
// Errors   none
#pragma once

#include <array>
#include <span>
#include <vector>

#include "render/mesh_picture.hpp"
#include "rheo/simulation.hpp"

namespace app {

// The sum of the active tractions on each loaded edge of a scene.
class LoadedEdges {
 public:
  explicit LoadedEdges(const rheo::Scene& scene);

  std::vector<std::array<double, 2>> sums(std::span<const rheo::Simulation::ActiveTraction> tractions) const;
  std::vector<render::TractionArrow> arrows(std::span<const rheo::Simulation::ActiveTraction> tractions,
                                            std::span<const double> positions) const;

 private:
  std::vector<rheo::Edge> edges_;
  std::vector<std::vector<std::size_t>> slots_;  // per traction: numbers into edges_
};

render::TractionArrow arrow_on(const rheo::Edge& edge, const std::array<double, 2>& traction,
                               std::span<const double> positions);

}  // namespace app
