// What a run leaves in its folder: names, columns, rows, and numbers that balance.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace app_tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

class Results : public ProgramTest {
 protected:
  // Runs the small beam into `out` with more options.
  void run(const std::string& out, std::vector<std::string> options = {}) {
    write("beam.toml", small_beam());
    options.insert(options.begin(), {"run", "beam.toml", "-o", out});
    const Finished finished = rheo(options);
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.err, "");
  }
};

TEST_F(Results, HistoryHasARowPerOutputAndTheProbesColumns) {
  run("r");
  const std::vector<std::string> lines = lines_of(read_text(folder() / "r/history.csv"));
  EXPECT_EQ(lines.at(0),
            "t,w_lambda_norm,w_mu_norm,u_max,kinetic,stored,dissipated,work,grip_ux,grip_uy,grip_fx,grip_fy");
  auto table = read_table(folder() / "r/history.csv");
  ASSERT_THAT(table["t"], SizeIs(11));  // 0.5 s at 20 per second, both ends
  for (std::size_t k = 0; k < 11; ++k) EXPECT_NEAR(table["t"][k], 0.05 * static_cast<double>(k), 1e-15);
  EXPECT_EQ(table["w_lambda_norm"][0], 0.0);
  EXPECT_EQ(table["u_max"][0], 0.0);
}

TEST_F(Results, KineticStoredDissipatedAndWorkBalance) {
  run("r", {"--step", "5e-4"});
  auto table = read_table(folder() / "r/history.csv");
  ASSERT_THAT(table["t"], SizeIs(11));
  const double scale = *std::ranges::max_element(table["work"]);
  ASSERT_GT(scale, 0.0);
  for (std::size_t k = 0; k < 11; ++k) {
    const double left = table["kinetic"][k] + table["stored"][k] + table["dissipated"][k] - table["work"][k];
    // (omega_max h)^4 is about 1e-7 here: the quadratures are of RK4's order.
    EXPECT_NEAR(left, 0.0, 1e-6 * scale) << "row " << k;
  }
}

TEST_F(Results, ProbeForceIsTheTractionWhileItActsAndNothingAfter) {
  run("r");
  auto table = read_table(folder() / "r/history.csv");
  ASSERT_THAT(table["grip_fx"], SizeIs(11));
  // 5 Pa on 0.25 m of edge, 1 m thick; the edge is free, so no reaction is in it.
  EXPECT_NEAR(table["grip_fx"][2], 1.25, 1e-12);
  EXPECT_NEAR(table["grip_fx"][8], 0.0, 1e-12);
  EXPECT_GT(table["grip_ux"][3], table["grip_ux"][1]);
}

TEST_F(Results, StateHasARowPerNodeAtItsReferencePosition) {
  run("r");
  EXPECT_EQ(lines_of(read_text(folder() / "r/state.csv")).at(0),
            "node,x,y,ux,uy,vx,vy,w_lambda_x,w_lambda_y,w_mu_x,w_mu_y");
  auto table = read_table(folder() / "r/state.csv");
  ASSERT_THAT(table["node"], SizeIs(10));
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(table["node"][i], static_cast<double>(i));
    EXPECT_NEAR(table["x"][i], 0.25 * static_cast<double>(i % 5), 1e-15);
    EXPECT_NEAR(table["y"][i], 0.25 * static_cast<double>(i / 5), 1e-15);
  }
  EXPECT_EQ(table["ux"][0], 0.0);
  EXPECT_NE(table["ux"][4], 0.0);
}

TEST_F(Results, StateIsThatOfTheDurationEvenWhereNoOutputFallsOnIt) {
  run("whole", {"--duration", "0.33", "--step", "1e-3"});
  run("sparse", {"--duration", "0.33", "--step", "1e-3", "--frame-rate", "3.1"});
  auto whole = read_table(folder() / "whole/state.csv"), sparse = read_table(folder() / "sparse/state.csv");
  EXPECT_THAT(read_table(folder() / "sparse/history.csv")["t"], SizeIs(2));
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_NEAR(whole["ux"][i], sparse["ux"][i],
                1e-6 * std::abs(whole["ux"][4]));  // other step grids, both RK4 at 1 ms
}

