// rheo_kills [--kills N] [--seed N] [--length X] [--folder DIR]: kills rheo run and rheo render N times at
// random moments over all integrators and kinds of output, and prints what was found. Exit code 1: a fault.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "kills.hpp"

int main(int argc, char** argv) {
  using namespace fault_tests;
  int kills = 200;
  std::uint64_t seed = 1;
  double length = 1.0;
  fs::path folder = fs::path(RHEO_TEST_OUTPUT) / "kills";
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--kills") == 0) kills = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--seed") == 0) seed = std::strtoull(argv[i + 1], nullptr, 10);
    if (std::strcmp(argv[i], "--length") == 0) length = std::atof(argv[i + 1]);
    if (std::strcmp(argv[i], "--folder") == 0) folder = argv[i + 1];
  }
#ifdef RHEO_HAS_RENDERER
  const std::vector<RunCase> cases = run_cases(length, true);
#else
  const std::vector<RunCase> cases = run_cases(length, false);
#endif
  std::mt19937_64 random(seed);
  int left = kills, all_kills = 0, all_faults = 0;
  fmt::print(
      "| run | alone, s | kills | before a checkpoint | simulating | drawing | ends | faults |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const int share = left / static_cast<int>(cases.size() - i);
    left -= share;
    const fs::path place = folder / std::to_string(i);
    fs::remove_all(place);
    const KillReport report = kill_and_resume(cases[i], share, random, place);
    fmt::print("| {} | {:.2f} | {} | {} | {} | {} | {} | {} |\n", report.name, report.seconds, report.kills,
               report.beginning, report.simulating, report.drawing, report.ends, report.faults.size());
    for (const std::string& fault : report.faults) fmt::print("FAULT {}: {}\n", report.name, fault);
    std::fflush(stdout);
    all_kills += report.kills;
    all_faults += static_cast<int>(report.faults.size());
  }
  fmt::print("{} kills, {} faults (seed {})\n", all_kills, all_faults, seed);
  return all_faults == 0 && all_kills >= kills ? 0 : 1;
}
