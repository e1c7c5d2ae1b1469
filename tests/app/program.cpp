#include "program.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

namespace app_tests {
namespace {

constexpr const char* out_name = ".stdout";
constexpr const char* err_name = ".stderr";

}  // namespace

void ProgramTest::SetUp() {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  folder_ = fs::path(RHEO_TEST_OUTPUT) / (std::string(test->test_suite_name()) + "." + test->name());
  fs::remove_all(folder_);
  fs::create_directories(folder_);
}

fs::path ProgramTest::write(const std::string& name, const std::string& text) const {
  const fs::path path = folder_ / name;
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

Finished ProgramTest::rheo(const std::vector<std::string>& arguments,
                           const std::map<std::string, std::string>& environment) const {
  const std::string out = folder_ / out_name, err = folder_ / err_name;
  std::vector<std::string> words{RHEO_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const pid_t child = fork();
  if (child == 0) {
    const int out_file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (chdir(folder_.c_str()) != 0 || dup2(out_file, 1) < 0 || dup2(err_file, 2) < 0) _exit(126);
    // Drivers leak at exit, inside libraries that are gone by then; ours is covered by the commands without
    // them.
    if (!arguments.empty() && (arguments[0] == "render" || arguments[0] == "bench"))
      setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    execv(RHEO_PROGRAM, argv.data());
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
}

std::vector<std::string> ProgramTest::files() const {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_))
    if (const std::string name = fs::relative(entry.path(), folder_); name != out_name && name != err_name)
      names.push_back(name);
  std::ranges::sort(names);
  return names;
}

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::map<std::string, std::vector<double>> read_table(const fs::path& file) {
  const std::vector<std::string> lines = lines_of(read_text(file));
  std::map<std::string, std::vector<double>> table;
  if (lines.empty()) {
    ADD_FAILURE() << file << " is empty or absent";
    return table;
  }
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
  };
  const std::vector<std::string> names = cells_of(lines[0]);
  for (std::size_t row = 1; row < lines.size(); ++row) {
    const std::vector<std::string> cells = cells_of(lines[row]);
    EXPECT_EQ(cells.size(), names.size()) << file << " row " << row;
    for (std::size_t i = 0; i < std::min(cells.size(), names.size()); ++i) {
      table[names[i]].push_back(std::stod(cells[i]));
      EXPECT_TRUE(std::isfinite(table[names[i]].back())) << file << " row " << row << " " << names[i];
    }
  }
  return table;
}

std::string small_beam() {
  return R"(title = "Small beam"

[mesh]
shape = "rectangle"
size = [1.0, 0.25]
nodes = [5, 2]

[material]
lambda_ela = 7.0
mu_ela = 5.0
lambda_vis = 4.0
mu_vis = 2.0
density = 0.2

[[fix]]
edges = "left"

[[traction]]
edges = "right"
vector = [5.0, 0.0]
until = 0.2

[[probe]]
name = "grip"
edges = "right"

[time]
duration = 0.5
frame_rate = 20

[render]
size = [320, 180]
)";
}

std::string small_beam_with(const std::string& old_text, const std::string& new_text) {
  std::string text = small_beam();
  const std::size_t at = text.find(old_text);
  if (at == std::string::npos)
    ADD_FAILURE() << "the small beam has no '" << old_text << "'";
  else
    text.replace(at, old_text.size(), new_text);
  return text;
}

void expect_failure(const Finished& finished, int exit_code, const std::vector<std::string>& parts) {
  EXPECT_EQ(finished.exit_code, exit_code) << finished.err;
  EXPECT_THAT(finished.err, testing::StartsWith("rheo: "));
  EXPECT_EQ(lines_of(finished.err).size(), 1u) << finished.err;
  EXPECT_THAT(finished.err, testing::EndsWith("\n"));
  for (const std::string& part : parts) EXPECT_THAT(finished.err, testing::HasSubstr(part));
}

}  // namespace app_tests
