// The command render: a frame per output, the sheet, the plot; the same pictures whatever draws and encodes
// them.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "render/decode.hpp"

namespace app_tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

class Render : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("beam.toml", small_beam());
  }

  Finished render(const std::string& out, std::vector<std::string> options = {}) {
    options.insert(options.begin(), {"render", "beam.toml", "-o", out});
    Finished finished = rheo(options);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return finished;
  }

  std::vector<std::string> frames(const std::string& out) const {
    std::vector<std::string> names;
    for (const std::string& name : files())
      if (name.starts_with(out + "/frames/")) names.push_back(name);
    return names;
  }
};

// Width and height in a PNG's header (ISO 15948: after the signature, the length and "IHDR").
std::pair<std::uint32_t, std::uint32_t> png_size(const std::string& bytes) {
  EXPECT_THAT(bytes, StartsWith("\x89PNG\r\n\x1a\n"));
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(i));
    return value;
  };
  return {number(16), number(20)};
}

TEST_F(Render, WritesAFramePerOutputTheSheetThePlotAndWhatRunWrites) {
  const Finished finished = render("r");
  EXPECT_EQ(finished.err, "");
  EXPECT_THAT(frames("r"),
              AllOf(SizeIs(11), Contains("r/frames/frame_00000.png"), Contains("r/frames/frame_00010.png")));
  EXPECT_THAT(files(),
              AllOf(Contains("r/sheet.png"), Contains("r/residual.png"), Contains("r/state.csv"),
                    Contains("r/history.csv"), Contains("r/run.json"), Not(Contains(HasSubstr(".part")))));
  for (const char* part :
       {"r/sheet.png", "r/residual.png", "frame_00000.png ... frame_00010.png (11 files)", "frames/s"})
    EXPECT_THAT(finished.out, HasSubstr(part));
  const auto json = nlohmann::json::parse(read_text(folder() / "r/run.json"));
  EXPECT_THAT(json.at("files").dump(), HasSubstr("frames/frame_00010.png"));
  EXPECT_TRUE(json.at("settings").at("renderer").is_string());
  EXPECT_GT(json.at("seconds").at("draw").get<double>(), 0.0);
}

TEST_F(Render, NumbersAreThoseOfRun) {
  render("drawn");
  ASSERT_EQ(rheo({"run", "beam.toml", "-o", "plain"}).exit_code, 0);
  for (const char* name : {"state.csv", "history.csv"})
    EXPECT_EQ(read_text(folder() / "drawn" / name), read_text(folder() / "plain" / name)) << name;
}

TEST_F(Render, PicturesHaveTheSceneSizeOrTheOneAskedFor) {
  render("scene");
  render("asked", {"--size", "240x160"});
  EXPECT_EQ(png_size(read_text(folder() / "scene/frames/frame_00003.png")), std::pair(320u, 180u));
  EXPECT_EQ(png_size(read_text(folder() / "asked/frames/frame_00003.png")), std::pair(240u, 160u));
}

TEST_F(Render, FramesDoNotDependOnThreadsOrRepetition) {
  render("one", {"--threads", "1"});
  render("three", {"--threads", "3"});
  ASSERT_THAT(frames("one"), SizeIs(11));
  for (const std::string& name : frames("one"))
    EXPECT_EQ(read_text(folder() / name), read_text(folder() / ("three" + name.substr(3)))) << name;
  for (const char* name : {"sheet.png", "residual.png"})
    EXPECT_EQ(read_text(folder() / "one" / name), read_text(folder() / "three" / name)) << name;
}

TEST_F(Render, OsmesaAndEglDrawTheSame) {
  render("osmesa", {"--backend", "osmesa"});
  render("egl", {"--backend", "egl"});
  ASSERT_THAT(frames("egl"), SizeIs(11));
  // One Mesa behind both: the same rasteriser, the same bytes.
  for (const std::string& name : frames("egl"))
    EXPECT_EQ(read_text(folder() / name), read_text(folder() / ("osmesa" + name.substr(3)))) << name;
  const auto json = nlohmann::json::parse(read_text(folder() / "egl/run.json"));
  EXPECT_THAT(json.at("settings").at("renderer").get<std::string>(), HasSubstr("EGL"));
}

