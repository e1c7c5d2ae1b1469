// Wrong usage: exit code 2, one line that names option, value and what is allowed, and nothing written.
#include <gmock/gmock.h>

#include <cstdlib>

#include "program.hpp"

namespace app_tests {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

using Usage = ProgramTest;

struct Wrong {
  const char* name;
  std::vector<std::string> arguments;
  std::vector<std::string> parts;
};

void PrintTo(const Wrong& wrong, std::ostream* out) {
  *out << wrong.name;
}

std::string name_of_wrong(const testing::TestParamInfo<Wrong>& parameter) {
  return parameter.param.name;
}

class WrongUsage : public ProgramTest, public testing::WithParamInterface<Wrong> {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("beam.toml", small_beam());
  }
};

TEST_P(WrongUsage, IsOneLineAndExitCodeTwo) {
  const Finished finished = rheo(GetParam().arguments);
  expect_failure(finished, 2, GetParam().parts);
  EXPECT_EQ(finished.out, "");
  EXPECT_THAT(files(), ElementsAre("beam.toml"));
}

INSTANTIATE_TEST_SUITE_P(
    Commands, WrongUsage,
    testing::Values(
        Wrong{"NoCommand", {}, {"no command", "run", "render", "check"}},
        Wrong{"UnknownCommand", {"rnu", "beam.toml"}, {"'rnu'", "did you mean run"}},
        Wrong{"OptionOfOthersForView", {"view", "beam.toml", "--vtu"}, {"'--vtu'", "rheo view --help"}},
        Wrong{"NoScene", {"run"}, {"SCENE", "rheo run --help"}}, Wrong{"EmptyScene", {"run", ""}, {"SCENE"}},
        Wrong{"TwoScenes", {"run", "beam.toml", "other.toml"}, {"'other.toml'", "one scene"}},
        Wrong{"UnknownOption", {"run", "beam.toml", "--frce"}, {"'--frce'", "--force"}},
        Wrong{"OptionBeforeCommand", {"--quiet", "run", "beam.toml"}, {"'--quiet'", "after the command"}},
        Wrong{"PictureOptionForRun", {"run", "beam.toml", "--size", "640x360"}, {"'--size'"}},
        Wrong{"FolderForCheck", {"check", "beam.toml", "-o", "x"}, {"--output goes with --plot"}},
        Wrong{"SizeForCheck", {"check", "beam.toml", "--size", "640x360"}, {"--size goes with --plot"}},
        Wrong{"AccuracyOutOfRange",
              {"run", "beam.toml", "--accuracy", "1e-14"},
              {"--accuracy '1e-14'", "1e-13 to 0.1"}},
        Wrong{"AccuracyAndStep",
              {"run", "beam.toml", "--accuracy", "1e-6", "--step", "1e-3"},
              {"--accuracy '1e-6' and --step", "leave out the other"}},
        Wrong{
            "AccuracyAndTolerance",
            {"run", "beam.toml", "--integrator", "exponential", "--accuracy", "1e-6", "--tolerance", "1e-6"},
            {"--accuracy '1e-6' and --tolerance", "leave out the other"}},
        Wrong{"AccuracyBeyondRounding",
              {"run", "beam.toml", "--accuracy", "1e-13", "--duration", "2000", "--frame-rate", "1",
               "--integrator", "rk4"},
              {"accuracy = 1e-13", "rounding", "what can be had"}},
        Wrong{"MissingValue", {"run", "beam.toml", "--step"}, {"--step", "value is missing"}},
        Wrong{"OptionAsValue",
              {"run", "beam.toml", "--step", "-o", "x"},
              {"--step: its value is missing", "'-o'"}},
        Wrong{"OptionAsName",
              {"render", "beam.toml", "--color", "--force"},
              {"--color: its value is missing", "'--force'"}},
        Wrong{"FlagWithNumber", {"run", "beam.toml", "--quiet=3"}, {"--quiet takes no value"}},
        Wrong{"FlagWithWord", {"run", "beam.toml", "--force=abc"}, {"--force takes no value"}},
        Wrong{
            "GivenTwice", {"run", "beam.toml", "--step", "1", "--step", "2"}, {"--step", "more than once"}}),
    name_of_wrong);

