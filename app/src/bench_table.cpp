#include "bench_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "option_values.hpp"

namespace app {
namespace {

// The advice keeps clear of what the reference cannot tell.
constexpr double clear_of_uncertainty = 3.0;

// Of the rows that reach the error the one of the least median. Rows of which a run took no longer than that
// cannot be told from it: of these the one of the fewest force evaluations, which is no matter of chance.
const Row* fastest_within(const std::vector<Row>& rows, double wanted) {
  const Row* fastest = nullptr;
  for (const Row& row : rows)
    if (row.error <= wanted && (fastest == nullptr || row.median() < fastest->median())) fastest = &row;
  if (fastest == nullptr) return nullptr;
  const Row* best = fastest;
  for (const Row& row : rows) {
    if (row.error <= wanted && std::ranges::min(row.seconds) <= fastest->median() &&
        row.force_evaluations < best->force_evaluations)
      best = &row;
  }
  return best;
}

std::string advice_for(const char* name, const std::vector<Row>& rows, const Reference& reference) {
  const double wanted = std::stod(name);
  const std::string target = fmt::format("for {} ", name);
  const bool unsure = clear_of_uncertainty * reference.uncertainty > wanted;
  if (unsure && (reference.claimed == 0.0 || clear_of_uncertainty * reference.claimed > wanted))
    return target +
           fmt::format("nothing can be said (the exact solution is known to {:.1e})", reference.uncertainty);
  const Row* const best = fastest_within(rows, wanted);
  if (best != nullptr)
    return target + fmt::format("use {} ({:.2g} s{})", options_of(best->setting), best->median(),
                                unsure ? fmt::format("; by its tolerance: the exact solution was checked to "
                                                     "{:.1e} only",
                                                     reference.uncertainty)
                                       : "");
  const auto closest = std::ranges::min_element(rows, {}, &Row::error);
  return target + fmt::format("none of these will do (the closest, {}, reached {:.1e})",
                              options_of(closest->setting), closest->error);
}

}  // namespace

std::string csv_of(const std::vector<Row>& rows) {
  std::string csv = "integrator,kernel,threads,step,force_evaluations,seconds,error,tolerance\n";
  for (const Row& row : rows)
    csv += fmt::format("{},{},{},{:.17g},{},{:.6g},{:.6g},{}\n", name_of(row.setting.integrator), row.kernel,
                       row.threads, row.largest_step, row.force_evaluations, row.median(), row.error,
                       row.setting.tolerance > 0.0 ? fmt::format("{:g}", row.setting.tolerance) : "");
  return csv;
}

std::vector<std::string> table_of(const Rows& rows, const Reference& reference) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{:<12} {:<18} {:<8} {:>7} {:>11} {:>15} {:>9} {:>7}  {}", "integrator",
                              "setting", "kernel", "threads", "step [s]", "evaluations", "seconds", "spread",
                              "error"));
  bool marked = false;
  for (const Row& row : rows.rows) {
    const bool below = row.error < reference.uncertainty;
    marked = marked || below;
    lines.push_back(
        fmt::format("{:<12} {:<18} {:<8} {:>7} {:>11.4g} {:>15} {:>9.3g} {:>7}  {:.1e}{}",
                    name_of(row.setting.integrator), knob_of(row.setting), row.kernel, row.threads,
                    row.largest_step, row.force_evaluations, row.median(),
                    row.seconds.size() > 1 ? fmt::format("{:.0f} %", 100.0 * row.spread()) : "1 run",
                    row.error, below ? " *" : ""));
  }
  if (marked)
    lines.push_back(
        fmt::format("* within what the exact solution is known to, {:.1e}", reference.uncertainty));
  for (const std::string& forecast : rows.forecasts) lines.push_back("not measured: " + forecast);
  for (const LeftOut& left : rows.left_out)
    lines.push_back(fmt::format("left out: {}: {}", left.what, left.why));
  return lines;
}

std::string advice_of(const std::vector<Row>& rows, const Reference& reference) {
  if (ErrorMeter(reference.exact).nothing_moves())
    return "Nothing moves in this scene: any integrator and step will do.";
  if (rows.empty()) return "No advice: none of the runs was possible.";
  std::string advice;
  for (const char* const wanted : {"1e-3", "1e-6", "1e-9"})
    advice += (advice.empty() ? "Of these, " : "; ") + advice_for(wanted, rows, reference);
  return advice + ".";
}

}  // namespace app