TEST_F(Results, ASecondRunIsIdenticalToTheLastByte) {
  run("a", {"--vtu"});
  run("b", {"--vtu", "--threads", "7"});
  for (const char* name : {"state.csv", "history.csv", "vtu/state_00010.vtu", "vtu/state.pvd"})
    EXPECT_EQ(read_text(folder() / "a" / name), read_text(folder() / "b" / name)) << name;
}

TEST_F(Results, VtuSeriesHasAFilePerOutputAndAnIndex) {
  run("r", {"--vtu"});
  std::vector<std::string> vtu;
  for (const std::string& name : files())
    if (name.starts_with("r/vtu/")) vtu.push_back(name);
  EXPECT_THAT(vtu, AllOf(SizeIs(12), Contains("r/vtu/state_00000.vtu"), Contains("r/vtu/state_00010.vtu"),
                         Contains("r/vtu/state.pvd")));
  const std::string index = read_text(folder() / "r/vtu/state.pvd");
  for (const char* part : {"state_00000.vtu", "state_00010.vtu", "0.5"}) EXPECT_THAT(index, HasSubstr(part));
  for (const char* part : {"w_lambda", "w_mu", "strain", "stress"})
    EXPECT_THAT(read_text(folder() / "r/vtu/state_00010.vtu"), HasSubstr(part));
}

TEST_F(Results, RunJsonHoldsWhatIsNeededToDoItAgain) {
  run("r", {"--step", "0.002", "--integrator", "rk4"});
  const auto json = nlohmann::json::parse(read_text(folder() / "r/run.json"));
  EXPECT_EQ(json.at("scene"), small_beam());
  EXPECT_EQ(json.at("rheo"), RHEO_VERSION);
  EXPECT_THAT(json.at("compiler").get<std::string>(), Not(""));
  EXPECT_EQ(json.at("settings").at("integrator"), "rk4");
  EXPECT_EQ(json.at("settings").at("step_asked"), 0.002);
  EXPECT_LE(json.at("settings").at("step_bound").get<double>(), 0.002);
  EXPECT_LE(json.at("settings").at("largest_step").get<double>(), 0.002 * (1.0 + 1e-9));
  EXPECT_GT(json.at("settings").at("stable_step").get<double>(), 0.002);
  EXPECT_EQ(json.at("outputs"), 11);
  EXPECT_EQ(json.at("exit_status"), 0);
  EXPECT_TRUE(json.at("divergence").is_null());
  EXPECT_EQ(json.at("command_line").at(1), "run");
  EXPECT_EQ(json.at("files"), nlohmann::json({"history.csv", "state.csv", "run.json"}));
  const std::int64_t steps = json.at("counters").at("steps");
  EXPECT_GE(steps, 250);  // 0.5 s at 0.002 s at most
  EXPECT_GE(json.at("counters").at("force_evaluations").get<std::int64_t>(), 4 * steps);
  for (const char* phase : {"read", "build", "simulate", "draw", "encode", "write"})
    EXPECT_GE(json.at("seconds").at(phase).get<double>(), 0.0);
}