INSTANTIATE_TEST_SUITE_P(
    Values, WrongUsage,
    testing::Values(
        Wrong{
            "Integrator", {"run", "beam.toml", "--integrator", "rk5"}, {"--integrator 'rk5'", "rk4, euler"}},
        Wrong{"Kernel",
              {"run", "beam.toml", "--kernel", "fast"},
              {"--kernel 'fast'", "auto, csr, edge, element"}},
        Wrong{"KernelOfImplicit",
              {"run", "beam.toml", "--integrator", "implicit", "--kernel", "edge"},
              {"kernel edge", "implicit", "auto or csr"}},
        Wrong{"ElementKernelOfImplicit",
              {"run", "beam.toml", "--integrator", "implicit", "--kernel", "element"},
              {"kernel element", "implicit", "auto or csr"}},
        Wrong{"EveryZero", {"render", "beam.toml", "--every", "0"}, {"--every '0'", "from 1 to 1000000000"}},
        Wrong{"EveryFraction", {"render", "beam.toml", "--every", "1.5"}, {"--every '1.5'", "whole number"}},
        Wrong{"EveryOfRun", {"run", "beam.toml", "--every", "2"}, {"unknown option '--every'"}},
        Wrong{"Tolerance",
              {"run", "beam.toml", "--integrator", "exponential", "--tolerance", "1e-16"},
              {"--tolerance '1e-16'", "1e-13 to 0.1"}},
        Wrong{"ToleranceOfAnother",
              {"run", "beam.toml", "--tolerance", "1e-6"},
              {"--tolerance '1e-06'", "exponential", "rk4"}},
        Wrong{"StepWord",
              {"run", "beam.toml", "--step", "small"},
              {"--step 'small'", "auto", "greater than 0"}},
        Wrong{"StepNegative", {"run", "beam.toml", "--step", "-1e-3"}, {"--step '-1e-3'", "greater than 0"}},
        Wrong{"StepZero", {"run", "beam.toml", "--step", "0"}, {"--step '0'"}},
        Wrong{"StepNan", {"run", "beam.toml", "--step", "nan"}, {"--step 'nan'"}},
        Wrong{"StepUnit", {"run", "beam.toml", "--step", "1ms"}, {"--step '1ms'"}},
        Wrong{"DurationZero", {"run", "beam.toml", "--duration", "0"}, {"--duration '0'", "seconds"}},
        Wrong{"DurationNegative", {"run", "beam.toml", "--duration", "-1"}, {"--duration '-1'"}},
        Wrong{"DurationInfinite", {"run", "beam.toml", "--duration", "inf"}, {"--duration 'inf'"}},
        Wrong{"DurationHuge",
              {"run", "beam.toml", "--duration", "1e300"},
              {"rheo: --duration '1e300': must be a number from 1e-30 to 1e+30 (seconds)"}},
        Wrong{"DurationOfManyOutputs",
              {"run", "beam.toml", "--duration", "1e12"},
              {"rheo: --duration '1e12': 2e+13 outputs, 20 per second", "1e+07"}},
        Wrong{"FrameRateOfManyOutputs",
              {"bench", "beam.toml", "--frame-rate", "1e12"},
              {"rheo: --frame-rate '1e12': 5e+11 outputs", "1e+07"}},
        Wrong{"DurationAndFrameRateOfManyOutputs",
              {"check", "beam.toml", "--frame-rate", "1e6", "--duration", "1e2"},
              {"rheo: --duration '1e2' and --frame-rate '1e6': 1e+08 outputs", "1e+07"}},
        Wrong{"StepOfManySteps",
              {"run", "beam.toml", "--step", "1e-15"},
              {"rheo: --step '1e-15': 5e+14 steps of 1e-15 s in 0.5 s", "1e+12"}},
        Wrong{"FrameRateHuge",
              {"run", "beam.toml", "--frame-rate", "1e31"},
              {"rheo: --frame-rate '1e31': must be a number from 1e-30 to 1e+30"}},
        Wrong{"DurationEmpty", {"run", "beam.toml", "--duration", ""}, {"--duration ''"}},
        Wrong{"FrameRate", {"run", "beam.toml", "--frame-rate", "0"}, {"--frame-rate '0'", "per second"}},
        Wrong{"Threads", {"run", "beam.toml", "--threads", "0"}, {"--threads '0'", "1 to 64"}},
        Wrong{"ThreadsFraction", {"run", "beam.toml", "--threads", "1.5"}, {"--threads '1.5'"}},
        Wrong{"Folder", {"run", "beam.toml", "-o", ""}, {"--output ''"}},
        Wrong{"SizeHuge",
              {"render", "beam.toml", "--size", "100000x100000"},
              {"--size '100000x100000'", "from 240x160 to 16384x16384", "1280x720"}},
        Wrong{"SizeNarrow", {"render", "beam.toml", "--size", "239x1000"}, {"--size '239x1000'", "240x160"}},
        Wrong{"SizeLow", {"render", "beam.toml", "--size", "1000x159"}, {"--size '1000x159'", "240x160"}},
        Wrong{"SizeNegative", {"render", "beam.toml", "--size", "-5x100"}, {"--size '-5x100'"}},
        Wrong{"SizeOneNumber", {"render", "beam.toml", "--size", "640"}, {"--size '640'"}},
        Wrong{"SizeThreeNumbers", {"render", "beam.toml", "--size", "640x480x3"}, {"--size '640x480x3'"}},
        Wrong{"Color",
              {"render", "beam.toml", "--color", "w_lamda"},
              {"--color 'w_lamda'", "did you mean w_lambda"}},
        Wrong{"RangeReversed",
              {"render", "beam.toml", "--range", "2,1"},
              {"--range '2,1'", "LOW less than HIGH"}},
        Wrong{"RangeOneNumber", {"render", "beam.toml", "--range", "1"}, {"--range '1'", "auto"}},
        Wrong{"RangeNan", {"render", "beam.toml", "--range", "0,nan"}, {"--range '0,nan'"}},
        Wrong{
            "Backend", {"render", "beam.toml", "--backend", "glx"}, {"--backend 'glx'", "auto, osmesa, egl"}},
        Wrong{"Sheet", {"render", "beam.toml", "--sheet", "1"}, {"--sheet '1'", "2 to 64"}}),
    name_of_wrong);

