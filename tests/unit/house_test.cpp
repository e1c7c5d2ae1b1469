// The rules of the house, read from the sources: who may include whom.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace rheo::test {
namespace {

namespace fs = std::filesystem;

// Lines of the C++ files below a folder that match, as "file:line: text".
std::vector<std::string> matches(const std::string& folder, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(RHEO_SOURCE_DIR) / folder)) {
    const auto extension = entry.path().extension();
    if (extension != ".cpp" && extension != ".hpp" && extension != ".h" && extension != ".in") continue;
    ++files;
    std::ifstream in(entry.path());
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      if (std::regex_search(line, expression)) {
        found.push_back(entry.path().string() + ":" + std::to_string(number) + ": " + line);
      }
    }
  }
  EXPECT_GT(files, 0) << folder;
  return found;
}

const std::string include = R"(^\s*#\s*include\s*[<"])";

TEST(House, EngineKnowsNoPicturesNoWindowNoProgram) {
  EXPECT_EQ(matches("engine", include + R"((render/|app/|GL/|GLES|EGL/|GLFW/|imgui|stb|CLI/|nlohmann))"),
            std::vector<std::string>{});
}

TEST(House, EngineWritesToNoTerminal) {
  EXPECT_EQ(matches("engine", R"(\b(std::cout|std::cerr|std::clog|printf\s*\(|fmt::print|puts\s*\(|isatty))"),
            std::vector<std::string>{});
}

TEST(House, RendererKnowsNoEngine) {
  EXPECT_EQ(matches("render", include + R"((rheo/|app/|Eigen|toml))"), std::vector<std::string>{});
  EXPECT_EQ(matches("render", R"(\brheo::)"), std::vector<std::string>{});
}

TEST(House, PublicHeadersOfTheEngineNeedNothingButTheStandardLibrary) {
  EXPECT_EQ(matches("engine/include", include + R"((Eigen|fmt|toml|unsupported))"), std::vector<std::string>{});
}

TEST(House, OnlyOneTranslationUnitReadsEachHeavyHeader) {
  EXPECT_LE(matches("engine", include + R"(toml)").size(), 1u);
  EXPECT_LE(matches("app", include + R"(CLI/)").size(), 1u);
  EXPECT_LE(matches("app", include + R"(nlohmann)").size(), 1u);
  EXPECT_LE(matches("render", include + R"(stb)").size(), 1u);
}

}  // namespace
}  // namespace rheo::test
