#include "history_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <string>

namespace app {
namespace {

double norm(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

double largest_length(std::span<const double> u) {
  double largest = 0.0;
  for (std::size_t i = 0; i + 1 < u.size(); i += 2) largest = std::max(largest, std::hypot(u[i], u[i + 1]));
  return largest;
}

// Nothing where a number is not known.
std::string if_known(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{:.17g}", value);
}

}  // namespace

HistoryFile::HistoryFile(const std::filesystem::path& file, const rheo::Scene& scene) : file_(file) {
  std::string header = "t,w_lambda_norm,w_mu_norm,u_max,kinetic,stored,dissipated,work";
  for (const rheo::Probe& probe : scene.probes)
    fmt::format_to(std::back_inserter(header), ",{0}_ux,{0}_uy,{0}_fx,{0}_fy", probe.name);
  file_.write(header + "\n");
}

void HistoryFile::record(rheo::Simulation& simulation, std::int64_t) {
  times_.push_back(simulation.time());
  w_lambda_norms_.push_back(norm(simulation.w_lambda()));
  w_mu_norms_.push_back(norm(simulation.w_mu()));
  const rheo::Energies energies = simulation.energies();
  // 17 significant digits give every double back exactly.
  std::string row =
      fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{}", times_.back(),
                  w_lambda_norms_.back(), w_mu_norms_.back(), largest_length(simulation.u()),
                  energies.kinetic, energies.stored, if_known(energies.dissipated), if_known(energies.work));
  for (const rheo::Probe& probe : simulation.scene().probes) {
    const rheo::ProbeReading reading = simulation.read(probe);
    fmt::format_to(std::back_inserter(row), ",{:.17g},{:.17g},{:.17g},{:.17g}", reading.displacement.x,
                   reading.displacement.y, reading.force.x, reading.force.y);
  }
  file_.write(row + "\n");
}

}  // namespace app
