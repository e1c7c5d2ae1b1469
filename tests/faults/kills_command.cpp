// rheo_kills [--kills N] [--seed N] [--length X] [--folder DIR]: kills rheo run and rheo render N times at
// random moments over all integrators and kinds of output, and prints what was found. Exit code 1: a fault;
// 2: an unknown option.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

#include "kills.hpp"

namespace {

using namespace fault_tests;

struct Wanted {
  int kills = 200;
  std::uint64_t seed = 1;
  double length = 1.0;  // of each run, times its usual one
  fs::path folder;
};

Wanted wanted(int argc, char** argv) {
  Wanted w;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view key = argv[i];
    const char* const value = i + 1 < argc ? argv[i + 1] : nullptr;
    if (key == "--kills" && value != nullptr)
      w.kills = std::stoi(value);
    else if (key == "--seed" && value != nullptr)
      w.seed = std::stoull(value);
    else if (key == "--length" && value != nullptr)
      w.length = std::stod(value);
    else if (key == "--folder" && value != nullptr)
      w.folder = value;
    else
      throw std::invalid_argument(fmt::format("{}: --kills N, --seed N, --length X or --folder DIR", key));
  }
  // Two at once do not meet where their seeds differ.
  if (w.folder.empty()) w.folder = fs::path(RHEO_TEST_OUTPUT) / fmt::format("kills_{}", w.seed);
  return w;
}

int run(const Wanted& wanted) {
#ifdef RHEO_HAS_RENDERER
  const std::vector<RunCase> cases = run_cases(wanted.length, true);
#else
  const std::vector<RunCase> cases = run_cases(wanted.length, false);
#endif
  std::mt19937_64 random(wanted.seed);
  int left = wanted.kills, all_kills = 0, all_faults = 0;
  fmt::print(
      "| run | alone, s | kills | before a checkpoint | simulating | drawing | ends | faults |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const int share = left / static_cast<int>(cases.size() - i);
    left -= share;
    const fs::path place = wanted.folder / std::to_string(i);
    fs::remove_all(place);
    const KillReport report = kill_and_resume(cases[i], share, random, place);
    fmt::print("| {} | {:.2f} | {} | {} | {} | {} | {} | {} |\n", report.name, report.seconds, report.kills,
               report.beginning, report.simulating, report.drawing, report.ends, report.faults.size());
    for (const std::string& fault : report.faults) fmt::print("FAULT {}: {}\n", report.name, fault);
    std::fflush(stdout);
    all_kills += report.kills;
    all_faults += static_cast<int>(report.faults.size());
  }
  fmt::print("{} kills, {} faults (seed {})\n", all_kills, all_faults, wanted.seed);
  return all_faults == 0 && all_kills >= wanted.kills ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try { return run(wanted(argc, argv)); } catch (const std::exception& e) {
  std::fprintf(stderr, "rheo_kills: %s\n", e.what());
  return 2;
}
