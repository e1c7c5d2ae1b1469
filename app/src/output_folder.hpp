// The folder of a run's results: checked and made before the simulation, never cleared of foreign files.
//
// Whose file it is, is known from the earlier run.json alone: without it only unfinished files are removed,
// and a file in the place of a result is replaced when that result is complete. A run writes run.json when it
// begins too, with exit_status null and the files to come, so that what an interrupted one has left is known.
//
//   state.csv history.csv run.json sheet.png residual.png frames/frame_00000.png ... vtu/state_00000.vtu ...
//   vtu/state.pvd checkpoint.rheo positions.bin (while unfinished) bench.csv bench.png relaxation.csv
//   relaxation.png moduli.csv moduli.png fit.png
//
// Errors   Failure(usage): it holds files already and Replace::nothing was asked for; Failure(file): it is no
//          folder, or cannot be made, read or written, or a folder is in the place of a result, or another
//          rheo writes into it now
// Not here writing the files themselves
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace app {

enum class Replace {
  nothing,      // only an empty or a new folder will do
  earlier_run,  // what an earlier run.json lists, and unfinished ".part" files, go; all others stay
  cut_run       // likewise, but of a run that has not ended; or nothing goes and it is gone on with
};

// What run.json tells of the run before.
struct EarlierRun {
  std::vector<std::string> files;  // made or, of an unfinished run, to come
  std::optional<int> exit_status;  // nothing: it was killed, or goes on

  // Killed, or told to stop.
  bool is_cut() const { return !exit_status || *exit_status >= 128; }
};
// Nothing where there is no run.json, or something else's.
std::optional<EarlierRun> find_earlier_run(const std::filesystem::path& folder);

class OutputFolder {
 public:
  OutputFolder(std::filesystem::path folder, Replace replace);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder();  // folders that were made here and stayed empty are removed again

  const std::filesystem::path& path() const { return folder_; }

  // The path of a file named as above; subfolders are made when first used.
  std::filesystem::path file(const std::string& name);
  // Makes the subfolder of a series whose first file is given; a folder in the place of one of its files is
  // refused.
  void expect_series(const std::string& first);
  // Removes the earlier run's files. Everything that may refuse the new run comes before.
  void clear();
  // Or goes on with the earlier run: its files stay, but for the unfinished ones that are not named.
  void adopt(const std::vector<std::string>& parts);
  // Whether a file of the adopted run is there.
  bool has_own(const std::string& name) const;
  // Refuses where the folder was removed meanwhile.
  void require_presence() const;
  // Those of the names at which nothing stands, or a file of the adopted run: what else is there now, after
  // clear(), is somebody else's.
  std::vector<std::string> free_of(std::vector<std::string> names) const;
  // Notes that a file is complete.
  void made(const std::string& name) { made_.push_back(name); }
  const std::vector<std::string>& all_made() const { return made_; }

 private:
  void make(const std::filesystem::path& folder);
  void lock();

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> new_folders_;
  std::vector<std::filesystem::path> ready_;  // subfolders that were made: one that is gone stays away
  std::vector<std::string> stale_;            // files of the earlier run, named as above
  std::vector<std::string> own_;              // of the adopted run, sorted
  int lock_ = -1;
  std::vector<std::string> made_;
};

// "frames/frame_00042.png", "vtu/state_00042.vtu"
std::string frame_name(std::int64_t k);
std::string vtu_name(std::int64_t k);

}  // namespace app
