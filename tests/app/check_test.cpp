// The command check: what a scene is and what it would cost, without a run.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <string>

#include "program.hpp"
#include "rheo/scene.hpp"

namespace app_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

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
  EXPECT_EQ(row(finished.out, "frames"), "11 with render, one an output");
  EXPECT_THAT(row(finished.out, "omega_max"), HasSubstr("rad/s"));
  EXPECT_THAT(row(finished.out, "step"), HasSubstr("auto: a quarter of the stable step"));
  EXPECT_THAT(row(finished.out, "cost"), HasSubstr("forecast"));
  EXPECT_THAT(row(finished.out, "memory"), HasSubstr("MB"));
}

// The first scene that a reader copies.
TEST_F(Check, AcceptsTheScenesOfTheReadme) {
  std::ifstream file(RHEO_SOURCE_DIR "/README.md");
  std::string line, scene;
  int scenes = 0;
  for (bool inside = false; std::getline(file, line);) {
    if (inside && line == "```") {
      inside = false;
      if (scene.find("[mesh]") == std::string::npos) continue;  // a part of one
      write("readme.toml", scene);
      const Finished finished = rheo({"check", "readme.toml"});
      EXPECT_EQ(finished.exit_code, 0) << finished.err << scene;
      ++scenes;
    } else if (inside) {
      scene += line + "\n";
    } else if (line == "```toml") {
      inside = true;
      scene.clear();
    }
  }
  EXPECT_GE(scenes, 1);
}

