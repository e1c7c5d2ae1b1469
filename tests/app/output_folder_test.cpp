// The output folder: never foreign files, never half a run.
#include <gmock/gmock.h>

#include "program.hpp"

namespace app_tests {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class OutputFolder : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("beam.toml", small_beam());
  }
};

TEST_F(OutputFolder, DefaultsToOutAndTheScenesStem) {
  ASSERT_EQ(rheo({"run", "beam.toml"}).exit_code, 0);
  EXPECT_THAT(files(), ElementsAre("beam.toml", "out", "out/beam", "out/beam/history.csv",
                                   "out/beam/run.json", "out/beam/state.csv"));
}

TEST_F(OutputFolder, IsMadeWithItsParentsAndATrailingSlash) {
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "a/b c/d/"}).exit_code, 0);
  EXPECT_THAT(files(), Contains("a/b c/d/state.csv"));
}

TEST_F(OutputFolder, AnEmptyOneIsUsed) {
  fs::create_directory(folder() / "results");
  EXPECT_EQ(rheo({"run", "beam.toml", "-o", "results"}).exit_code, 0);
}

TEST_F(OutputFolder, AnEarlierRunIsNotOverwrittenWithoutForce) {
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "results"}).exit_code, 0);
  const std::string before = read_text(folder() / "results/run.json");
  expect_failure(rheo({"run", "beam.toml", "-o", "results"}), 2, {"results", "earlier run", "--force"});
  EXPECT_EQ(read_text(folder() / "results/run.json"), before);
}

TEST_F(OutputFolder, ForeignContentIsRefusedWithoutForce) {
  write("results/thesis.tex", "years of work");
  expect_failure(rheo({"run", "beam.toml", "-o", "results"}), 2, {"results", "thesis.tex", "--force"});
  EXPECT_THAT(files(), ElementsAre("beam.toml", "results", "results/thesis.tex"));
}

TEST_F(OutputFolder, ForceRemovesWhatTheEarlierRunListedAndNothingElse) {
  const std::vector<std::string> listed{"state.csv",           "history.csv",
                                        "sheet.png",           "frames/frame_00000.png",
                                        "vtu/state_00000.vtu", "vtu/state.pvd"};
  for (const std::string& name : listed) write("results/" + name, "old");
  write("results/history.csv.part", "old");
  write("results/frames/frame_00001.png.part", "old");
  write("results/run.json",
        R"({"rheo": "0", "files": ["state.csv", "history.csv", "sheet.png", "frames/frame_00000.png",
            "vtu/state_00000.vtu", "vtu/state.pvd", "run.json", "notes.txt", "../beam.toml"]})");
  const std::vector<std::string> foreign{
      "state.csv.bak",       "notes.txt",    "frames/frame_00001.png", "frames/film.mp4",
      "vtu/state_00007.vtu", "residual.png", "deeper/run.json",        "frames/frame_00000.png.old"};
  for (const std::string& name : foreign) write("results/" + name, "mine");
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "results", "--force"}).exit_code, 0);
  for (const std::string& name : foreign) EXPECT_EQ(read_text(folder() / "results" / name), "mine") << name;
  EXPECT_EQ(read_text(folder() / "beam.toml"), small_beam());
  for (const char* stale : {"sheet.png", "frames/frame_00000.png", "vtu/state_00000.vtu", "vtu/state.pvd",
                            "history.csv.part", "frames/frame_00001.png.part"})
    EXPECT_FALSE(fs::exists(folder() / "results" / stale)) << stale;
  for (const char* fresh : {"state.csv", "history.csv", "run.json"})
    EXPECT_NE(read_text(folder() / "results" / fresh), "old") << fresh;
}

TEST_F(OutputFolder, ForceRemovesNothingWhereNoRunJsonTellsWhoseItIs) {
  const std::vector<std::string> foreign{"frames/frame_00001.png", "sheet.png", "residual.png",
                                         "vtu/state_00007.vtu"};
  for (const std::string& name : foreign) write("results/" + name, "mine");
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "results", "--force"}).exit_code, 0);
  for (const std::string& name : foreign) EXPECT_EQ(read_text(folder() / "results" / name), "mine") << name;
  EXPECT_TRUE(fs::exists(folder() / "results/state.csv"));
}

TEST_F(OutputFolder, AnotherProgramsRunJsonIsNoListOfFiles) {
  for (const char* text : {"not JSON", "[]", R"({"files": ["sheet.png"]})", R"({"rheo": "1", "files": 3})"}) {
    write("results/run.json", text);
    write("results/sheet.png", "mine");
    ASSERT_EQ(rheo({"run", "beam.toml", "-o", "results", "--force"}).exit_code, 0) << text;
    EXPECT_EQ(read_text(folder() / "results/sheet.png"), "mine") << text;
  }
}

TEST_F(OutputFolder, WhatAnInterruptedRunLeftIsNamedAndForceRemovesIt) {
  write("results/history.csv.part", "old");
  write("results/frames/frame_00003.png.part", "old");
  expect_failure(rheo({"run", "beam.toml", "-o", "results"}), 2, {"results", "interrupted run", "--force"});
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "results", "--force"}).exit_code, 0);
  EXPECT_THAT(files(), ElementsAre("beam.toml", "results", "results/history.csv", "results/run.json",
                                   "results/state.csv"));
}