TEST_F(Results, RunJsonNamesTheFilesThatTheSceneReads) {
  write("scenes/keys.csv", "0,5,0\n0.2,0,0\n");
  write("scenes/beam.toml", small_beam_with("vector = [5.0, 0.0]", "keys = \"keys.csv\""));
  const Finished finished = rheo({"run", "scenes/beam.toml", "-o", "r"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const auto json = nlohmann::json::parse(read_text(folder() / "r/run.json"));
  ASSERT_THAT(json.at("read_files"), SizeIs(1));
  EXPECT_EQ(json.at("read_files").at(0).at("path"), "scenes/keys.csv");
  EXPECT_EQ(json.at("read_files").at(0).at("bytes"), 14);
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : read_text(folder() / "scenes/keys.csv"))
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  EXPECT_EQ(json.at("read_files").at(0).at("fnv1a_64"), fmt::format("{:016x}", hash));
  EXPECT_EQ(json.at("working_directory"), fs::canonical(folder()).string());
  EXPECT_EQ(json.at("settings").at("step_asked"), "auto");
  for (const char* library : {"fmt", "CLI11", "nlohmann_json", "Eigen", "tomlplusplus"})
    EXPECT_THAT(json.at("libraries").at(library).get<std::string>(), HasSubstr("."));
  EXPECT_EQ(json.at("toolchain").at("compiler"), json.at("compiler"));
}

TEST_F(Results, OutputsThatEndBeforeTheDurationAreToldOf) {
  write("beam.toml", small_beam());
  const Finished finished = rheo({"run", "beam.toml", "-o", "r", "--duration", "0.21"});
  const std::string note = "outputs end at t = 0.2 s, state.csv is at the duration 0.21 s";
  EXPECT_THAT(finished.out, HasSubstr("note: " + note));
  const auto json = nlohmann::json::parse(read_text(folder() / "r/run.json"));
  EXPECT_THAT(json.at("notes").dump(), HasSubstr(note));
  EXPECT_THAT(rheo({"check", "beam.toml", "--duration", "0.21"}).out, HasSubstr(note));
  EXPECT_THAT(rheo({"run", "beam.toml", "-o", "s", "--duration", "0.3"}).out, Not(HasSubstr("note: ")));
}

TEST_F(Results, TheSceneInRunJsonRunsAgainToTheSameState) {
  run("first");
  const auto json = nlohmann::json::parse(read_text(folder() / "first/run.json"));
  write("again.toml", json.at("scene").get<std::string>());
  ASSERT_EQ(rheo({"run", "again.toml", "-o", "second"}).exit_code, 0);
  EXPECT_EQ(read_text(folder() / "first/state.csv"), read_text(folder() / "second/state.csv"));
}

TEST_F(Results, OverridesChangeTheRun) {
  run("rk4");
  run("euler", {"--integrator", "euler", "--step", "1e-4"});
  run("short", {"--duration", "0.25", "--frame-rate", "40"});
  EXPECT_NE(read_text(folder() / "rk4/state.csv"), read_text(folder() / "euler/state.csv"));
  EXPECT_THAT(read_table(folder() / "short/history.csv")["t"], SizeIs(11));
  const double rk4 = read_table(folder() / "rk4/history.csv")["grip_ux"].at(10);
  const double euler = read_table(folder() / "euler/history.csv")["grip_ux"].at(10);
  EXPECT_NEAR(euler, rk4, 0.02 * std::abs(rk4));  // first order: the error is about the step times omega
}

TEST_F(Results, DoNotDependOnTheKernel) {
  const std::string lumped = small_beam() + "\n";
  ASSERT_EQ(lumped.find("consistent"), std::string::npos);
  run("csr", {"--kernel", "csr"});
  auto csr = read_table(folder() / "csr/history.csv");
  for (const std::string kernel : {"edge", "element"}) {
    run(kernel, {"--kernel", kernel});
    const auto json = nlohmann::json::parse(read_text(folder() / kernel / "run.json"));
    EXPECT_EQ(json.at("settings").at("kernel"), kernel);
    auto other = read_table(folder() / kernel / "history.csv");
    for (const auto& [name, values] : csr) {
      double largest = 0.0;
      for (double x : values) largest = std::max(largest, std::abs(x));
      for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(values[i], other[name][i], 1e-9 * largest) << kernel << " " << name;
    }
  }
}

TEST_F(Results, EnergiesThatNobodyAsksForLeaveTheirColumnsEmpty) {
  run("without", {"--no-energies"});
  const std::vector<std::string> rows = lines_of(read_text(folder() / "without/history.csv"));
  ASSERT_GT(rows.size(), 2u);
  for (std::size_t i = 1; i < rows.size(); ++i) EXPECT_THAT(rows[i], HasSubstr(",,,")) << rows[i];
  EXPECT_THAT(rows[1], testing::Not(HasSubstr("nan")));
}

TEST_F(Results, OfTheExponentialIntegratorLeaveEmptyWhatItDoesNotKnow) {
  run("exponential", {"--integrator", "exponential"});
  const std::vector<std::string> lines = lines_of(read_text(folder() / "exponential/history.csv"));
  ASSERT_THAT(lines, SizeIs(12));
  std::vector<std::string> cells(1);
  for (const char c : lines.back()) {
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  }
  ASSERT_THAT(cells, SizeIs(12));
  EXPECT_EQ(cells[6], "");              // dissipated
  EXPECT_GT(std::stod(cells[7]), 0.0);  // work of a constant traction
  run("rk4");
  const double rk4 = read_table(folder() / "rk4/history.csv")["grip_ux"].at(10);
  EXPECT_NEAR(std::stod(cells[8]), rk4, 1e-3 * std::abs(rk4));  // RK4's error at a quarter of its limit
  const auto json = nlohmann::json::parse(read_text(folder() / "exponential/run.json"));
  EXPECT_EQ(json.at("settings").at("integrator"), "exponential");
  EXPECT_EQ(json.at("settings").at("tolerance"), 1e-10);
  EXPECT_TRUE(json.at("settings").at("step_bound").is_null());
}

TEST_F(Results, OfTheImplicitIntegratorCountFactorsAndSolves) {
  run("implicit", {"--integrator", "implicit", "--step", "0.005"});
  run("rk4", {"--step", "0.0005"});
  const auto rk4 = read_table(folder() / "rk4/state.csv")["ux"];
  const auto implicit = read_table(folder() / "implicit/state.csv")["ux"];
  ASSERT_EQ(implicit.size(), rk4.size());
  // RK4's error at this step is 1e-8 of displacements of 0.2 m.
  for (std::size_t i = 0; i < rk4.size(); ++i) EXPECT_NEAR(implicit[i], rk4[i], 1e-7);
  const auto json = nlohmann::json::parse(read_text(folder() / "implicit/run.json"));
  EXPECT_EQ(json.at("settings").at("integrator"), "implicit");
  EXPECT_EQ(json.at("settings").at("kernel"), "csr");
  EXPECT_TRUE(json.at("settings").at("stable_step").is_null());
  EXPECT_EQ(json.at("counters").at("factors"), 1);
  EXPECT_EQ(json.at("counters").at("shifted_solves"),
            8 * json.at("counters").at("steps").get<std::int64_t>());
}

TEST_F(Results, OfAnAccuracyAreThatAccurateAndSayWhatWasChosen) {
  write("beam.toml", small_beam_with("frame_rate = 20", "frame_rate = 20\naccuracy = 1e-9"));
  const Finished chosen = rheo({"run", "beam.toml", "-o", "chosen"});
  EXPECT_EQ(chosen.exit_code, 0) << chosen.err;
  EXPECT_THAT(chosen.out, HasSubstr("note: accuracy 1e-09 asked for: exponential"));
  EXPECT_THAT(chosen.out, HasSubstr("column dissipated of energy stays empty"));
  const Finished rk4 = rheo({"run", "beam.toml", "-o", "rk4", "--integrator", "rk4"});
  EXPECT_THAT(rk4.out, HasSubstr("note: accuracy 1e-09 asked for: rk4 (as asked), steps of at most"));
  EXPECT_THAT(rk4.out, Not(HasSubstr("empty")));
  const double one = read_table(folder() / "chosen/state.csv")["ux"].at(4);
  const double other = read_table(folder() / "rk4/state.csv")["ux"].at(4);
  EXPECT_NEAR(one, other, 1e-8 * std::abs(other));  // both within 1e-9 of the block's largest
  const auto json = nlohmann::json::parse(read_text(folder() / "rk4/run.json"));
  const auto& settings = json.at("settings");
  EXPECT_EQ(settings.at("integrator"), "rk4");
  EXPECT_EQ(settings.at("step_asked"), "auto");
  EXPECT_EQ(settings.at("plan").at("accuracy"), 1e-9);
  EXPECT_LE(settings.at("plan").at("estimated_error").get<double>(), 1e-9);
  EXPECT_GT(settings.at("plan").at("trial_force_evaluations").get<double>(), 0.0);
  EXPECT_LE(settings.at("largest_step").get<double>(),
            settings.at("step_bound").get<double>() * (1.0 + 1e-9));
  // The command line's word stands for the scene's.
  const Finished stepped = rheo({"run", "beam.toml", "-o", "stepped", "--step", "1e-3"});
  EXPECT_EQ(stepped.exit_code, 0) << stepped.err;
  const auto plain = nlohmann::json::parse(read_text(folder() / "stepped/run.json"));
  EXPECT_TRUE(plain.at("settings").at("plan").is_null());
  EXPECT_EQ(plain.at("settings").at("step_asked"), 1e-3);
}

TEST_F(Results, AreListedAtTheEndAndNothingIsSaidWhenQuiet) {
  write("beam.toml", small_beam());
  const Finished spoken = rheo({"run", "beam.toml", "-o", "a", "--vtu"});
  for (const char* part :
       {"a/state.csv", "a/history.csv", "a/run.json", "state_00000.vtu ... state_00010.vtu", "steps"})
    EXPECT_THAT(spoken.out, HasSubstr(part));
  EXPECT_EQ(spoken.err, "");
  const Finished quiet = rheo({"run", "beam.toml", "-o", "b", "--quiet"});
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST_F(Results, StrainBeyondALinearModelIsWarnedOfOnceWithTimeAndPlace) {
  // 5 Pa stretch a beam of 7 and 5 Pa by far more than 10 %.
  write("beam.toml", small_beam_with("until = 0.2", "until = 9"));
  const Finished finished = rheo({"run", "beam.toml"});
  EXPECT_EQ(finished.exit_code, 0);
  std::vector<std::string> warnings;
  for (const std::string& line : lines_of(finished.out))
    if (line.starts_with("warning: ") && line.find("strain") != std::string::npos) warnings.push_back(line);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_THAT(warnings[0], AllOf(HasSubstr("t = "), HasSubstr("triangle "), HasSubstr("x = ")));
  const auto json = nlohmann::json::parse(read_text(folder() / "out/beam/run.json"));
  EXPECT_THAT(json.at("warnings").dump(), HasSubstr("strain"));
}

TEST_F(Results, TheReadersNotesAreToldAndKept) {
  write("beam.toml", small_beam_with("shape = \"rectangle\"\nsize = [1.0, 0.25]\nnodes = [5, 2]",
                                     "points = [[0, 0], [1, 0], [0, 1]]\ntriangles = [[0, 2, 1]]\n[edges]\n"
                                     "left = [[0, 2]]\nright = [[1, 2]]"));
  const Finished finished = rheo({"run", "beam.toml"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("note: "), HasSubstr("clockwise")));
  const auto json = nlohmann::json::parse(read_text(folder() / "out/beam/run.json"));
  EXPECT_THAT(json.at("notes").dump(), HasSubstr("clockwise"));
}

TEST_F(Results, NotesSayWhatNeverActs) {
  write("beam.toml", small_beam() +
                         "[[traction]]\nedges = \"top\"\nvector = [0.0, 1.0]\nfrom = 100.0\n"
                         "[[move]]\nnodes = [4]\nkeys = [[50.0, 0.0, 0.0], [51.0, 1.0, 0.0]]\n");
  const Finished finished = rheo({"run", "beam.toml"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("[[traction]] never acts: from = 100 s"),
                                  HasSubstr("[[move]] is constant while it acts")));
}

TEST_F(Results, NotesSayThatAMeshIsInPieces) {
  write("beam.toml",
        small_beam_with("shape = \"rectangle\"\nsize = [1.0, 0.25]\nnodes = [5, 2]",
                        "points = [[0, 0], [1, 0], [0, 1], [2, 0], [3, 0], [2, 1]]\n"
                        "triangles = [[0, 1, 2], [3, 4, 5]]\n[edges]\nleft = [[0, 2]]\nright = [[3, 4]]"));
  const Finished finished = rheo({"run", "beam.toml"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("note: the mesh is 2 pieces that share no node"));
}

TEST_F(Results, NoPartStaysBehind) {
  run("r", {"--vtu"});
  for (const std::string& name : files()) EXPECT_THAT(name, Not(HasSubstr(".part")));
}

TEST_F(Results, AFullStandardOutputIsAFailure) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  write("beam.toml", small_beam());
  const std::string command =
      "cd '" + folder().string() + "' && '" RHEO_PROGRAM "' check beam.toml >/dev/full 2>err";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 4);
  EXPECT_THAT(read_text(folder() / "err"), HasSubstr("standard output"));
}

}  // namespace
}  // namespace app_tests
