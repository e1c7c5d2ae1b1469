#include "output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "failure.hpp"

namespace app {
namespace fs = std::filesystem;
namespace {

constexpr std::array<std::string_view, 14> top_names{
    "state.csv", "history.csv",    "run.json",        "sheet.png",      "residual.png",
    "bench.csv", "bench.png",      "moduli.csv",      "relaxation.csv", "moduli.png",
    "fit.png",   "relaxation.png", "checkpoint.rheo", "positions.bin"};

std::string_view without_part(std::string_view name) {
  constexpr std::string_view part = ".part";
  if (name.ends_with(part)) name.remove_suffix(part.size());
  return name;
}

// PREFIX, at least `digits` digits, SUFFIX
bool is_numbered(std::string_view name, std::string_view prefix, std::string_view suffix,
                 std::size_t digits = 5) {
  if (name.size() < prefix.size() + digits + suffix.size()) return false;
  if (!name.starts_with(prefix) || !name.ends_with(suffix)) return false;
  name.remove_prefix(prefix.size());
  name.remove_suffix(suffix.size());
  return std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
}

// relaxation_2.csv: of a scene's third material.
bool is_of_material(std::string_view name) {
  for (const std::string_view suffix : {".csv", ".png"})
    for (const std::string_view prefix : {"relaxation_", "moduli_", "fit_"})
      if (is_numbered(name, prefix, suffix, 1)) return true;
  return false;
}

bool is_top_file(std::string_view name) {
  return is_of_material(without_part(name)) ||
         std::ranges::find(top_names, without_part(name)) != top_names.end();
}

bool is_frame(std::string_view name) {
  return is_numbered(without_part(name), "frame_", ".png");
}

bool is_vtu(std::string_view name) {
  return is_numbered(without_part(name), "state_", ".vtu") || without_part(name) == "state.pvd";
}

[[noreturn]] void refuse(const fs::path& path, const std::string& what, const std::error_code& error) {
  throw Failure(ExitCode::file, fmt::format("{}: {}: {}", path.string(), what, error.message()));
}

bool is_part(std::string_view name) {
  return name.ends_with(".part");
}

// "sheet.png", "frames/frame_00042.png", "vtu/state.pvd" and their unfinished ".part".
bool is_own(std::string_view name) {
  if (name.starts_with("frames/")) return is_frame(name.substr(7));
  if (name.starts_with("vtu/")) return is_vtu(name.substr(4));
  return is_top_file(name);
}

// By a file without a name: gone when closed, whatever happens.
void check_writable(const fs::path& folder) {
  int file = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file < 0) {
    // Some file systems have no O_TMPFILE: a named file, unlinked at once, does the same.
    std::string name = (folder / ".rheo_XXXXXX").string();
    file = mkostemp(name.data(), O_CLOEXEC);
    if (file >= 0) unlink(name.c_str());
  }
  if (file < 0)
    throw Failure(ExitCode::file,
                  fmt::format("{}: cannot write into the folder: {}", folder.string(), std::strerror(errno)));
  close(file);
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    names.push_back(entry->path().filename().string());
  if (error) refuse(folder, "cannot read the folder", error);
  std::ranges::sort(names);
  return names;
}

// A checkpoint that run.json does not list: of a run that was killed at its very end.
bool is_checkpoint(const fs::path& file) {
  std::array<char, 8> begin{};
  std::ifstream(file, std::ios::binary).read(begin.data(), begin.size());
  return std::string_view(begin.data(), begin.size()) == "rheo ck\n";
}

// Unfinished files, which carry names that only rheo gives.
std::vector<std::string> leftovers_in(const fs::path& folder) {
  std::vector<std::string> found;
  for (const char* const subfolder : {"", "frames/", "vtu/"}) {
    const fs::path place = folder / subfolder;
    // A link to elsewhere is not followed.
    if (*subfolder != '\0' && fs::is_symlink(folder / fs::path(subfolder).parent_path())) continue;
    if (!fs::is_directory(place)) continue;
    for (const std::string& each : names_in(place))
      if (const std::string name = subfolder + each; is_part(name) && is_own(name)) found.push_back(name);
  }
  if (is_checkpoint(folder / "checkpoint.rheo")) found.push_back("checkpoint.rheo");
  return found;
}

// Nothing but unfinished files and subfolders for results that hold nothing else.
bool is_interrupted_run(const fs::path& folder, const std::vector<std::string>& names) {
  return std::ranges::all_of(names, [&](const std::string& name) {
    if (name != "frames" && name != "vtu") return is_part(name) && is_own(name);
    return fs::is_directory(fs::symlink_status(folder / name)) &&
           std::ranges::all_of(names_in(folder / name), [&](const std::string& inner) {
             return is_part(inner) && is_own(name + "/" + inner);
           });
  });
}

[[noreturn]] void refuse_folder(const fs::path& path) {
  throw Failure(ExitCode::file,
                fmt::format("{}: is a folder where a file is to be written: move it away, or name another "
                            "folder with -o",
                            path.string()));
}

}  // namespace

