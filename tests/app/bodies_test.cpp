// Scenes of several bodies: what a run leaves, and what check and the failures say of them.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "program.hpp"
#include "render/decode.hpp"

namespace app_tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::string body(const std::string& name, const std::string& position) {
  return "[[body]]\nname = \"" + name + "\"\nposition = " + position +
         "\n[body.mesh]\nshape = \"rectangle\"\nsize = [1.0, 0.25]\nnodes = [5, 2]\n"
         "[body.material]\nlambda_ela = 7.0\nmu_ela = 5.0\nlambda_vis = 4.0\nmu_vis = 2.0\ndensity = 0.2\n"
         "[[body.fix]]\nedges = \"left\"\n[[body.traction]]\nedges = \"right\"\nvector = [1.0, 0.0]\n"
         "until = 0.2\n[[body.probe]]\nname = \"" +
         name + "\"\nedges = \"right\"\n";
}

class Bodies : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("two.toml",
          body("lower", "[0, 0]") + body("upper", "[0, 1]") + "[time]\nduration = 0.5\nframe_rate = 20\n");
  }
};

TEST_F(Bodies, StateHasTheirNumberInALastColumn) {
  ASSERT_EQ(rheo({"run", "two.toml", "-o", "r"}).exit_code, 0);
  EXPECT_EQ(lines_of(read_text(folder() / "r/state.csv"))[0],
            "node,x,y,ux,uy,vx,vy,w_lambda_x,w_lambda_y,w_mu_x,w_mu_y,body");
  auto table = read_table(folder() / "r/state.csv");
  ASSERT_EQ(table["body"].size(), 20u);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(table["body"][i], i < 10 ? 1.0 : 2.0);
    EXPECT_EQ(table["y"][i] >= 1.0, i >= 10);
  }
}

TEST_F(Bodies, RunJsonNamesThemAndTheirMaterials) {
  ASSERT_EQ(rheo({"run", "two.toml", "-o", "r"}).exit_code, 0);
  const auto json = nlohmann::json::parse(read_text(folder() / "r/run.json"));
  ASSERT_EQ(json.at("bodies").size(), 2u);
  EXPECT_EQ(json.at("bodies")[1].at("name"), "upper");
  EXPECT_EQ(json.at("bodies")[1].at("nodes"), 10);
  EXPECT_EQ(json.at("bodies")[1].at("triangles"), 8);
  EXPECT_EQ(json.at("bodies")[1].at("materials"), nlohmann::json::array({0}));
  ASSERT_EQ(json.at("materials").size(), 1u);
  EXPECT_EQ(json.at("materials")[0].at("triangles"), 16);
  EXPECT_EQ(json.at("materials")[0].at("maxwell")[0].at("mu_vis"), 2.0);
}

TEST_F(Bodies, HistoryHasTheProbesOfAll) {
  ASSERT_EQ(rheo({"run", "two.toml", "-o", "r"}).exit_code, 0);
  const std::string header = lines_of(read_text(folder() / "r/history.csv"))[0];
  EXPECT_THAT(header, AllOf(HasSubstr("lower_ux"), HasSubstr("upper_ux")));
}

TEST_F(Bodies, CheckPrintsEach) {
  const Finished finished = rheo({"check", "two.toml"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("lower: 10 nodes, 8 triangles"),
                                  HasSubstr("upper: 10 nodes, 8 triangles"), HasSubstr("relaxation time")));
}

TEST_F(Bodies, DivergenceNamesTheBody) {
  const Finished finished = rheo({"run", "two.toml", "-o", "r", "--step", "0.5", "--frame-rate", "1",
                                  "--duration", "100", "--allow-unstable"});
  EXPECT_EQ(finished.exit_code, 3);
  EXPECT_THAT(finished.err, testing::AnyOf(HasSubstr(" of lower (at rest"), HasSubstr(" of upper (at rest")));
}

TEST_F(Bodies, OneBodyHasNoColumn) {
  write("beam.toml", small_beam());
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "r"}).exit_code, 0);
  EXPECT_THAT(lines_of(read_text(folder() / "r/state.csv"))[0], Not(HasSubstr("body")));
}

TEST_F(Bodies, TheSheetShowsTheTimesThatTheSceneAsksFor) {
  write("beam.toml", small_beam_with("[render]", "[render]\nsheet = [0.0, 0.2, 0.5]"));
  EXPECT_EQ(rheo({"render", "beam.toml", "-o", "r"}).exit_code, 0);
  write("bad.toml", small_beam_with("[render]", "[render]\nsheet = [0.2, 0.1]"));
  expect_failure(rheo({"check", "bad.toml"}), 2, {"bad.toml:", "[render] sheet", "strictly rising"});
  write("captions.toml", small_beam_with("[render]", "[render]\nsheet = [0.0, [0.2, \"pulled\"], [0.5]]"));
  expect_failure(rheo({"check", "captions.toml"}), 2,
                 {"captions.toml:", "[render] sheet", "[time, \"caption\"]"});
  write("late.toml", small_beam_with("[render]", "[render]\nsheet = [0.0, 0.6]"));
  expect_failure(rheo({"check", "late.toml"}), 2, {"late.toml:", "[render] sheet", "0.5 s"});
}

// The same two branches in the other order, the same one coloured: the same pictures.
TEST_F(Bodies, TheBranchAskedForIsWhatIsColoured) {
  const auto beam = [](const std::string& first, const std::string& second) {
    return small_beam_with(
        "lambda_ela = 7.0\nmu_ela = 5.0\nlambda_vis = 4.0\nmu_vis = 2.0\ndensity = 0.2\n",
        "density = 0.2\n[[material.maxwell]]\n" + first + "[[material.maxwell]]\n" + second);
  };
  const std::string slow = "lambda_ela = 7.0\nmu_ela = 5.0\nlambda_vis = 40.0\nmu_vis = 20.0\n";
  const std::string fast = "lambda_ela = 3.0\nmu_ela = 4.0\nlambda_vis = 0.4\nmu_vis = 0.3\n";
  write("a.toml", beam(slow, fast));
  write("b.toml", beam(fast, slow));
  const auto frame = [&](const std::string& scene, const std::string& branch) {
    const std::string out = scene + branch;
    const Finished finished = rheo({"render", scene + ".toml", "-o", out, "--color", "w_mu", "--branch",
                                    branch, "--step", "1e-3", "--force"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    // All but the colour bar, which tells the branch.
    const render::Image image = read_png(folder() / out / "frames/frame_00008.png");
    std::vector<unsigned char> pixels;
    for (int y = 0; y < image.height; ++y) {
      const auto row = image.rgba.begin() + static_cast<std::ptrdiff_t>(4 * image.width) * y;
      pixels.insert(pixels.end(), row, row + 4 * (3 * image.width / 4));
    }
    return pixels;
  };
  EXPECT_EQ(frame("a", "1"), frame("b", "2"));
  EXPECT_EQ(frame("a", "2"), frame("b", "1"));
  EXPECT_NE(frame("a", "1"), frame("a", "2"));
  EXPECT_NE(frame("a", "0"), frame("a", "1"));
}

TEST_F(Bodies, ABranchThatIsNotThereIsRefused) {
  write("beam.toml", small_beam());
  expect_failure(rheo({"render", "beam.toml", "--branch", "2"}), 2, {"--branch '2'", "1 Maxwell branch"});
  expect_failure(rheo({"render", "beam.toml", "--branch", "-1"}), 2, {"--branch"});
}

}  // namespace
}  // namespace app_tests
