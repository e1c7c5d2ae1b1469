// What a scene does not need is not done: the counters of run.json say so.
#include <gmock/gmock.h>

#include <cstdint>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace app_tests {
namespace {

class CountersOf : public ProgramTest {
 protected:
  // The counters of a run or rendering of a scene.
  nlohmann::json counters(const std::string& command, const std::string& scene,
                          std::vector<std::string> options = {}) {
    write("scene.toml", scene);
    options.insert(options.begin(), {command, "scene.toml", "-o", "r", "--force"});
    const Finished finished = rheo(options);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return nlohmann::json::parse(read_text(folder() / "r/run.json")).at("counters");
  }
  static std::int64_t of(const nlohmann::json& counters, const char* name) {
    return counters.at(name).get<std::int64_t>();
  }
};

constexpr std::int64_t nodes = 10, outputs = 11;

TEST_F(CountersOf, ARunComputesNoColoursAndDrawsNothing) {
  const auto c = counters("run", small_beam());
  for (const char* name : {"color_values", "frames_drawn", "frames_repeated", "mesh_uploads"})
    EXPECT_EQ(of(c, name), 0) << name;
}

TEST_F(CountersOf, ColoursAreComputedOnlyWhereShown) {
  EXPECT_EQ(of(counters("render", small_beam()), "color_values"), nodes * outputs);
  EXPECT_EQ(of(counters("render", small_beam(), {"--color", "none"}), "color_values"), 0);
  EXPECT_EQ(
      of(counters("render", small_beam_with("size = [320, 180]", "size = [320, 180]\ncolor = \"none\"")),
         "color_values"),
      0);
}

TEST_F(CountersOf, SolvesAreMadeOnlyWhereMassOrConstraintsNeedThem) {
  const auto plain = counters("run", small_beam());
  EXPECT_EQ(of(plain, "mass_solves"), 0);
  EXPECT_EQ(of(plain, "constraint_solves"), 0) << "fixed nodes are eliminated";
  const auto consistent =
      counters("run", small_beam_with("density = 0.2", "density = 0.2\nmass = \"consistent\""));
  EXPECT_GE(of(consistent, "mass_solves"), 4 * of(consistent, "steps"));
  EXPECT_EQ(of(consistent, "constraint_solves"), 0);
  const auto general = counters(
      "run", small_beam() + "\n[[constraint]]\nterms = [[9, \"x\", 1.0], [4, \"x\", -1.0]]\nvalue = 0.0\n");
  EXPECT_GE(of(general, "constraint_solves"), 4 * of(general, "steps"));
  EXPECT_EQ(of(general, "mass_solves"), 0);
}

TEST_F(CountersOf, EnergiesAndNormsAreLookedAtOnlyWhereAskedFor) {
  const std::vector<std::string> fine{"--step", "1e-4"};
  const auto with = counters("run", small_beam(), fine);
  EXPECT_GE(of(with, "energy_samples"), of(with, "steps")) << "work and dissipation are sums over the steps";
  EXPECT_EQ(of(with, "norms"), 2 * outputs) << "of w_lambda and w_mu, whatever the number of steps";
  const auto without = counters("run", small_beam(), {"--step", "1e-4", "--no-energies"});
  EXPECT_EQ(of(without, "steps"), of(with, "steps"));
  // At each output, at the event at 0.2 s (at an output too), and every 16th step, which guards against
  // divergence.
  EXPECT_LE(of(without, "energy_samples"), of(without, "steps") / 16 + outputs + 1);
  EXPECT_GE(of(without, "energy_samples"), outputs);
}

TEST_F(CountersOf, FramesOfABodyThatStandsStillAreDrawnOnce) {
  // Nothing moves for 5 of 11 outputs, the last of them at 0.2 s; the arrow of the load is there from 0.2 s
  // on.
  const std::string late = small_beam_with("until = 0.2", "from = 0.2\nuntil = 9");
  const auto c = counters("render", late);
  EXPECT_EQ(of(c, "frames_drawn") + of(c, "frames_repeated"), outputs);
  EXPECT_EQ(of(c, "frames_repeated"), 2) << "of four alike the first is drawn, the second kept";
  EXPECT_GT(of(c, "steps_at_rest"), 0);
  const auto still = counters("render", small_beam_with("vector = [5.0, 0.0]", "vector = [0.0, 0.0]"));
  EXPECT_EQ(of(still, "frames_drawn"), 2);
  EXPECT_EQ(of(still, "frames_repeated"), outputs - 2);
  EXPECT_EQ(of(still, "mesh_uploads"), 1) << "frames and sheet show one shape";
  EXPECT_EQ(of(still, "force_evaluations"), 0);
}

#if defined(__x86_64__) && defined(__GNUC__)
TEST_F(CountersOf, EveryStepTakesDenormalNumbersForZero) {
  for (const std::string integrator : {"rk4", "exponential", "implicit"}) {
    const auto c = counters("run", small_beam(), {"--integrator", integrator});
    EXPECT_GT(of(c, "steps"), 0);
    EXPECT_EQ(of(c, "flushed_steps"), of(c, "steps")) << integrator;
  }
}
#endif

// The material's numbers beside the steps: residual forces advanced, lambda and mu of each branch.
TEST_F(CountersOf, BranchesAndDisplacementsAreAdvancedOnlyWhereNeeded) {
  const auto both = counters("run", small_beam());
  EXPECT_EQ(of(both, "branch_updates"), 2 * of(both, "force_evaluations"));
  EXPECT_EQ(of(both, "displacement_updates"), of(both, "steps")) << "nothing feeds on u";
  const auto no_mu = counters("run", small_beam_with("mu_ela = 5.0", "mu_ela = 0.0"));
  EXPECT_EQ(of(no_mu, "branch_updates"), of(no_mu, "force_evaluations"));
  const auto one_rate = counters("run", small_beam_with("mu_vis = 2.0", "mu_vis = 2.857142857142857"));
  EXPECT_EQ(of(one_rate, "branch_updates"), of(one_rate, "force_evaluations"));
  const auto elastic =
      counters("run", small_beam_with("lambda_vis = 4.0\nmu_vis = 2.0", "lambda_vis = inf\nmu_vis = inf"));
  EXPECT_EQ(of(elastic, "branch_updates"), 0);
}

// Equation (4) is solved only where constraints do not hold identically: Baumgarte's terms go with it.
TEST_F(CountersOf, BaumgartesTermsAreLeftOutWhereTheConstraintHoldsIdentically) {
  const std::string for_all = "[time]\nconstraints = \"baumgarte\"";
  EXPECT_EQ(of(counters("run", small_beam()), "constraint_solves"), 0);
  const auto all = counters("run", small_beam_with("[time]", for_all));
  EXPECT_GE(of(all, "constraint_solves"), 4 * of(all, "steps"));
  EXPECT_GT(of(all, "displacement_updates"), of(all, "steps")) << "its terms feed on u";
}

TEST_F(CountersOf, ABodyAtRestUnderItsWeightTakesNoSteps) {
  std::string springy = small_beam_with("lambda_vis = 4.0\nmu_vis = 2.0",
                                        "lambda_vis = 0.7\nmu_vis = 0.5\nelastic.lambda = 20.0\n"
                                        "elastic.mu = 15.0\nviscous.lambda = 1.0\nviscous.mu = 1.0");
  springy.replace(springy.find("\"left\""), 6, "\"bottom\"");
  const auto c =
      counters("run", springy + "\n[body_force]\nacceleration = [0.0, -1.0]\n", {"--duration", "20"});
  EXPECT_GT(of(c, "steps_at_rest"), of(c, "steps") / 20);
}

TEST_F(CountersOf, AMeshThatMovesIsUploadedOnceAFrame) {
  const auto c = counters("render", small_beam());
  EXPECT_EQ(of(c, "frames_drawn"), outputs);
  EXPECT_EQ(of(c, "frames_repeated"), 0);
  // Once a frame; the sheet shows 11 of the shapes again, the first of them after the last frame's.
  EXPECT_LE(of(c, "mesh_uploads"), 2 * outputs);
  EXPECT_GE(of(c, "mesh_uploads"), outputs);
}

}  // namespace
}  // namespace app_tests