std::optional<EarlierRun> find_earlier_run(const fs::path& folder) {
  using Json = nlohmann::json;
  std::error_code error;
  if (!fs::is_regular_file(folder / "run.json", error)) return std::nullopt;
  std::ifstream file(folder / "run.json", std::ios::binary);
  if (!file) return std::nullopt;
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("rheo") || !json.contains("files") || !json["files"].is_array())
    return std::nullopt;
  EarlierRun run;
  // Without one: an old rheo's, which had ended.
  const Json status = json.contains("exit_status") ? json["exit_status"] : Json(0);
  if (!status.is_null()) run.exit_status = status.is_number_integer() ? status.get<int>() : 0;
  for (const Json& name : json["files"])
    // A name that rheo does not write, such as "../thesis.tex", is nobody's order to remove it.
    if (name.is_string() && is_own(name.get<std::string>())) run.files.push_back(name);
  return run;
}

OutputFolder::OutputFolder(fs::path folder, Replace replace) : folder_(std::move(folder)) {
  std::error_code error;
  const fs::file_status status = fs::status(folder_, error);
  if (fs::exists(status) && !fs::is_directory(status))
    throw Failure(ExitCode::file,
                  fmt::format("{}: is a file, not a folder: name another folder with -o", folder_.string()));
  if (!fs::exists(status)) {
    make(folder_);
    lock();
    return;
  }
  const std::vector<std::string> names = names_in(folder_);
  const std::optional<EarlierRun> earlier = find_earlier_run(folder_);
  const bool cut = earlier ? earlier->is_cut() : is_interrupted_run(folder_, names);
  if (!names.empty() && (replace == Replace::nothing || (replace == Replace::cut_run && !cut))) {
    const std::string remedy =
        "name another folder with -o, or add --force, which replaces results and keeps other files";
    if (earlier && cut)
      throw Failure(ExitCode::usage,
                    fmt::format("{}: holds what an interrupted run left: --resume goes on with it; or {}",
                                folder_.string(), remedy));
    if (std::ranges::find(names, "run.json") != names.end())
      throw Failure(ExitCode::usage,
                    fmt::format("{}: holds the results of an earlier run: {}", folder_.string(), remedy));
    if (is_interrupted_run(folder_, names))
      throw Failure(ExitCode::usage, fmt::format("{}: holds what an interrupted run left ('{}'): {}",
                                                 folder_.string(), names.front(), remedy));
    throw Failure(ExitCode::usage,
                  fmt::format("{}: is not empty ('{}'): {}", folder_.string(), names.front(), remedy));
  }
  check_writable(folder_);
  lock();
  if (names.empty()) return;
  // A folder in the place of a result would only show after the simulation.
  for (const std::string_view name : top_names)
    for (const char* const end : {"", ".part"})
      if (const fs::path path = folder_ / (std::string(name) + end); fs::is_directory(path))
        refuse_folder(path);
  std::vector<std::string> listed = earlier.value_or(EarlierRun{}).files;
  // The list goes last: what is left of an interrupted removal is still known.
  std::stable_partition(listed.begin(), listed.end(),
                        [](const std::string& name) { return name != "run.json"; });
  stale_ = leftovers_in(folder_);
  stale_.insert(stale_.end(), listed.begin(), listed.end());
}

void OutputFolder::expect_series(const std::string& first) {
  const fs::path place = file(first).parent_path();
  for (const std::string& name : names_in(place))
    if ((is_frame(name) || is_vtu(name)) && fs::is_directory(place / name)) refuse_folder(place / name);
}

