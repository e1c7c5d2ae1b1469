// The command bench: its table, CSV, picture and advice, against runs and an exact solution of the test's
// own.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.hpp"
#include "rheo/io/scene_file.hpp"
#include "rheo/simulation.hpp"
#include "support/exact.hpp"

namespace app_tests {
namespace {

using Json = nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* header = "integrator,kernel,threads,step,force_evaluations,seconds,error,tolerance";

struct CsvRow {
  std::string integrator, kernel;
  int threads = 0;
  double step = 0.0, evaluations = 0.0, seconds = 0.0, error = 0.0;
  std::string tolerance;  // empty: it has none
};

std::vector<CsvRow> rows_of(const std::string& csv) {
  const std::vector<std::string> lines = lines_of(csv);
  EXPECT_FALSE(lines.empty());
  if (lines.empty()) return {};
  EXPECT_EQ(lines[0], header);
  std::vector<CsvRow> rows;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    std::vector<std::string> cells;
    std::istringstream stream(lines[k]);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    if (lines[k].ends_with(',')) cells.emplace_back();
    EXPECT_EQ(cells.size(), 8u) << lines[k];
    if (cells.size() != 8) continue;
    rows.push_back({cells[0], cells[1], std::stoi(cells[2]), std::stod(cells[3]), std::stod(cells[4]),
                    std::stod(cells[5]), std::stod(cells[6]), cells[7]});
  }
  return rows;
}

std::vector<CsvRow> of(const std::vector<CsvRow>& rows, const std::string& integrator) {
  std::vector<CsvRow> found;
  for (const CsvRow& row : rows)
    if (row.integrator == integrator) found.push_back(row);
  return found;
}

class Bench : public ProgramTest {
 protected:
  Finished bench(const std::string& scene, std::vector<std::string> options = {}) {
    write("beam.toml", scene);
    options.insert(options.begin(), {"bench", "beam.toml", "-o", "b"});
    Finished finished = rheo(options);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.err, "");
    return finished;
  }
  std::vector<CsvRow> rows() const { return rows_of(read_text(folder() / "b/bench.csv")); }
  Json report() const { return Json::parse(read_text(folder() / "b/run.json")); }
};

std::string general_beam() {
  return small_beam() + "\n[[constraint]]\nterms = [[9, \"x\", 1.0], [4, \"x\", -1.0]]\n";
}

TEST_F(Bench, ErrorsAreThoseOfTheRunsAgainstAnExactSolution) {
  const Finished finished = bench(small_beam(), {"--budget", "10"});
  const std::vector<CsvRow> table = rows();
  const Json runs = report()["runs"];
  ASSERT_EQ(table.size(), runs.size());
  for (const char* name : {"exponential", "implicit", "rk4", "euler"})
    EXPECT_GE(of(table, name).size(), 2u) << name;

  const rheo::Scene scene = rheo::read_scene(folder() / "beam.toml");
  std::vector<double> times;
  for (std::int64_t k = 0; k < rheo::output_count(scene.time); ++k)
    times.push_back(rheo::output_time(scene.time, k));
  const auto exact = rheo::test::ExactSolution(scene).at(times);
  for (std::size_t k = 0; k < table.size(); ++k) {
    const std::string name = runs[k]["integrator"];
    EXPECT_EQ(name, table[k].integrator);
    if (table[k].error < 1e-10) continue;  // both yardsticks' rounding shows
    rheo::Scene again = scene;
    again.time.integrator = name == "rk4"        ? rheo::IntegratorKind::rk4
                            : name == "euler"    ? rheo::IntegratorKind::euler
                            : name == "implicit" ? rheo::IntegratorKind::implicit
                                                 : rheo::IntegratorKind::exponential;
    if (runs[k]["step_asked"].is_number()) again.time.step = runs[k]["step_asked"];
    EXPECT_EQ(table[k].tolerance.empty(), !runs[k]["tolerance"].is_number());
    if (!table[k].tolerance.empty()) {
      again.time.tolerance = std::stod(table[k].tolerance);
      EXPECT_EQ(again.time.tolerance, runs[k]["tolerance"]);
    }
    // A run is the same to the last bit, and the yardsticks agree to 1e-12.
    EXPECT_NEAR(rheo::test::run_error(exact, rheo::test::simulate(again, times)) / table[k].error, 1.0, 0.02)
        << name << " " << table[k].step;
    rheo::Simulation simulation(again);
    EXPECT_FALSE(simulation.advance(scene.time.duration));
    EXPECT_GT(table[k].seconds, 0.0);
    EXPECT_EQ(table[k].threads, simulation.threads());
    EXPECT_EQ(table[k].kernel, simulation.kernel());
  }
  EXPECT_THAT(finished.out,
              AllOf(HasSubstr("dense operator"), HasSubstr("--integrator"), HasSubstr("evaluations")));
}

