#include "rheo/memory_limit.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <limits>

namespace rheo {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

double page_size() {
  return static_cast<double>(sysconf(_SC_PAGESIZE));
}

// The number behind a word of a file of the system; 0 where there is none.
double number_in(const char* file, std::string_view name) {
  std::ifstream stream(file);
  double value = 0.0;
  for (std::string word; stream >> word;) {
    if (word == name && stream >> value) return value;
  }
  return 0.0;
}

// MemAvailable counts the caches that Linux would give up; elsewhere all of the machine's memory.
double available_here() {
  if (const double kilobytes = number_in("/proc/meminfo", "MemAvailable:"); kilobytes > 0.0)
    return 1024.0 * kilobytes;
  const double pages = static_cast<double>(sysconf(_SC_PHYS_PAGES));
  return pages > 0.0 ? pages * page_size() : none;
}

// Of the control group that the process sees as its own (a container's), whose caches would be given up, too:
// "max" is no number.
double left_in_group() {
  double most = 0.0, used = 0.0;
  if (!(std::ifstream("/sys/fs/cgroup/memory.max") >> most)) return none;
  std::ifstream("/sys/fs/cgroup/memory.current") >> used;
  const char* const parts = "/sys/fs/cgroup/memory.stat";
  used -= number_in(parts, "inactive_file") + number_in(parts, "active_file");
  return most > used ? most - used : 0.0;
}

}  // namespace

MemoryLimit memory_limit(double asked) {
  if (asked > 0.0) return {asked, "the limit is"};
  MemoryLimit least{available_here(), "this machine has"};
  if (const double group = left_in_group(); group < least.bytes)
    least = {group, "the control group's limit leaves"};
  return least;
}

std::string memory_text(double bytes) {
  constexpr double rounds_to_gigabyte = 0.9995e9;
  return bytes < rounds_to_gigabyte ? fmt::format("{:.3g} MB", bytes * 1e-6)
                                    : fmt::format("{:.3g} GB", bytes * 1e-9);
}

std::string beyond(const MemoryLimit& limit, std::string_view remedy) {
  return fmt::format("{} {}: {}, or raise the limit with --memory-limit", limit.whose,
                     memory_text(limit.bytes), remedy);
}

}  // namespace rheo
