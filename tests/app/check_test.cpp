// The command check: what a scene is and what it would cost, without a run.
#include <gmock/gmock.h>

#include "program.hpp"

namespace app_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Check : public ProgramTest {};

// The text after a row's name.
std::string row(const std::string& out, const std::string& name) {
  for (const std::string& line : lines_of(out))
    if (line.starts_with("  " + name + " ")) return line.substr(line.find_first_not_of(' ', 2 + name.size()));
  ADD_FAILURE() << "no row '" << name << "' in\n" << out;
  return "";
}

TEST_F(Check, TellsSizesMaterialLoadsAndSteps) {
  write("beam.toml", small_beam());
  const Finished finished = rheo({"check", "beam.toml"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(finished.err, "");
  EXPECT_THAT(finished.out, HasSubstr("Small beam"));
  EXPECT_EQ(row(finished.out, "mesh"), "10 nodes, 8 triangles, 10 boundary edges");
  for (const char* group : {"left (1)", "right (1)", "top (4)", "bottom (4)", "boundary (10)"})
    EXPECT_THAT(row(finished.out, "edge groups"), HasSubstr(group));
  EXPECT_EQ(row(finished.out, "area"), "0.25 m^2, thickness 1 m");
  EXPECT_EQ(row(finished.out, "lambda"), "7 Pa, 4 Pa s (relaxation time 0.5714 s)");
  EXPECT_EQ(row(finished.out, "mu"), "5 Pa, 2 Pa s (relaxation time 0.4 s)");
  EXPECT_EQ(row(finished.out, "mass"), "0.05 kg (lumped), density 0.2 kg/m^3");
  EXPECT_EQ(row(finished.out, "fix"), "2 nodes, x and y, from 0 s on");
  EXPECT_EQ(row(finished.out, "traction"), "1 edge, (5, 0) Pa, from 0 s until 0.2 s");
  EXPECT_EQ(row(finished.out, "probe"), "grip: 2 nodes");
  EXPECT_EQ(row(finished.out, "outputs"), "11 at 20 per second");
  EXPECT_THAT(row(finished.out, "omega_max"), HasSubstr("rad/s"));
  EXPECT_THAT(row(finished.out, "step"), HasSubstr("auto: a quarter of the stable step"));
  EXPECT_THAT(row(finished.out, "cost"), HasSubstr("forecast"));
  EXPECT_THAT(row(finished.out, "memory"), HasSubstr("MB"));
}

TEST_F(Check, AutoIsAQuarterOfTheStableStep) {
  write("beam.toml", small_beam());
  const Finished finished = rheo({"check", "beam.toml"});
  const double stable = std::stod(row(finished.out, "stable rk4")),
               used = std::stod(row(finished.out, "step"));
  // "At most": a step that divides the intervals may be smaller.
  EXPECT_LE(used, 0.25 * stable * (1.0 + 1e-5));
  EXPECT_GT(used, 0.12 * stable);
}

TEST_F(Check, SaysThatEulerHasNoStableStepWithoutDamping) {
  std::string text = small_beam_with("lambda_vis = 4.0", "lambda_vis = inf");
  text.replace(text.find("mu_vis = 2.0"), 12, "mu_vis = inf");
  write("elastic.toml", text);
  const Finished finished = rheo({"check", "elastic.toml"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(row(finished.out, "stable euler"), "none: undamped");
  EXPECT_EQ(row(finished.out, "mu"), "5 Pa, never relaxes");
}

TEST_F(Check, ReportsBeforeItRefusesAStepBeyondTheLimit) {
  write("beam.toml", small_beam());
  const Finished finished = rheo({"check", "beam.toml", "--step", "0.5"});
  expect_failure(finished, 2, {"0.5", "stable step", "--allow-unstable"});
  EXPECT_THAT(row(finished.out, "step"), HasSubstr("beyond the stable step"));
  EXPECT_THAT(row(finished.out, "stable rk4"), HasSubstr(" s"));
  EXPECT_THAT(row(finished.out, "cost"), HasSubstr("would be refused"));
  EXPECT_THAT(row(finished.out, "memory"), HasSubstr("MB"));
  EXPECT_EQ(rheo({"run", "beam.toml", "--step", "0.5"}).err, finished.err);
}

TEST_F(Check, ReportsBeforeItRefusesEulerWithoutDamping) {
  std::string text = small_beam_with("lambda_vis = 4.0", "lambda_vis = inf");
  text.replace(text.find("mu_vis = 2.0"), 12, "mu_vis = inf");
  write("elastic.toml", text);
  const Finished finished = rheo({"check", "elastic.toml", "--integrator", "euler"});
  expect_failure(finished, 2, {"no step of", "rk4"});
  EXPECT_EQ(row(finished.out, "integrator"), "euler");
  EXPECT_THAT(row(finished.out, "step"), HasSubstr("none: no step of euler"));
  EXPECT_THAT(row(finished.out, "outputs"), HasSubstr("11"));
  EXPECT_EQ(rheo({"run", "elastic.toml", "--integrator", "euler"}).err, finished.err);
}

TEST_F(Check, ForecastsNothingOfARunThatDiverges) {
  write("beam.toml", small_beam());
  const Finished finished =
      rheo({"check", "beam.toml", "--step", "0.5", "--duration", "500", "--allow-unstable"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(row(finished.out, "cost"), HasSubstr("diverges"));
}

TEST_F(Check, TakesOverrides) {
  write("beam.toml", small_beam());
  const Finished finished =
      rheo({"check", "beam.toml", "--step", "0.001", "--duration", "2", "--frame-rate", "10"});
  EXPECT_EQ(row(finished.out, "outputs"), "21 at 10 per second");
  EXPECT_THAT(row(finished.out, "steps"), HasSubstr("2000 in 2 s"));
}

TEST_F(Check, KnowsNoStableLimitOfTheExponentialIntegrator) {
  write("beam.toml", small_beam());
  const Finished finished = rheo(
      {"check", "beam.toml", "--integrator", "exponential", "--tolerance", "1e-7", "--frame-rate", "10"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(row(finished.out, "integrator"), "exponential");
  EXPECT_EQ(row(finished.out, "tolerance"), "1e-07");
  EXPECT_EQ(row(finished.out, "step"), "auto: one an interval between events and outputs");
  EXPECT_EQ(row(finished.out, "steps"), "5 in 0.5 s");
  EXPECT_THAT(row(finished.out, "cost"), HasSubstr("forecast"));
}

TEST_F(Check, TellsTheImplicitIntegratorsFactor) {
  write("beam.toml", small_beam());
  const Finished finished = rheo({"check", "beam.toml", "--integrator", "implicit", "--frame-rate", "10"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(row(finished.out, "integrator"), "implicit");
  EXPECT_EQ(row(finished.out, "kernel"), "csr");
  EXPECT_EQ(row(finished.out, "step"), "auto: one an interval between events and outputs");
  EXPECT_THAT(row(finished.out, "factor"), HasSubstr("MB for each step size"));
  EXPECT_THAT(row(finished.out, "cost"), HasSubstr("forecast"));
}

TEST_F(Check, SaysWhatAnAccuracyComesTo) {
  write("beam.toml", small_beam());
  const Finished free = rheo({"check", "beam.toml", "--accuracy", "1e-6"});
  EXPECT_EQ(free.exit_code, 0) << free.err;
  EXPECT_EQ(row(free.out, "integrator"), "exponential");
  EXPECT_THAT(row(free.out, "accuracy"), HasSubstr("1e-06 asked for: exponential (the cheapest"));
  const Finished rk4 = rheo({"check", "beam.toml", "--accuracy", "1e-6", "--integrator", "rk4"});
  EXPECT_EQ(row(rk4.out, "integrator"), "rk4");
  EXPECT_THAT(row(rk4.out, "accuracy"), HasSubstr("estimated error"));
  EXPECT_THAT(row(rk4.out, "step"), HasSubstr("for the accuracy"));
}

TEST_F(Check, WritesNothing) {
  write("beam.toml", small_beam());
  EXPECT_EQ(rheo({"check", "beam.toml"}).exit_code, 0);
  EXPECT_THAT(files(), ElementsAre("beam.toml"));
}

TEST_F(Check, AcceptsAllShippedScenes) {
  int scenes = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(RHEO_SOURCE_DIR "/app/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const Finished finished = rheo({"check", entry.path().string()});
    EXPECT_EQ(finished.exit_code, 0) << entry.path() << ": " << finished.err;
    ++scenes;
  }
  EXPECT_GE(scenes, 1);
}

}  // namespace
}  // namespace app_tests