TEST_F(Render, ColourAndRangeChangeThePicture) {
  render("w_lambda");
  const std::string reference = read_text(folder() / "w_lambda/frames/frame_00004.png");
  for (const char* color : {"w_mu", "w", "speed", "none"}) {
    render(color, {"--color", color});
    EXPECT_NE(read_text(folder() / color / "frames/frame_00004.png"), reference) << color;
  }
  render("range", {"--range", "0,100"});
  EXPECT_NE(read_text(folder() / "range/frames/frame_00004.png"), reference);
}

// A beam that is pulled to a multiple of its length: every frame shows all of it, on one scale of colours.
TEST_F(Render, OneCameraAndOneRangeHoldForTheWholeSequence) {
  write("beam.toml", small_beam_with("vector = [5.0, 0.0]\nuntil = 0.2", "vector = [40.0, 0.0]"));
  render("r", {"--frame-rate", "10"});
  const std::vector<std::string> names = frames("r");
  ASSERT_GE(names.size(), 4u);
  std::vector<render::Image> images;
  for (const std::string& name : names) images.push_back(read_png(folder() / name));
  const int width = images[0].width, height = images[0].height;
  const auto pixel = [&](const render::Image& image, int x, int y) {
    const std::size_t at =
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return std::array<int, 3>{image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]};
  };
  // The colour bar and its numbers stand on the right below the heading; that they are looked at: not all is
  // paper.
  int ink = 0;
  for (int y = height / 4; y < height; ++y) {
    for (int x = 9 * width / 10; x < width; ++x) {
      for (const render::Image& image : images)
        ASSERT_EQ(pixel(image, x, y), pixel(images[0], x, y)) << x << ' ' << y;
      ink += pixel(images[0], x, y) != pixel(images[0], 0, 0) ? 1 : 0;
    }
  }
  EXPECT_GT(ink, 100);
  for (const render::Image& image : images) {
    for (int x = 0; x < width; ++x)
      for (const int y : {0, height - 1})
        ASSERT_EQ(pixel(image, x, y), pixel(images[0], 0, 0)) << x << ' ' << y;
    for (int y = 0; y < height; ++y)
      for (const int x : {0, width - 1})
        ASSERT_EQ(pixel(image, x, y), pixel(images[0], 0, 0)) << x << ' ' << y;
  }
}

TEST_F(Render, DrawsTheFramesBeforeADivergence) {
  write("late.toml", small_beam_with("until = 0.2", "from = 3.5\nuntil = 9"));
  // At rest until the load at 3.5 s; then every step of 0.5 s multiplies the error.
  const Finished finished = rheo({"render", "late.toml", "-o", "r", "--step", "0.5", "--frame-rate", "1",
                                  "--duration", "100", "--allow-unstable", "--backend", "osmesa"});
  expect_failure(finished, 3, {"diverged"});
  EXPECT_GE(frames("r").size(), 4u);
  EXPECT_EQ(frames("r").size(), read_table(folder() / "r/history.csv")["t"].size());
  EXPECT_THAT(files(),
              AllOf(Contains("r/sheet.png"), Contains("r/residual.png"), Not(Contains("r/state.csv"))));
}

