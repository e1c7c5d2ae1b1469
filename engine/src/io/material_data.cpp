#include "io/material_data.hpp"

#include <fmt/format.h>

#include "io/table_file.hpp"
#include "rheo/error.hpp"
#include "rheo/limits.hpp"

namespace rheo {
namespace {

constexpr double poor_fit = 0.1;  // error, root mean square

// A negative time or frequency <= 0, with its line.
void check_abscissa(const NumberTable& table, const std::string& name, DataKind kind) {
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const double x = table.rows[i][0];
    if (x > 0.0 || (x == 0.0 && kind == DataKind::relaxation)) continue;
    throw Error(Error::Kind::input,
                fmt::format("{}:{}: {}", name, table.lines[i],
                            kind == DataKind::relaxation
                                ? fmt::format("time {:g}: a number >= 0 (s) is needed", x)
                                : fmt::format("frequency {:g}: a number > 0 (Hz) is needed", x)));
  }
}

Moduli moduli_for(const MeasuredMaterial& measured, double modulus) {
  const double young =
      measured.modulus == MeasuredModulus::young ? modulus : 2.0 * (1.0 + measured.poisson) * modulus;
  return moduli_of({young, measured.poisson}, measured.plane);
}

// What is too weak for a number of a scene is nothing; what is too large is left to Material::validate.
MaxwellBranch branch_of(const Moduli& ela, double time) {
  MaxwellBranch b;
  const auto set = [&](double modulus, double& to_ela, double& to_vis) {
    if (modulus < smallest_size) return;
    to_ela = modulus;
    to_vis = modulus * time;
  };
  set(ela.lambda, b.lambda_ela, b.lambda_vis);
  set(ela.mu, b.mu_ela, b.mu_vis);
  return b;
}

Moduli part_of(const Moduli& part) {
  return {part.lambda < smallest_size ? 0.0 : part.lambda, part.mu < smallest_size ? 0.0 : part.mu};
}

}  // namespace

void fit_data(const std::filesystem::path& file, DataKind kind, const PronyOptions& options,
              MeasuredMaterial& measured, MemoryBudget& memory) {
  const bool sweep = kind == DataKind::sweep;
  const NumberTable table = sweep ? read_table(file, 3, "frequency, storage, loss", memory)
                                  : read_table(file, 2, "time, modulus", memory);
  measured.file = file.string();
  check_abscissa(table, measured.file, kind);
  for (const std::vector<double>& row : table.rows) {
    if (sweep)
      measured.sweep.push_back({row[0], row[1], row[2]});
    else
      measured.relaxation.push_back({row[0], row[1]});
  }
  try {
    measured.fit = sweep ? fit_sweep(measured.sweep, options) : fit_relaxation(measured.relaxation, options);
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}: {}", measured.file, error.what()));
  }
}

void set_series(const MeasuredMaterial& measured, Material& material) {
  const PronySeries& series = measured.fit.series;
  for (std::size_t k = 0; k < series.terms.size(); ++k) {
    const MaxwellBranch b = branch_of(moduli_for(measured, series.terms[k].modulus), series.terms[k].time);
    if (k > 0) {
      material.more_branches.push_back(b);
      continue;
    }
    material.lambda_ela = b.lambda_ela;
    material.mu_ela = b.mu_ela;
    material.lambda_vis = b.lambda_vis;
    material.mu_vis = b.mu_vis;
  }
  material.elastic = part_of(moduli_for(measured, series.elastic));
  material.viscous = part_of(moduli_for(measured, series.viscous));
}

std::string doubt_about(const MeasuredMaterial& measured) {
  if (measured.fit.rms <= poor_fit) return {};
  return fmt::format("the fit is poor, off by {:.0f} % (root mean square){}; look at it: rheo check --plot",
                     100.0 * measured.fit.rms,
                     measured.weights == FitWeights::relative
                         ? "; where the modulus sinks into noise, weights = \"absolute\" serves better"
                         : "");
}

}  // namespace rheo
