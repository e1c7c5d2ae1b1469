// Runs the built program as a user would and looks at what it leaves behind.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace app_tests {

namespace fs = std::filesystem;

struct Finished {
  int exit_code = -1;  // -1: ended by a signal
  std::string out;
  std::string err;
};

// A folder of its own for every test, empty at the start; the program's current folder.
class ProgramTest : public testing::Test {
 protected:
  void SetUp() override;

  const fs::path& folder() const { return folder_; }
  fs::path write(const std::string& name, const std::string& text) const;
  Finished rheo(const std::vector<std::string>& arguments,
                const std::map<std::string, std::string>& environment = {}) const;
  // Kills the program as soon as `file`, a path in the test's folder, exists.
  void rheo_killed_at(const std::string& file, const std::vector<std::string>& arguments) const;
  // Every file below the test's folder, as relative paths, sorted; the helper's own files not among them.
  std::vector<std::string> files() const;

 private:
  int start(const std::vector<std::string>& arguments,
            const std::map<std::string, std::string>& environment) const;

  fs::path folder_;
};

std::string read_text(const fs::path& file);
std::vector<std::string> lines_of(const std::string& text);

// A CSV file's columns by name; every number must be finite.
std::map<std::string, std::vector<double>> read_table(const fs::path& file);

// A beam of 10 nodes, pulled for 0.2 s of its 0.5 s, 11 outputs.
std::string small_beam();
// The same with one text replaced by another, which must be there.
std::string small_beam_with(const std::string& old_text, const std::string& new_text);

// Exit code, one line on standard error that begins "rheo: " and contains the parts, nothing half-written.
void expect_failure(const Finished& finished, int exit_code, const std::vector<std::string>& parts);

}  // namespace app_tests
