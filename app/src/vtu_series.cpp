#include "vtu_series.hpp"

#include <filesystem>

namespace app {

void VtuSeries::record(rheo::Simulation& simulation, std::int64_t k) {
  const std::string name = vtu_name(k);
  stress_.resize(3 * simulation.scene().mesh.triangles.size());
  simulation.stress(stress_);
  rheo::write_vtu(folder_.file(name), simulation.scene().mesh,
                  {simulation.u(), simulation.v(), simulation.w_lambda(), simulation.w_mu(),
                   simulation.pull_lambda(), simulation.pull_mu(), stress_},
                  {simulation.scene().bodies, simulation.scene().region_of_triangle});
  entries_.push_back({simulation.time(), std::filesystem::path(name).filename().string()});
  folder_.made(name);
}

void VtuSeries::finish() {
  const std::string name = "vtu/state.pvd";
  rheo::write_pvd(folder_.file(name), entries_);
  folder_.made(name);
}

}  // namespace app
