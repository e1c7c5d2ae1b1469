#include "history_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
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

// Not a number: not asked for.
std::string or_empty(double energy) {
  return std::isnan(energy) ? "" : fmt::format("{:.17g}", energy);
}

}  // namespace

HistoryFile::HistoryFile(const std::filesystem::path& file, const rheo::Scene& scene) : file_(file) {
  std::string header = "t,w_lambda_norm,w_mu_norm,u_max,kinetic,stored,dissipated,work";
  for (const rheo::Probe& probe : scene.probes)
    fmt::format_to(std::back_inserter(header), ",{0}_ux,{0}_uy,{0}_fx,{0}_fy", probe.name);
  file_.append(header + "\n");
}

HistoryFile::HistoryFile(const std::filesystem::path& file, const GrowingFile::Mark& kept)
    : file_(file, kept, 0, [this](std::string_view row) { see(row); }) {}

// A row that was written here: 17 digits give the same numbers back. The header begins with a letter.
void HistoryFile::see(std::string_view row) {
  if (row.starts_with("t,")) return;
  const std::string text(row);
  const char* at = text.c_str();
  for (std::vector<double>* column : {&times_, &w_lambda_norms_, &w_mu_norms_}) {
    char* end = nullptr;
    column->push_back(std::strtod(at, &end));
    at = *end == ',' ? end + 1 : end;
  }
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
                  energies.kinetic, energies.stored, or_empty(energies.dissipated), or_empty(energies.work));
  for (const rheo::Probe& probe : simulation.scene().probes) {
    const rheo::ProbeReading reading = simulation.read(probe);
    fmt::format_to(std::back_inserter(row), ",{:.17g},{:.17g},{:.17g},{:.17g}", reading.displacement.x,
                   reading.displacement.y, reading.force.x, reading.force.y);
  }
  file_.append(row + "\n");
}

}  // namespace app
