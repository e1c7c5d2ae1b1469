#include "material_rows.hpp"

#include <fmt/format.h>

#include "rheo/material_presets.hpp"

namespace app {
namespace {

using Rows = std::vector<std::pair<std::string, std::string>>;

// At most so many conversions; the rest is counted.
constexpr std::size_t most_conversions = 12;

std::string branch_text(double ela, double vis, double rate) {
  if (ela == 0.0) return "off";
  if (rate == 0.0) return fmt::format("{:g} Pa, never relaxes", ela);
  return fmt::format("{:g} Pa, {:g} Pa s (relaxation time {:.4g} s)", ela, vis, 1.0 / rate);
}

const char* plane_text(rheo::Plane plane) {
  return plane == rheo::Plane::strain ? "plane strain" : "plane stress";
}

void add_preset(const rheo::MaterialOrigin& origin, Rows& rows) {
  if (const rheo::Preset* preset = rheo::find_preset(origin.preset))
    rows.emplace_back("preset", fmt::format("{}: {}; {}", preset->name, preset->circuit, preset->source));
}

void add_conversions(const rheo::MaterialOrigin& origin, Rows& rows) {
  std::size_t shown = 0;
  for (const rheo::MaterialConversion& c : origin.conversions) {
    if (shown == most_conversions) {
      rows.emplace_back("from", fmt::format("and {} more", origin.conversions.size() - shown));
      return;
    }
    rows.emplace_back("from", fmt::format("{} = {:g} {}, poisson = {:g}, {}: lambda {:.6g} {}, mu {:.6g} {}",
                                          c.name, c.given.young, c.unit, c.given.poisson, plane_text(c.plane),
                                          c.moduli.lambda, c.unit, c.moduli.mu, c.unit));
    ++shown;
  }
}

void add_measured(const rheo::MeasuredMaterial& m, Rows& rows) {
  const bool sweep = !m.sweep.empty();
  rows.emplace_back("data",
                    fmt::format("{}: {} points, {} modulus{}; poisson = {:g}, {}", m.file,
                                sweep ? m.sweep.size() : m.relaxation.size(),
                                m.modulus == rheo::MeasuredModulus::young ? "Young's" : "shear",
                                sweep ? " over frequency" : " over time", m.poisson, plane_text(m.plane)));
  const rheo::PronySeries& series = m.fit.series;
  std::string parts =
      fmt::format("{} relaxing term{}", series.terms.size(), series.terms.size() == 1 ? "" : "s");
  if (series.elastic > 0.0) parts += fmt::format(", elastic {:.4g} Pa", series.elastic);
  if (series.viscous > 0.0) parts += fmt::format(", viscous {:.4g} Pa s", series.viscous);
  rows.emplace_back(
      "fit", fmt::format("{}; error {:.2g} % root mean square, {:.2g} % at most (at {:.4g} {}), {}", parts,
                         100.0 * m.fit.rms, 100.0 * m.fit.largest, m.fit.largest_at, sweep ? "Hz" : "s",
                         m.weights == rheo::FitWeights::relative ? "relative to each value"
                                                                 : "relative to the largest"));
}

void add_part(const char* name, const rheo::Moduli& part, const char* unit, Rows& rows) {
  if (part.lambda != 0.0 || part.mu != 0.0)
    rows.emplace_back(name, fmt::format("lambda {:g} {}, mu {:g} {}", part.lambda, unit, part.mu, unit));
}

}  // namespace

Rows material_rows(const rheo::Material& material, const rheo::MaterialOrigin& origin) {
  Rows rows;
  add_preset(origin, rows);
  add_conversions(origin, rows);
  if (origin.measured) add_measured(*origin.measured, rows);
  for (std::size_t k = 0; k < material.branch_count(); ++k) {
    const rheo::MaxwellBranch b = material.branch(k);
    const bool others = material.elastic.lambda > 0.0 || material.elastic.mu > 0.0 ||
                        material.viscous.lambda > 0.0 || material.viscous.mu > 0.0;
    if (b.lambda_ela == 0.0 && b.mu_ela == 0.0 && others) continue;
    const std::string number = material.branch_count() == 1 ? "" : fmt::format(" {}", k + 1);
    rows.emplace_back("lambda" + number, branch_text(b.lambda_ela, b.lambda_vis, b.lambda_rate()));
    rows.emplace_back("mu" + number, branch_text(b.mu_ela, b.mu_vis, b.mu_rate()));
  }
  add_part("elastic", material.elastic, "Pa", rows);
  add_part("viscous", material.viscous, "Pa s", rows);
  return rows;
}

}  // namespace app
