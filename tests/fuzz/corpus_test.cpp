// What fuzzing has gathered, read again in every build: all of the corpus, and each finding by its name.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "feed.hpp"

namespace rheo::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path here = fs::path(RHEO_SOURCE_DIR) / "tests" / "fuzz";

struct Reader {
  const char* name;
  const char* seeds;  // what fuzzing begins with, beside the corpus
  Verdict (*feed)(std::string_view, const Sandbox&);
};
const Reader readers[] = {{"scene", "app/scenes", feed_scene},
                          {"mesh", "tests/data/msh", feed_mesh},
                          {"command_line", "tests/fuzz/corpus/command_line", feed_command_line}};

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Help is printed where it is asked for.
Verdict fed(const Reader& reader, const fs::path& file, const Sandbox& sandbox) {
  ::testing::internal::CaptureStdout();
  Verdict verdict = Verdict::refused;
  try {
    verdict = reader.feed(bytes_of(file), sandbox);
  } catch (const Finding& finding) {
    ADD_FAILURE() << file << ": " << finding.what();
  }
  ::testing::internal::GetCapturedStdout();
  return verdict;
}

class Corpus : public ::testing::TestWithParam<Reader> {};

void PrintTo(const Reader& reader, std::ostream* out) {
  *out << reader.name;
}

TEST_P(Corpus, IsReadOrRefusedInOneLine) {
  const Sandbox sandbox;
  int accepted = 0, refused = 0;
  std::vector<fs::path> files = files_in(here / "corpus" / GetParam().name);
  for (const fs::path& seed : files_in(fs::path(RHEO_SOURCE_DIR) / GetParam().seeds)) files.push_back(seed);
  for (const fs::path& file : files)
    ++(fed(GetParam(), file, sandbox) == Verdict::accepted ? accepted : refused);
  // Both sides of the reader are in it.
  EXPECT_GT(accepted, 5);
  EXPECT_GT(refused, 5);
}

INSTANTIATE_TEST_SUITE_P(Of, Corpus, ::testing::ValuesIn(readers),
                         [](const auto& suite) { return std::string(suite.param.name); });

// findings/<reader>/<what_was_wrong>
struct Found {
  Reader reader;
  fs::path file;
};

void PrintTo(const Found& found, std::ostream* out) {
  *out << found.file.filename();
}

std::vector<Found> all_found() {
  std::vector<Found> all;
  for (const Reader& reader : readers)
    for (const fs::path& file : files_in(here / "findings" / reader.name)) all.push_back({reader, file});
  return all;
}

class Findings : public ::testing::TestWithParam<Found> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Findings);

TEST_P(Findings, StaysMended) {
  const Sandbox sandbox;
  fed(GetParam().reader, GetParam().file, sandbox);
}

INSTANTIATE_TEST_SUITE_P(Of, Findings, ::testing::ValuesIn(all_found()), [](const auto& suite) {
  return std::string(suite.param.reader.name) + "_" + suite.param.file.stem().string();
});

}  // namespace
}  // namespace rheo::fuzz