void OutputFolder::clear() {
  std::error_code error;
  for (const std::string& name : stale_) {
    const fs::path path = folder_ / name;
    // Neither a folder of that name nor what lies behind a link is the earlier run's.
    if (fs::is_symlink(path.parent_path()) && path.parent_path() != folder_) continue;
    if (fs::is_directory(fs::symlink_status(path, error))) continue;
    if (fs::remove(path, error); error) refuse(path, "cannot remove the earlier file", error);
  }
  stale_.clear();
  ready_.clear();
  for (const char* const subfolder : {"frames", "vtu"})
    if (fs::is_directory(fs::symlink_status(folder_ / subfolder, error)))
      fs::remove(folder_ / subfolder, error);  // one that holds anything stays
}

void OutputFolder::adopt(const std::vector<std::string>& parts) {
  std::error_code error;
  for (const std::string& name : stale_) {
    if (!is_part(name)) {
      own_.push_back(name);
    } else if (std::ranges::find(parts, name) == parts.end()) {
      if (fs::remove(folder_ / name, error); error)
        refuse(folder_ / name, "cannot remove the unfinished file", error);
    }
  }
  stale_.clear();
  std::ranges::sort(own_);
}

bool OutputFolder::has_own(const std::string& name) const {
  std::error_code error;
  return std::ranges::binary_search(own_, name) && fs::is_regular_file(folder_ / name, error);
}

std::vector<std::string> OutputFolder::free_of(std::vector<std::string> names) const {
  std::error_code error;
  std::erase_if(names, [&](const std::string& name) {
    return fs::exists(fs::symlink_status(folder_ / name, error)) && !std::ranges::binary_search(own_, name);
  });
  return names;
}

void OutputFolder::require_presence() const {
  std::error_code error;
  if (!fs::is_directory(folder_, error))
    throw Failure(ExitCode::file, fmt::format("{}: is gone: the folder was removed while rheo wrote into it",
                                              folder_.string()));
}

// Let go when the program ends, however it does. A file system without locks goes without.
void OutputFolder::lock() {
  lock_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0 || flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(lock_);
  throw Failure(ExitCode::file, fmt::format("{}: another rheo is writing into it: wait for its end, or name "
                                            "another folder with -o",
                                            folder_.string()));
}

OutputFolder::~OutputFolder() {
  if (lock_ >= 0) close(lock_);
  // Innermost first; a folder that holds anything stays.
  std::error_code not_empty;
  for (auto folder = new_folders_.rbegin(); folder != new_folders_.rend(); ++folder)
    fs::remove(*folder, not_empty);
}

fs::path OutputFolder::file(const std::string& name) {
  fs::path path = folder_ / name;
  const fs::path place = path.parent_path();
  if (place != folder_ && std::ranges::find(ready_, place) == ready_.end()) {
    make(place);
    ready_.push_back(place);
  }
  return path;
}

void OutputFolder::make(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw Failure(ExitCode::file,
                  fmt::format("{}: is a file where a folder is to be made: move it away, or name "
                              "another folder with -o",
                              folder.string()));
  std::vector<fs::path> missing;
  for (fs::path each = folder; !each.empty() && !fs::exists(each, error); each = each.parent_path()) {
    missing.push_back(each);
    if (!each.has_relative_path()) break;
  }
  for (const fs::path& each : missing)
    if (fs::is_symlink(fs::symlink_status(each, error)))
      throw Failure(ExitCode::file,
                    fmt::format("{}: is a link to {}, which does not exist: make that folder, or name "
                                "another one with -o",
                                each.string(), fs::read_symlink(each, error).string()));
  for (auto each = missing.rbegin(); each != missing.rend(); ++each) {
    if (each->filename().empty()) continue;  // "out/beam/": the folder itself comes as "out/beam"
    const bool made = fs::create_directory(*each, error);
    if (error) {
      for (auto done = new_folders_.rbegin(); done != new_folders_.rend(); ++done) {
        std::error_code ignored;
        fs::remove(*done, ignored);
      }
      refuse(*each, "cannot make the folder", error);
    }
    if (made) new_folders_.push_back(*each);
  }
}

std::string frame_name(std::int64_t k) {
  return fmt::format("frames/frame_{:05d}.png", k);
}
std::string vtu_name(std::int64_t k) {
  return fmt::format("vtu/state_{:05d}.vtu", k);
}

}  // namespace app
