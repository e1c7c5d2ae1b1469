// Scenes that cannot be used: exit code 2 (4 where the system refuses to read), one line, no folder.
#include <gmock/gmock.h>

#include "program.hpp"

namespace app_tests {
namespace {

using testing::ElementsAre;

class SceneErrors : public ProgramTest {
 protected:
  // The scene is refused by all three commands alike.
  void expect_refused(const std::string& text, const std::vector<std::string>& parts) {
    write("scene.toml", text);
    for (const char* command : {"check", "run", "render"}) {
      const Finished finished = rheo({command, "scene.toml"});
      expect_failure(finished, 2, parts);
      EXPECT_EQ(finished.out, "");
      EXPECT_THAT(files(), ElementsAre("scene.toml"));
    }
  }
};

TEST_F(SceneErrors, MissingFile) {
  expect_failure(rheo({"run", "absent.toml"}), 4, {"absent.toml"});
}

TEST_F(SceneErrors, FolderInsteadOfAFile) {
  fs::create_directory(folder() / "folder.toml");
  const Finished finished = rheo({"run", "folder.toml"});
  expect_failure(finished, finished.exit_code == 2 ? 2 : 4, {"folder.toml"});
}

TEST_F(SceneErrors, Empty) {
  expect_refused("", {"scene.toml"});
}

TEST_F(SceneErrors, Binary) {
  expect_refused(std::string("\x7f\x45\x4c\x46\0\xff\xfe\0", 8), {"scene.toml"});
}

TEST_F(SceneErrors, SyntaxNamesTheLine) {
  expect_refused(small_beam_with("mu_ela = 5.0", "mu_ela = = 5.0"), {"scene.toml:10"});
}

TEST_F(SceneErrors, UnknownKeyNamesTheNearest) {
  expect_refused(small_beam_with("mu_ela", "mu_ella"), {"scene.toml:10", "mu_ella", "mu_ela"});
}

TEST_F(SceneErrors, ValueOutOfRange) {
  expect_refused(small_beam_with("density = 0.2", "density = -0.2"), {"scene.toml:13", "density", "-0.2"});
}

TEST_F(SceneErrors, WrongType) {
  expect_refused(small_beam_with("duration = 0.5", "duration = \"long\""), {"scene.toml:28", "duration"});
}

TEST_F(SceneErrors, ZeroDuration) {
  expect_refused(small_beam_with("duration = 0.5", "duration = 0"), {"scene.toml:28", "duration"});
}

TEST_F(SceneErrors, AbsurdMeshIsRefusedBeforeTheMemoryIsAskedFor) {
  expect_refused(small_beam_with("nodes = [5, 2]", "nodes = [1000000, 1000000]"), {"scene.toml", "nodes"});
}

TEST_F(SceneErrors, AbsurdPicture) {
  expect_refused(small_beam_with("[320, 180]", "[100000, 100000]"), {"scene.toml", "size", "100000"});
}

TEST_F(SceneErrors, UnknownGroup) {
  expect_refused(small_beam_with("edges = \"left\"", "edges = \"lift\""), {"scene.toml", "lift", "left"});
}

TEST_F(SceneErrors, AStepBeyondTheLimitIsAtItsOwnLine) {
  write("scene.toml", small_beam_with("frame_rate = 20", "frame_rate = 20\nstep = 0.5"));
  for (const char* command : {"check", "run"})
    expect_failure(rheo({command, "scene.toml"}), 2, {"scene.toml:30: [time] step = 0.5", "stable step"});
}

TEST_F(SceneErrors, EulerWithoutDampingIsAtTheLineOfTheStepOrTheIntegrator) {
  std::string text = small_beam_with("lambda_vis = 4.0", "lambda_vis = inf");
  text.replace(text.find("mu_vis = 2.0"), 12, "mu_vis = inf");
  const std::string before = "frame_rate = 20";
  text.insert(text.find(before) + before.size(), "\nintegrator = \"euler\"");
  write("scene.toml", text);
  expect_failure(rheo({"run", "scene.toml"}), 2,
                 {"scene.toml:30: [time] integrator = \"euler\": no step of it", "rk4"});
  text.insert(text.find(before) + before.size(), "\nstep = 0.01");
  write("scene.toml", text);
  expect_failure(rheo({"run", "scene.toml"}), 2,
                 {"scene.toml:30: [time] step = 0.01 s: no step of euler", "rk4"});
}

TEST_F(SceneErrors, AnAccuracyThatCannotBeHadIsAtItsOwnLine) {
  std::string text = small_beam_with("frame_rate = 20", "frame_rate = 1\naccuracy = 1e-13");
  text.insert(text.find("accuracy"), "integrator = \"rk4\"\n");
  text.replace(text.find("duration = 0.5"), 14, "duration = 2000");
  write("scene.toml", text);
  expect_failure(rheo({"run", "scene.toml"}), 2, {"scene.toml:31: [time] accuracy = 1e-13", "rounding"});
}

TEST_F(SceneErrors, StepBeyondTheStableLimitNamesTheLimit) {
  expect_refused(small_beam() + "\n[time2]\n", {"time2"});
  write("scene.toml", small_beam());
  for (const char* command : {"check", "run", "render"}) {
    const Finished finished = rheo({command, "scene.toml", "--step", "0.4", "--frame-rate", "2"});
    expect_failure(finished, 2, {"0.4", "stable", "--allow-unstable"});
    EXPECT_THAT(files(), ElementsAre("scene.toml"));
  }
}

}  // namespace
}  // namespace app_tests