TEST_F(Check, TellsTheMaterialsPartsAndConversions) {
  write("beam.toml", small_beam_with("density = 0.2",
                                     "density = 0.2\npoisson = 0.25\nplane = \"stress\"\n"
                                     "[material.elastic]\nyoung = 3\n"
                                     "[material.viscous]\nlambda = 0\nmu = 0.5\n"
                                     "[[material.maxwell]]\nlambda_ela = 0\nmu_ela = 2\n"
                                     "lambda_vis = inf\nmu_vis = inf"));
  const Finished finished = rheo({"check", "beam.toml"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(row(finished.out, "from"),
            "[material.elastic] young = 3 Pa, poisson = 0.25, plane stress: lambda 0.8 Pa, mu 1.2 Pa");
  EXPECT_EQ(row(finished.out, "lambda 1"), "7 Pa, 4 Pa s (relaxation time 0.5714 s)");
  EXPECT_EQ(row(finished.out, "lambda 2"), "off");
  EXPECT_EQ(row(finished.out, "mu 2"), "2 Pa, never relaxes");
  EXPECT_EQ(row(finished.out, "elastic"), "lambda 0.8 Pa, mu 1.2 Pa");
  EXPECT_EQ(row(finished.out, "viscous"), "lambda 0 Pa s, mu 0.5 Pa s");
}

TEST_F(Check, TellsAPresetsCircuitAndSource) {
  write("beam.toml", small_beam_with("density = 0.2",
                                     "density = 0.2\npreset = \"zener\"\n"
                                     "lambda_elastic = 1\nmu_elastic = 2"));
  const Finished finished = rheo({"check", "beam.toml"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(row(finished.out, "preset"),
            "zener: (ela - vis) | elastic; Zener, Elasticity and Anelasticity of Metals, 1948");
  EXPECT_EQ(row(finished.out, "elastic"), "lambda 1 Pa, mu 2 Pa");
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

// Two materials on too many triangles for all eigenvalues; the same limit whatever the scene's own
// integrator, and a run's.
TEST_F(Check, EulersLimitOnALargerBodyIsKnown) {
  std::string text = small_beam_with("nodes = [5, 2]", "nodes = [25, 9]");
  text +=
      "[[region]]\nname = \"half\"\nbox = [0.0, 0.0, 0.5, 1.0]\n[region.material]\n"
      "lambda_ela = 3.0\nmu_ela = 4.0\nlambda_vis = 100.0\nmu_vis = 2.0\ndensity = 0.3\n";
  write("two.toml", text);
  const Finished finished = rheo({"check", "two.toml"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  const std::string limit = row(finished.out, "stable euler");
  EXPECT_THAT(limit, Not(HasSubstr("at least"))) << finished.out;
  EXPECT_EQ(row(rheo({"check", "two.toml", "--integrator", "euler"}).out, "stable euler"), limit);
  EXPECT_EQ(row(rheo({"check", "two.toml", "--integrator", "euler", "--step", "1e-9"}).out, "stable euler"),
            limit);
  const Finished refused = rheo(
      {"run", "two.toml", "--integrator", "euler", "--step", fmt::format("{:.6g}", 1.01 * std::stod(limit))});
  expect_failure(refused, 2, {"beyond the largest stable step of euler, " + limit});
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

TEST_F(Check, CountsTheFramesOfEveryNthOutputAndWhatTheyKeep) {
  const auto check = [&](const std::string& every) {
    write("beam.toml", small_beam_with("[render]", "[render]\nevery = " + every));
    const Finished finished = rheo({"check", "beam.toml", "--frame-rate", "2000"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return finished.out;
  };
  // Before "MB more": 12 bytes a node and frame, and as much for each shape that a sheet may have.
  const auto kept = [](const std::string& out) {
    const std::string memory = row(out, "memory");
    return std::stod(memory.substr(memory.find("up to ") + 6));
  };
  const std::string all = check("1"), some = check("7");
  EXPECT_EQ(row(all, "frames"), "1001 with render, one an output");
  EXPECT_EQ(row(some, "frames"), "144 with render, one every 7 outputs and the last");
  EXPECT_NEAR(kept(all), 1001 * 120e-6, 1e-3);
  EXPECT_NEAR(kept(some), (144 + ::rheo::most_sheet_times) * 120e-6, 1e-4);
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

// A relaxation time of 1e-5 s where vibrations would allow steps of a hundredth of a second.
TEST_F(Check, AdvisesWhereRelaxationAloneMakesStepsShort) {
  const std::string fast =
      small_beam_with("lambda_vis = 4.0\nmu_vis = 2.0", "lambda_vis = 7e-5\nmu_vis = 5e-5");
  write("fast.toml", fast);
  const Finished finished = rheo({"check", "fast.toml"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(row(finished.out, "advice"),
              testing::AllOf(HasSubstr("relaxation alone makes explicit steps so short"),
                             HasSubstr("--integrator exponential or implicit")));
  EXPECT_THAT(rheo({"check", "fast.toml", "--integrator", "exponential"}).out,
              testing::Not(HasSubstr("advice")));
  write("viscous.toml", small_beam() + "\n[material.viscous]\nlambda = 10.0\nmu = 5.0\n");
  EXPECT_THAT(row(rheo({"check", "viscous.toml", "--duration", "5"}).out, "advice"),
              HasSubstr("viscous part or relaxation alone"));
  write("beam.toml", small_beam());
  EXPECT_THAT(rheo({"check", "beam.toml"}).out, testing::Not(HasSubstr("advice")));
}

TEST_F(Check, TellsOfAMaterialThatResistsNothing) {
  write("dust.toml", small_beam_with("lambda_ela = 7.0\nmu_ela = 5.0", "lambda_ela = 0.0\nmu_ela = 0.0"));
  EXPECT_THAT(rheo({"check", "dust.toml"}).out, HasSubstr("resists nothing"));
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

TEST_F(Check, SaysThatNothingMoves) {
  write("rest.toml", small_beam_with("vector = [5.0, 0.0]", "vector = [0.0, 0.0]"));
  const Finished finished = rheo({"check", "rest.toml", "--step", "1e-3"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(row(finished.out, "cost"),
              HasSubstr("nothing moves and nothing acts, all 500 steps are skipped"));
  // A load later on: what is timed is what it costs.
  write("late.toml", small_beam_with("until = 0.2", "from = 0.3\nuntil = 0.4"));
  EXPECT_THAT(row(rheo({"check", "late.toml", "--step", "1e-3"}).out, "cost"), HasSubstr("forecast"));
}

TEST_F(Check, TellsOfNodesWithoutATriangle) {
  fs::copy_file(RHEO_SOURCE_DIR "/tests/data/msh/all41.msh", folder() / "plate.msh");
  std::string text = small_beam_with("shape = \"rectangle\"", "file = \"plate.msh\"");
  for (const char* line : {"size = [1.0, 0.25]\n", "nodes = [5, 2]\n"})
    text.erase(text.find(line), std::string(line).size());
  for (const char* group : {"\"left\"", "\"right\""})
    for (std::size_t at; (at = text.find(group)) != std::string::npos;)
      text.replace(at, std::string(group).size(), "\"boundary\"");
  write("plate.toml", text);
  const char* note = "note: 1 node without a triangle was left out: tag 6";
  const Finished check = rheo({"check", "plate.toml"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr(note));
  const Finished run = rheo({"run", "plate.toml"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr(note));
}

// The scene's and the mesh's names, and the path itself.
TEST_F(Check, LetsNoControlCharacterReachTheTerminal) {
  const char* const scene = "be\x1b[31mam.toml";
  write(scene, small_beam_with("title = \"Small beam\"", "title = \"\\u001b[31mred\\nline2 \\u009b1m\"") +
                   "\n[edges]\n\"g\\u0007\" = [[4, 9]]\n");
  const auto expect_clean = [](const std::string& out) {
    for (const char c : out) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n') << out;
    EXPECT_THAT(out, testing::Not(HasSubstr("\xC2\x9B")));
  };
  const Finished check = rheo({"check", scene});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  expect_clean(check.out);
  EXPECT_EQ(lines_of(check.out)[0], "be\\x1B[31mam.toml: \\x1B[31mred\\x0Aline2 \\xC2\\x9B1m");
  EXPECT_THAT(row(check.out, "edge groups"), HasSubstr("g\\x07 (1)"));
  const Finished run = rheo({"run", scene});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  expect_clean(run.out);
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
