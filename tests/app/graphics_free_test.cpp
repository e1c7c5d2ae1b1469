// A run without frames touches no graphics library: the program is linked to none, and `run` opens none.
#include <gmock/gmock.h>

#include <cstdio>

#include "program.hpp"

namespace app_tests {
namespace {

class GraphicsFree : public ProgramTest {
 protected:
  // The lines that name a library which draws, in the dynamic loader's words.
  static std::vector<std::string> graphics_in(const std::string& text) {
    std::vector<std::string> found;
    for (const std::string& line : lines_of(text))
      for (const char* name : {"libGL", "libEGL", "libOpenGL", "libOSMesa", "libglapi", "libgbm", "libX11",
                               "libxcb", "libwayland", "libglfw", "libLLVM", "libgallium"})
        if (line.find(name) != std::string::npos) found.push_back(line);
    return found;
  }

  // The loader's log of one command, over all its processes.
  std::string loader_log(const std::vector<std::string>& arguments) {
    const fs::path log = folder() / "loader";
    const Finished finished = rheo(arguments, {{"LD_DEBUG", "libs"}, {"LD_DEBUG_OUTPUT", log.string()}});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    std::string text;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder()))
      if (entry.path().filename().string().starts_with("loader.")) {
        text += read_text(entry.path());
        fs::remove(entry.path());
      }
    EXPECT_THAT(text, testing::HasSubstr("libc.so"));  // the log is one
    return text;
  }
};

TEST_F(GraphicsFree, TheProgramIsLinkedToNoGraphicsLibrary) {
  std::FILE* ldd = popen("ldd '" RHEO_PROGRAM "'", "r");
  ASSERT_NE(ldd, nullptr);
  std::string text;
  for (int c = std::fgetc(ldd); c != EOF; c = std::fgetc(ldd)) text += static_cast<char>(c);
  pclose(ldd);
  EXPECT_THAT(text, testing::HasSubstr("libc.so"));
  EXPECT_THAT(graphics_in(text), testing::IsEmpty());
}

TEST_F(GraphicsFree, RunAndCheckOpenNone) {
  write("beam.toml", small_beam());
  EXPECT_THAT(graphics_in(loader_log({"run", "beam.toml", "--vtu"})), testing::IsEmpty());
  EXPECT_THAT(graphics_in(loader_log({"check", "beam.toml"})), testing::IsEmpty());
}

TEST_F(GraphicsFree, CheckOfMeasuredDataOpensNone) {
  write("data.csv", "1,4\n2,3\n3,2.5\n4,2.2\n");
  write("beam.toml", small_beam_with("lambda_ela = 7.0\nmu_ela = 5.0\nlambda_vis = 4.0\nmu_vis = 2.0",
                                     "relaxation = \"data.csv\"\npoisson = 0.3"));
  EXPECT_THAT(graphics_in(loader_log({"check", "beam.toml"})), testing::IsEmpty());
}

#ifdef RHEO_HAS_RENDERER
TEST_F(GraphicsFree, RenderOpensOneWhichShowsThatTheLogWouldTell) {
  write("beam.toml", small_beam());
  EXPECT_THAT(graphics_in(loader_log({"render", "beam.toml"})), testing::Not(testing::IsEmpty()));
}
#endif

}  // namespace
}  // namespace app_tests