TEST_F(Usage, ADurationThatDoesNotGoWithTheScenesStepIsTheOptionsFault) {
  write("beam.toml", small_beam_with("frame_rate = 20", "frame_rate = 1\nstep = 1e-9"));
  expect_failure(rheo({"run", "beam.toml", "--duration", "1e5"}), 2,
                 {"rheo: --duration '1e5': 1e+14 steps of 1e-09 s in 100000 s", "1e+12"});
}

TEST_F(Usage, HelpNamesCommandsExitCodesAndExamples) {
  const Finished finished = rheo({"--help"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.err, "");
  for (const char* part : {"run", "render", "view", "check", "bench", "Exit codes:", "Examples:"})
    EXPECT_THAT(finished.out, HasSubstr(part));
}

TEST_F(Usage, HelpOfACommandNamesAllItsOptions) {
  const Finished render = rheo({"render", "--help"});
  EXPECT_EQ(render.exit_code, 0);
  for (const char* option : {"--integrator", "--step", "--duration", "--frame-rate", "--threads", "--vtu",
                             "--force", "--allow-unstable", "--quiet", "--kernel", "--no-energies", "--size",
                             "--color", "--range", "--backend", "--sheet", "-o,--output", "seconds", "Pa m"})
    EXPECT_THAT(render.out, HasSubstr(option));
  const Finished run = rheo({"run", "--help"});
  EXPECT_THAT(run.out, Not(HasSubstr("--backend")));
  const Finished bench = rheo({"bench", "--help"});
  for (const char* option :
       {"--budget", "--csv", "--integrator", "--kernel", "--threads", "-o,--output", "--force"})
    EXPECT_THAT(bench.out, HasSubstr(option));
  EXPECT_THAT(bench.out, HasSubstr("element"));
  EXPECT_THAT(bench.out, Not(HasSubstr("  --step")));
  for (const std::string& line : lines_of(bench.out)) EXPECT_LE(line.size(), 120u) << line;
  // A line that wraps on a common terminal of 120 columns is hard to read.
  for (const std::string& line : lines_of(render.out)) EXPECT_LE(line.size(), 120u) << line;
}

TEST_F(Usage, VersionIsTheProjects) {
  const Finished finished = rheo({"--version"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.out, "rheo " RHEO_VERSION "\n");
}

// The address sanitizer reserves more than any limit.
#if !defined(RHEO_SANITIZE_ADDRESS)
TEST_F(Usage, AMeshBeyondTheMemoryIsRefusedBeforeItIsBuilt) {
  // 640,000 nodes: about 0.6 GB, beyond 0.5 GB; implicit: two factors of 1 GB each and the matrices.
  write("big.toml", small_beam_with("nodes = [5, 2]", "nodes = [1600, 400]"));
  const auto refused = [&](const std::string& options, const std::vector<std::string>& parts) {
    const std::string command = "cd '" + folder().string() +
                                "' && ulimit -v 500000 && '" RHEO_PROGRAM "' run big.toml " + options +
                                " >out 2>err";
    const int status = std::system(command.c_str());
    expect_failure({WEXITSTATUS(status), "", read_text(folder() / "err")}, 4, parts);
  };
  refused("", {"640000 nodes need", "GB", "ulimit -v", "coarser mesh"});
  refused("--integrator implicit", {"640000 nodes with implicit need about 4.", "GB", "ulimit -v"});
  EXPECT_EQ(read_text(folder() / "out"), "");
}
#endif

TEST_F(Usage, AKernelThatTheSceneDoesNotAllowIsRefused) {
  write("consistent.toml", small_beam_with("density = 0.2", "density = 0.2\nmass = \"consistent\""));
  for (const std::string kernel : {"edge", "element"}) {
    expect_failure(rheo({"run", "consistent.toml", "--kernel", kernel}), 2,
                   {"kernel " + kernel, "mass = \"lumped\"", "use auto or csr"});
  }
}

TEST_F(Usage, ALineBreakInAPathDoesNotBreakTheLine) {
  expect_failure(rheo({"run", "no\nsuch\nfile.toml"}), 4, {"no such file.toml"});
}

}  // namespace
}  // namespace app_tests
