#include "vtu_series.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "failure.hpp"

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

void VtuSeries::take_up(const std::vector<double>& times) {
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::string name = vtu_name(static_cast<std::int64_t>(k));
    if (!std::filesystem::exists(folder_.path() / name))
      throw Failure(ExitCode::file,
                    fmt::format("{}: the cut run's file is gone: begin the run anew with --force",
                                (folder_.path() / name).string()));
    entries_.push_back({times[k], std::filesystem::path(name).filename().string()});
    folder_.made(name);
  }
}

void VtuSeries::finish() {
  const std::string name = "vtu/state.pvd";
  rheo::write_pvd(folder_.file(name), entries_);
  folder_.made(name);
}

}  // namespace app
