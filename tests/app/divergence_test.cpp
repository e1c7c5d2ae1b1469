// A step beyond the stable limit: refused; where it is allowed, noticed, told, and no garbage written.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace app_tests {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class Divergence : public ProgramTest {
 protected:
  // One output a second leaves the step of half a second alone; the beam's stable step is some hundredths.
  Finished diverge(const std::string& command, std::vector<std::string> more = {}) {
    write("beam.toml", small_beam());
    std::vector<std::string> words{command,        "beam.toml", "-o",         "r",   "--step",          "0.5",
                                   "--frame-rate", "1",         "--duration", "100", "--allow-unstable"};
    words.insert(words.end(), more.begin(), more.end());
    return rheo(words);
  }
};

TEST_F(Divergence, EndsWithExitCodeThreeAndOneLineThatNamesTheNodeAndTheStableStep) {
  const Finished finished = diverge("run");
  expect_failure(finished, 3, {"diverged at t = ", " at node ", "x = ", "stable step", "--step"});
}

TEST_F(Divergence, IsSaidEvenWhenQuiet) {
  const Finished finished = diverge("run", {"--quiet"});
  expect_failure(finished, 3, {"diverged"});
  EXPECT_EQ(finished.out, "");
}

TEST_F(Divergence, LeavesOnlyFiniteNumbersAndNoState) {
  diverge("run", {"--vtu"});
  EXPECT_THAT(files(), AllOf(Contains("r/history.csv"), Contains("r/run.json"), Not(Contains("r/state.csv")),
                             Not(Contains(HasSubstr(".part")))));
  const auto history = read_table(folder() / "r/history.csv");  // checks that all are finite
  EXPECT_GE(history.at("t").size(), 1u);
  for (const std::string& name : files()) {
    if (!fs::is_regular_file(folder() / name) || name.ends_with(".toml")) continue;
    const std::string text = read_text(folder() / name);
    EXPECT_THAT(text, Not(AnyOf(HasSubstr("nan"), HasSubstr("inf,"), HasSubstr("NaN")))) << name;
  }
}

TEST_F(Divergence, IsInRunJson) {
  diverge("run");
  const auto json = nlohmann::json::parse(read_text(folder() / "r/run.json"));
  EXPECT_EQ(json.at("exit_status"), 3);
  const auto& divergence = json.at("divergence");
  EXPECT_GT(divergence.at("t").get<double>(), 0.0);
  EXPECT_GE(divergence.at("node").get<int>(), 0);
  EXPECT_LT(divergence.at("node").get<int>(), 10);
  EXPECT_LT(divergence.at("stable_step").get<double>(), 0.5);
}

TEST_F(Divergence, OfAnUndampedEulerRunSaysThatNoStepIsStable) {
  std::string text = small_beam_with("lambda_vis = 4.0", "lambda_vis = inf");
  text.replace(text.find("mu_vis = 2.0"), 12, "mu_vis = inf");
  write("elastic.toml", text);
  expect_failure(rheo({"run", "elastic.toml", "--integrator", "euler", "--step", "1e-3"}), 2,
                 {"euler", "rk4"});
  expect_failure(rheo({"run", "elastic.toml", "--integrator", "euler", "--step", "0.02", "--duration", "1000",
                       "--frame-rate", "1", "--allow-unstable"}),
                 3, {"no step of euler is stable", "--integrator rk4"});
}

TEST_F(Divergence, AStepJustWithinTheLimitRuns) {
  write("beam.toml", small_beam());
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "probe"}).exit_code, 0);
  const auto json = nlohmann::json::parse(read_text(folder() / "probe/run.json"));
  const double stable = json.at("settings").at("stable_step");
  // A long run at 0.99 of the limit stays bounded: the limit is one.
  const Finished within = rheo({"run", "beam.toml", "-o", "within", "--step", std::to_string(0.99 * stable),
                                "--duration", "100", "--frame-rate", "0.1"});
  EXPECT_EQ(within.exit_code, 0) << within.err;
  const Finished beyond = rheo({"run", "beam.toml", "-o", "beyond", "--step", std::to_string(1.01 * stable),
                                "--duration", "100", "--frame-rate", "0.1"});
  expect_failure(beyond, 2, {"stable"});
}

}  // namespace
}  // namespace app_tests