TEST_F(Bench, FinerSettingsCostMoreAndErrLess) {
  bench(small_beam(), {"--budget", "10"});
  for (const char* name : {"exponential", "rk4", "euler"}) {
    const std::vector<CsvRow> found = of(rows(), name);
    for (std::size_t k = 1; k < found.size(); ++k) {
      EXPECT_GT(found[k].evaluations, found[k - 1].evaluations) << name;
      EXPECT_LT(found[k].error, found[k - 1].error) << name;
    }
  }
  // Classical orders between the finest two that rounding does not reach.
  const std::vector<CsvRow> rk4 = of(rows(), "rk4");
  std::size_t last = rk4.size() - 1;
  while (last > 1 && rk4[last].error < 1e-9) --last;
  EXPECT_NEAR(std::log(rk4[last - 1].error / rk4[last].error) / std::log(rk4[last - 1].step / rk4[last].step),
              4.0, 0.3);
}

double median_of(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  const std::size_t half = x.size() / 2;
  return x.size() % 2 == 1 ? x[half] : 0.5 * (x[half - 1] + x[half]);
}

TEST_F(Bench, AdvisesTheFastestThatReachesTheErrorAndOfEqualsTheLeastWork) {
  const Finished finished = bench(small_beam(), {"--budget", "10"});
  const Json json = report();
  const std::string advice = json["advice"];
  EXPECT_THAT(finished.out, HasSubstr(advice));
  for (const double wanted : {1e-3, 1e-6, 1e-9}) {
    double least = INFINITY;
    for (const Json& run : json["runs"])
      if (run["error"] <= wanted) least = std::min(least, median_of(run["seconds"]));
    // A run of theirs was as fast: chance alone tells them apart.
    const Json* best = nullptr;
    for (const Json& run : json["runs"]) {
      const std::vector<double> seconds = run["seconds"];
      if (run["error"] > wanted || *std::min_element(seconds.begin(), seconds.end()) > least) continue;
      if (best == nullptr || run["force_evaluations"] < (*best)["force_evaluations"]) best = &run;
    }
    ASSERT_NE(best, nullptr) << wanted;
    std::ostringstream text;
    text << "for "
         << (wanted == 1e-3   ? "1e-3"
             : wanted == 1e-6 ? "1e-6"
                              : "1e-9")
         << " use --integrator " << (*best)["integrator"].get<std::string>();
    if ((*best)["tolerance"].is_number())
      text << " --tolerance " << (*best)["tolerance"].get<double>();
    else
      text << " --step " << (*best)["step_asked"].get<double>();
    std::string expected = text.str();
    if (const std::size_t at = expected.find("e-0"); at != std::string::npos) expected.erase(at + 2, 1);
    EXPECT_THAT(advice, HasSubstr(expected));
  }
}

TEST_F(Bench, Rk4IsMeasuredAtTheFinestErrorOrSaidToBeExtrapolated) {
  for (const char* budget : {"1", "5"}) {
    const Finished finished = bench(small_beam(), {"--budget", budget, "--duration", "100", "--integrator",
                                                   "rk4", "--threads", "1", "--force"});
    double finest = INFINITY;
    for (const CsvRow& row : rows()) finest = std::min(finest, row.error);
    const Json forecasts = report()["forecasts"];
    EXPECT_EQ(forecasts.size(), finest > 1e-9 && finest <= 1e-4 ? 1u : 0u) << budget << ": " << finest;
    for (const Json& forecast : forecasts) {
      EXPECT_THAT(finished.out, HasSubstr("not measured: " + forecast.get<std::string>()));
      EXPECT_THAT(
          forecast.get<std::string>(),
          AllOf(StartsWith("rk4 --step "), HasSubstr("1e-9 would take about"), HasSubstr("by its order")));
    }
  }
}

