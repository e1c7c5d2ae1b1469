// The rules of the house, read from the sources: who may include whom.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace rheo::test {
namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

struct Line {
  std::string text;
  std::string where;  // file:line
};

std::vector<Line> lines_below(const std::string& folder) {
  std::vector<Line> lines;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(RHEO_SOURCE_DIR) / folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".cpp" && extension != ".hpp" && extension != ".h") continue;
    std::ifstream in(entry.path());
    std::string text;
    for (int number = 1; std::getline(in, text); ++number) {
      lines.push_back({text, entry.path().string() + ":" + std::to_string(number)});
    }
  }
  EXPECT_FALSE(lines.empty()) << folder;
  return lines;
}

// What follows `#include <` or `#include "`; empty for other lines.
std::string included(const std::string& line) {
  const std::size_t hash = line.find_first_not_of(" \t");
  if (hash == std::string::npos || line[hash] != '#') return {};
  const std::size_t word = line.find("include", hash);
  const std::size_t open = line.find_first_of("<\"", hash);
  if (word == std::string::npos || open == std::string::npos || word > open) return {};
  return line.substr(open + 1);
}

// Includes below a folder that begin with one of the texts.
Strings includes(const std::string& folder, const Strings& texts) {
  Strings found;
  for (const Line& line : lines_below(folder)) {
    const std::string header = included(line.text);
    const bool hit = std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
      return !header.empty() && header.starts_with(text);
    });
    if (hit) found.push_back(line.where + ": " + header);
  }
  return found;
}

// Lines below a folder that contain one of the texts.
Strings uses(const std::string& folder, const Strings& texts) {
  Strings found;
  for (const Line& line : lines_below(folder)) {
    const bool hit = std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
      return line.text.find(text) != std::string::npos;
    });
    if (hit) found.push_back(line.where + ": " + line.text);
  }
  return found;
}

// How many files below a folder include a header that begins with the text.
std::size_t readers(const std::string& folder, const std::string& text) {
  Strings files = includes(folder, {text});
  for (std::string& file : files) file.resize(file.find(':'));
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files.size();
}

const Strings none;

TEST(House, EngineKnowsNoPicturesNoWindowNoProgram) {
  EXPECT_EQ(includes("engine",
                     {"render/", "app/", "GL/", "GLES", "EGL/", "GLFW/", "imgui", "stb", "CLI/", "nlohmann"}),
            none);
}

TEST(House, EngineWritesToNoTerminal) {
  EXPECT_EQ(uses("engine", {"std::cout", "std::cerr", "std::clog", " printf(", "std::printf", "fmt::print",
                            "puts(", "isatty"}),
            none);
}

TEST(House, RendererKnowsNoEngine) {
  EXPECT_EQ(includes("render", {"rheo/", "app/", "Eigen", "toml"}), none);
  EXPECT_EQ(uses("render", {"rheo::"}), none);
}

TEST(House, PublicHeadersOfTheEngineNeedNothingButTheStandardLibrary) {
  EXPECT_EQ(includes("engine/include", {"Eigen", "fmt", "toml", "unsupported"}), none);
}

TEST(House, HeavyHeadersAreReadWhereTheyAreNeededOnly) {
  EXPECT_EQ(readers("engine", "toml++"), 1u);
  EXPECT_EQ(readers("app", "CLI/CLI"), 1u);
  EXPECT_EQ(readers("app", "nlohmann"), 2u);  // run.json is written in one place and read back in another
  EXPECT_EQ(readers("render", "stb"), 1u);
}

}  // namespace
}  // namespace rheo::test
