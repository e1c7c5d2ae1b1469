#include "output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include "failure.hpp"

namespace app {
namespace fs = std::filesystem;
namespace {

constexpr std::array<std::string_view, 5> top_names{"state.csv", "history.csv", "run.json", "sheet.png",
                                                    "residual.png"};

std::string_view without_part(std::string_view name) {
  constexpr std::string_view part = ".part";
  if (name.ends_with(part)) name.remove_suffix(part.size());
  return name;
}

// PREFIX, at least five digits, SUFFIX
bool is_numbered(std::string_view name, std::string_view prefix, std::string_view suffix) {
  if (name.size() < prefix.size() + 5 + suffix.size()) return false;
  if (!name.starts_with(prefix) || !name.ends_with(suffix)) return false;
  name.remove_prefix(prefix.size());
  name.remove_suffix(suffix.size());
  return std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
}

bool is_top_file(std::string_view name) {
  return std::ranges::find(top_names, without_part(name)) != top_names.end();
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

template <typename Known>
void remove_known(const fs::path& folder, Known known) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (known(entry->path().filename().string()) && !fs::is_directory(entry->symlink_status()))
      files.push_back(entry->path());
  if (error) refuse(folder, "cannot read the folder", error);
  for (const fs::path& file : files)
    if (fs::remove(file, error); error) refuse(file, "cannot remove the earlier file", error);
}

// A subfolder of an earlier run: its numbered files, then itself when nothing else is in it.
template <typename Known>
void clear_subfolder(const fs::path& folder, Known known) {
  if (!fs::is_directory(fs::symlink_status(folder))) return;
  remove_known(folder, known);
  std::error_code not_empty;
  fs::remove(folder, not_empty);
}

void check_writable(const fs::path& folder) {
  close(open_unnamed_file(folder));
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

}  // namespace

OutputFolder::OutputFolder(fs::path folder, Replace replace) : folder_(std::move(folder)) {
  std::error_code error;
  const fs::file_status status = fs::status(folder_, error);
  if (fs::exists(status) && !fs::is_directory(status))
    throw Failure(ExitCode::file,
                  fmt::format("{}: is a file, not a folder: name another folder with -o", folder_.string()));
  if (!fs::exists(status)) {
    make(folder_);
    return;
  }
  const std::vector<std::string> names = names_in(folder_);
  if (!names.empty() && replace == Replace::nothing) {
    const bool earlier_run = std::ranges::find(names, "run.json") != names.end();
    const std::string remedy =
        "name another folder with -o, or add --force, which replaces results and keeps other files";
    throw Failure(ExitCode::usage,
                  earlier_run
                      ? fmt::format("{}: holds the results of an earlier run: {}", folder_.string(), remedy)
                      : fmt::format("{}: is not empty ('{}'): {}", folder_.string(), names.front(), remedy));
  }
  check_writable(folder_);
  if (names.empty()) return;
  remove_known(folder_, is_top_file);
  clear_subfolder(folder_ / "frames", is_frame);
  clear_subfolder(folder_ / "vtu", is_vtu);
  // A folder in the place of a result would only show after the simulation.
  for (const std::string_view name : top_names)
    if (fs::is_directory(folder_ / name))
      throw Failure(ExitCode::file,
                    fmt::format("{}: is a folder where a file is to be written: move it away, or name "
                                "another folder with -o",
                                (folder_ / name).string()));
}

OutputFolder::~OutputFolder() {
  // Innermost first; a folder that holds anything stays.
  std::error_code not_empty;
  for (auto folder = new_folders_.rbegin(); folder != new_folders_.rend(); ++folder)
    fs::remove(*folder, not_empty);
}

fs::path OutputFolder::file(const std::string& name) {
  fs::path path = folder_ / name;
  if (path.parent_path() != folder_) make(path.parent_path());
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

int open_unnamed_file(const fs::path& folder) {
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
  return file;
}

}  // namespace app