TEST_F(Bench, TheAdviceCanBeTyped) {
  bench(small_beam(), {"--budget", "10"});
  const std::string advice = report()["advice"];
  std::istringstream words(advice.substr(advice.find("--integrator")));
  std::vector<std::string> options{"run", "beam.toml", "-o", "run"};
  for (std::string word; options.size() < 8 && words >> word;) options.push_back(word);
  EXPECT_EQ(rheo(options).exit_code, 0) << advice;
}

TEST_F(Bench, WritesItsFilesOnly) {
  const Finished finished = bench(small_beam(), {"--budget", "5"});
#ifdef RHEO_HAS_RENDERER
  EXPECT_THAT(files(), ElementsAre("b", "b/bench.csv", "b/bench.png", "b/run.json", "beam.toml"));
#else
  EXPECT_THAT(files(), ElementsAre("b", "b/bench.csv", "b/run.json", "beam.toml"));
  EXPECT_THAT(finished.out, HasSubstr("note: no picture: this build of rheo has no renderer"));
#endif
  EXPECT_THAT(finished.out, HasSubstr("b/bench.csv\n"));
}

TEST_F(Bench, TheDefaultFolderIsApartFromTheRuns) {
  write("beam.toml", small_beam());
  ASSERT_EQ(rheo({"run", "beam.toml"}).exit_code, 0);
  const Finished finished = rheo({"bench", "beam.toml", "--budget", "2", "--quiet"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(finished.out, "");
  EXPECT_THAT(files(), AllOf(Contains("out/beam/state.csv"), Contains("out/beam_bench/bench.csv")));
}

TEST_F(Bench, CsvGoesWhereItIsAsked) {
  bench(small_beam(), {"--budget", "2", "--csv", "table.csv"});
  EXPECT_THAT(files(), AllOf(Contains("table.csv"), Not(Contains("b/bench.csv")), Contains("b/run.json")));
  EXPECT_FALSE(rows_of(read_text(folder() / "table.csv")).empty());
}

TEST_F(Bench, ForceReplacesAnEarlierBenchAndKeepsOtherFiles) {
  bench(small_beam(), {"--budget", "2", "--csv", "table.csv"});
  write("b/thesis.tex", "years of work");
  const std::string before = read_text(folder() / "b/run.json");
  expect_failure(rheo({"bench", "beam.toml", "-o", "b"}), 2, {"b", "earlier run", "--force"});
  expect_failure(rheo({"bench", "beam.toml", "-o", "c", "--csv", "table.csv"}), 2,
                 {"--csv 'table.csv'", "--force"});
  EXPECT_EQ(read_text(folder() / "b/run.json"), before);
  EXPECT_EQ(
      rheo({"bench", "beam.toml", "-o", "b", "--force", "--budget", "2", "--csv", "table.csv"}).exit_code, 0);
  EXPECT_NE(read_text(folder() / "b/run.json"), before);
  EXPECT_EQ(read_text(folder() / "b/thesis.tex"), "years of work");
}

TEST_F(Bench, OneIntegratorAlone) {
  bench(small_beam(), {"--budget", "5", "--integrator", "rk4"});
  for (const CsvRow& row : rows()) EXPECT_EQ(row.integrator, "rk4");
  EXPECT_FALSE(rows().empty());
}

TEST_F(Bench, WhatWouldExceedTheBudgetIsLeftOutByName) {
  // Euler's steps of some 50 us: seconds, of a tenth that there is.
  const Finished finished =
      bench(small_beam(), {"--budget", "0.5", "--duration", "500", "--integrator", "euler"});
  EXPECT_TRUE(rows().empty());
  EXPECT_THAT(finished.out,
              AllOf(HasSubstr("left out: euler --step"), HasSubstr("--budget"), HasSubstr("No advice")));
  EXPECT_THAT(files(), Not(Contains("b/bench.png")));
  EXPECT_EQ(report()["left_out"].size(), 1u);
}

TEST_F(Bench, ALargerSceneIsComparedWithExponentialAndThatWithRk4) {
  std::string text = small_beam_with("nodes = [5, 2]", "nodes = [25, 7]");
  const Finished finished = bench(text, {"--budget", "10", "--integrator", "exponential"});
  EXPECT_THAT(finished.out, AllOf(HasSubstr("exact: integrator exponential at tolerance 1e-13"),
                                  HasSubstr("RK4 extrapolated from steps of"), HasSubstr("agrees to")));
  EXPECT_GE(rows().size(), 5u);
  for (const CsvRow& row : rows()) EXPECT_LT(row.error, 0.1);
}

TEST_F(Bench, GeneralConstraintsAreComparedWithoutExponential) {
  const Finished small = bench(general_beam(), {"--budget", "5"});
  EXPECT_THAT(small.out, AllOf(HasSubstr("exact: the exponential of the dense operator"),
                               HasSubstr("left out: exponential"), HasSubstr("[[constraint]]")));
  EXPECT_GE(of(rows(), "rk4").size(), 3u);
  std::string text = general_beam();
  text.replace(text.find("nodes = [5, 2]"), 14, "nodes = [17, 5]");
  const Finished large = bench(text, {"--budget", "10", "--force"});
  EXPECT_THAT(large.out,
              AllOf(HasSubstr("exact: RK4 extrapolated"), HasSubstr("from twice these steps agrees to")));
  EXPECT_GE(of(rows(), "rk4").size(), 2u);
}

TEST_F(Bench, EulerWithoutAStableStepIsALine) {
  std::string text = small_beam_with("lambda_vis = 4.0", "lambda_vis = inf");
  text.replace(text.find("mu_vis = 2.0"), 12, "mu_vis = inf");
  const Finished finished = bench(text, {"--budget", "5"});
  EXPECT_THAT(finished.out, HasSubstr("left out: euler: no step of it is stable here"));
  EXPECT_TRUE(of(rows(), "euler").empty());
}

TEST_F(Bench, ASceneWithoutMotionHasNoErrorAndSaysSo) {
  const Finished finished =
      bench(small_beam_with("vector = [5.0, 0.0]", "vector = [0.0, 0.0]"), {"--budget", "2"});
  for (const CsvRow& row : rows()) EXPECT_EQ(row.error, 0.0);
  EXPECT_THAT(finished.out, AllOf(HasSubstr("Nothing moves"), HasSubstr("no picture: no run has an error")));
}

TEST_F(Bench, ADurationShorterThanAnOutputIsMeasuredAtItsEnd) {
  const Finished finished = bench(small_beam(), {"--budget", "2", "--duration", "0.03"});
  EXPECT_THAT(finished.out, HasSubstr("errors are those at its end, t = 0.03 s"));
  EXPECT_GT(of(rows(), "rk4").front().error, 0.0);
}

TEST_F(Bench, RefusesBeforeAnythingIsWritten) {
  write("beam.toml", small_beam());
  write("constrained.toml", general_beam());
  const auto refused = [&](const std::vector<std::string>& arguments, const std::vector<std::string>& parts) {
    expect_failure(rheo(arguments), 2, parts);
  };
  refused({"bench", "beam.toml", "--budget", "0"}, {"--budget '0'", "seconds"});
  refused({"bench", "beam.toml", "--csv", ""}, {"--csv ''"});
  refused({"bench", "beam.toml", "--step", "0.1"}, {"'--step'", "rheo bench --help"});
  refused({"bench", "beam.toml", "--integrator", "rk5"}, {"--integrator 'rk5'"});
  refused({"bench", "constrained.toml", "--kernel", "edge"}, {"kernel edge needs"});
  expect_failure(rheo({"bench", "beam.toml", "--csv", "no/such/folder.csv"}), 4, {"no/such/folder.csv"});
  EXPECT_THAT(files(), ElementsAre("beam.toml", "constrained.toml"));
}

}  // namespace
}  // namespace app_tests