// Fewer frames, and all else as it was: their range, their place, the sheet of all outputs, the tables.
TEST_F(Render, EveryThirdOutputAndTheLastAreTheFramesOfAll) {
  render("all");
  const Finished finished = render("some", {"--every", "3"});
  EXPECT_THAT(finished.out, HasSubstr("frame_00000.png ... frame_00004.png (5 files)"));
  ASSERT_THAT(frames("some"), SizeIs(5));
  int number = 0;
  for (const char* output : {"0", "3", "6", "9", "10"}) {
    const std::string there = fmt::format("all/frames/frame_{:0>5}.png", output);
    EXPECT_EQ(read_text(folder() / fmt::format("some/frames/frame_{:05}.png", number++)),
              read_text(folder() / there))
        << there;
  }
  for (const char* name : {"sheet.png", "residual.png", "state.csv", "history.csv"})
    EXPECT_EQ(read_text(folder() / "some" / name), read_text(folder() / "all" / name)) << name;
  const auto json = nlohmann::json::parse(read_text(folder() / "some/run.json"));
  EXPECT_EQ(json.at("settings").at("every"), 3);
  EXPECT_EQ(json.at("outputs"), 11);

  // As the scene says; the command line goes before it. The series for ParaView is of all outputs.
  write("beam.toml", small_beam_with("[render]", "[render]\nevery = 100"));
  render("ends", {"--vtu"});
  EXPECT_THAT(frames("ends"), ElementsAre("ends/frames/frame_00000.png", "ends/frames/frame_00001.png"));
  EXPECT_EQ(read_text(folder() / "ends/frames/frame_00001.png"),
            read_text(folder() / "all/frames/frame_00010.png"));
  EXPECT_THAT(files(), Contains("ends/vtu/state_00010.vtu"));
  render("told", {"--every", "1"});
  EXPECT_THAT(frames("told"), SizeIs(11));
}

TEST_F(Render, TheLastOutputBeforeADivergenceHasAFrame) {
  write("late.toml", small_beam_with("until = 0.2", "from = 3.5\nuntil = 9"));
  const std::vector<std::string> diverging{"render",           "late.toml", "--step",     "0.5",
                                           "--frame-rate",     "1",         "--duration", "100",
                                           "--allow-unstable", "--backend", "osmesa"};
  const auto run = [&](const std::string& out, const std::string& every) {
    std::vector<std::string> words = diverging;
    words.insert(words.end(), {"-o", out, "--every", every});
    expect_failure(rheo(words), 3, {"diverged"});
  };
  run("all", "1");
  run("some", "1000");
  const std::vector<std::string> all = frames("all");
  ASSERT_THAT(frames("some"), SizeIs(2));
  EXPECT_EQ(read_text(folder() / "some/frames/frame_00000.png"), read_text(folder() / all.front()));
  EXPECT_EQ(read_text(folder() / "some/frames/frame_00001.png"), read_text(folder() / all.back()));
  EXPECT_THAT(files(), Contains("some/sheet.png"));
}

// 5,001 frames: far more than are drawn before the kill.
TEST_F(Render, AKilledOneLeavesNoFrameAmongTheNextOnes) {
  rheo_killed_at("r/frames/frame_00003.png",
                 {"render", "beam.toml", "-o", "r", "--frame-rate", "1e4", "--size", "240x160"});
  expect_failure(rheo({"render", "beam.toml", "-o", "r"}), 2, {"r: ", "interrupted run", "--force"});
  render("r", {"--frame-rate", "4", "--force"});
  EXPECT_THAT(frames("r"), ElementsAre("r/frames/frame_00000.png", "r/frames/frame_00001.png",
                                       "r/frames/frame_00002.png"));
}

TEST_F(Render, QuietIsSilent) {
  const Finished finished = render("r", {"--quiet"});
  EXPECT_EQ(finished.out + finished.err, "");
}

TEST_F(Render, ABranchThatIsOffHasNothingToColour) {
  write("beam.toml", small_beam_with("lambda_ela = 7.0", "lambda_ela = 0.0"));
  const Finished finished = render("w_lambda");
  EXPECT_THAT(finished.out, HasSubstr("note: w_lambda is zero everywhere"));
  render("none", {"--color", "none"});
  EXPECT_EQ(read_text(folder() / "w_lambda/frames/frame_00004.png"),
            read_text(folder() / "none/frames/frame_00004.png"));
  EXPECT_THAT(read_text(folder() / "w_lambda/run.json"), HasSubstr("nothing to colour"));
  EXPECT_THAT(render("w_mu", {"--color", "w_mu"}).out, Not(HasSubstr("nothing to colour")));
}

TEST_F(Render, ARestingSceneIsDrawnToo) {
  write("rest.toml", small_beam_with("vector = [5.0, 0.0]", "vector = [0.0, 0.0]"));
  const Finished finished = rheo({"render", "rest.toml", "-o", "r"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(frames("r"), SizeIs(11));
}

}  // namespace
}  // namespace app_tests
