// Kills a run at random moments, goes on with it by --resume, kills that too, until it has come to its end;
// and judges what is there after each kill and at the end by a run that nobody disturbed.
//
//   after a kill   every file but NAME.part is byte for byte the undisturbed run's of that name; run.json is
//                  JSON, checkpoint.rheo can be read
//   at the end     the same files are there, all of them the same
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "child.hpp"

namespace fault_tests {

// Seconds between checkpoints of the cases below.
inline constexpr const char* often = "0.05";

// A scene and how it is run.
struct RunCase {
  std::string name;
  std::string scene;                   // text
  std::vector<std::string> arguments;  // the command first; the scene is scene.toml
};

// Of every integrator, kind of constraint and kind of output. length: of the runs, 1 for some tenths of a
// second each.
std::vector<RunCase> run_cases(double length, bool pictures);

struct KillReport {
  std::string name;
  int kills = 0;      // of a process that was still running
  int beginning = 0;  // of these before there was anything to go on from
  int simulating = 0;
  int drawing = 0;
  int ends = 0;                     // runs that came to their end, all after at least one kill
  int resumed = 0;                  // of these, had gone on from a checkpoint at their last start
  double seconds = 0.0;             // of the undisturbed run
  std::vector<std::string> faults;  // one line each
};

// Kills until there were so many. folder: empty, for the files.
KillReport kill_and_resume(const RunCase& run, int kills, std::mt19937_64& random, const fs::path& folder);

// What is wrong with the files in `folder`, judged by the undisturbed run's in `whole`.
std::vector<std::string> faults_in(const fs::path& folder, const fs::path& whole);
// Likewise at an end: nothing may be missing or too much.
std::vector<std::string> differences(const fs::path& folder, const fs::path& whole);

}  // namespace fault_tests
