// The folder of a run's results: checked and made before the simulation, never cleared of foreign files.
//
//   state.csv history.csv run.json sheet.png residual.png frames/frame_00000.png ... vtu/state_00000.vtu ...
//   vtu/state.pvd
//
// Errors   Failure(usage): it holds files already and Replace::nothing was asked for; Failure(file): it is no
// folder, or
//          cannot be made, read or written
// Not here writing the files themselves
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace app {

enum class Replace {
  nothing,     // only an empty or a new folder will do
  earlier_run  // files with the names above, and their unfinished ".part", are removed; all others stay
};

class OutputFolder {
 public:
  OutputFolder(std::filesystem::path folder, Replace replace);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder();  // folders that were made here and stayed empty are removed again

  const std::filesystem::path& path() const { return folder_; }

  // The path of a file named as above; subfolders are made when first used.
  std::filesystem::path file(const std::string& name);
  // Notes that a file is complete.
  void made(const std::string& name) { made_.push_back(name); }
  const std::vector<std::string>& all_made() const { return made_; }

 private:
  void make(const std::filesystem::path& folder);

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> new_folders_;
  std::vector<std::string> made_;
};

// "frames/frame_00042.png", "vtu/state_00042.vtu"
std::string frame_name(std::int64_t k);
std::string vtu_name(std::int64_t k);

// A file without a name in `folder`: gone when closed, whatever happens. Returns its descriptor.
int open_unnamed_file(const std::filesystem::path& folder);

}  // namespace app