// 50,000 outputs: far more than are written before the kill.
TEST_F(OutputFolder, AKilledRunIsKnownAndForceRemovesWhatItMade) {
  write("results/notes.txt", "mine");
  write("results/vtu/state_00001.vtu.old", "mine");
  write("results/vtu/state_49000.vtu", "mine");
  rheo_killed_at("results/vtu/state_00003.vtu",
                 {"run", "beam.toml", "-o", "results", "--vtu", "--frame-rate", "1e5", "--force"});
  ASSERT_TRUE(fs::exists(folder() / "results/run.json"));
  EXPECT_THAT(read_text(folder() / "results/run.json"), HasSubstr("\"exit_status\": null"));
  expect_failure(rheo({"run", "beam.toml", "-o", "results"}), 2, {"results", "interrupted run", "--force"});
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "results", "--force"}).exit_code, 0);
  EXPECT_THAT(files(), ElementsAre("beam.toml", "results", "results/history.csv", "results/notes.txt",
                                   "results/run.json", "results/state.csv", "results/vtu",
                                   "results/vtu/state_00001.vtu.old", "results/vtu/state_49000.vtu"));
  expect_failure(rheo({"run", "beam.toml", "-o", "results"}), 2, {"results", "earlier run", "--force"});
}

TEST_F(OutputFolder, AnObstacleIsFoundBeforeAnythingIsRemoved) {
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "results", "--vtu"}).exit_code, 0);
  fs::create_directory(folder() / "results/sheet.png");
  const std::vector<std::string> before = files();
  expect_failure(rheo({"run", "beam.toml", "-o", "results", "--force"}), 4, {"sheet.png", "is a folder"});
  EXPECT_EQ(files(), before);
  fs::remove(folder() / "results/sheet.png");
  fs::remove(folder() / "results/vtu/state_00003.vtu");
  fs::create_directory(folder() / "results/vtu/state_00003.vtu");
  expect_failure(rheo({"run", "beam.toml", "-o", "results", "--force", "--vtu"}), 4,
                 {"state_00003.vtu", "is a folder"});
  EXPECT_TRUE(fs::exists(folder() / "results/state.csv"));
  EXPECT_TRUE(fs::exists(folder() / "results/vtu/state_00000.vtu"));
}

TEST_F(OutputFolder, AFolderInThePlaceOfRunJsonIsRefusedWithNothingRemoved) {
  write("results/run.json/precious.txt", "mine");
  write("results/history.csv.part", "old");
  const std::vector<std::string> before = files();
  expect_failure(rheo({"run", "beam.toml", "-o", "results", "--force"}), 4, {"run.json", "is a folder"});
  EXPECT_EQ(files(), before);
}

TEST_F(OutputFolder, ALinkToNowhereIsNamed) {
  fs::create_symlink("nowhere", folder() / "link");
  expect_failure(rheo({"run", "beam.toml", "-o", "link"}), 4, {"link", "nowhere", "does not exist"});
  expect_failure(rheo({"run", "beam.toml", "-o", "link/deeper"}), 4, {"link", "nowhere", "does not exist"});
}

TEST_F(OutputFolder, ForceRemovesSubfoldersThatItEmptied) {
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "results", "--vtu"}).exit_code, 0);
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "results", "--force"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder() / "results/vtu"));
}

TEST_F(OutputFolder, ForceKeepsTheOldResultsWhenTheNewSceneIsRefused) {
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "results"}).exit_code, 0);
  const std::string before = read_text(folder() / "results/state.csv");
  write("beam.toml", small_beam_with("density", "densty"));
  expect_failure(rheo({"run", "beam.toml", "-o", "results", "--force"}), 2, {"densty"});
  EXPECT_EQ(read_text(folder() / "results/state.csv"), before);
}

TEST_F(OutputFolder, AFileInItsPlaceIsRefused) {
  expect_failure(rheo({"run", "beam.toml", "-o", "beam.toml"}), 4, {"beam.toml", "not a folder"});
  EXPECT_EQ(read_text(folder() / "beam.toml"), small_beam());
}

// Below a file and in /proc nobody can write, not even root, as which these tests may run.
TEST_F(OutputFolder, APlaceThatCannotBeWrittenIsRefused) {
  expect_failure(rheo({"run", "beam.toml", "-o", "beam.toml/results"}), 4, {"beam.toml/results"});
  expect_failure(rheo({"run", "beam.toml", "-o", "/proc/rheo/results"}), 4, {"/proc/rheo"});
  expect_failure(rheo({"run", "beam.toml", "-o", "/proc", "--force"}), 4, {"/proc", "cannot write"});
  EXPECT_THAT(files(), ElementsAre("beam.toml"));
}

TEST_F(OutputFolder, AFileInTheWayOfASubfolderIsNamed) {
  write("results/vtu", "mine");
  expect_failure(rheo({"run", "beam.toml", "-o", "results", "--force", "--vtu"}), 4,
                 {"results/vtu", "is a file"});
  EXPECT_THAT(files(), ElementsAre("beam.toml", "results", "results/vtu"));
}

TEST_F(OutputFolder, AFolderInTheWayOfAResultIsNamed) {
  write("results/state.csv/precious.txt", "mine");
  const Finished finished = rheo({"run", "beam.toml", "-o", "results", "--force"});
  expect_failure(finished, 4, {"state.csv"});
  EXPECT_EQ(read_text(folder() / "results/state.csv/precious.txt"), "mine");
  EXPECT_THAT(files(), Not(Contains(EndsWith(".part"))));
}

}  // namespace
}  // namespace app_tests
