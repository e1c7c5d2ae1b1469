// DIR/checkpoint.rheo of a run: the simulation's (rheo/io/checkpoint.hpp) with what the run has noted so far
// as its companion.
//
// Written every so many seconds of wall time and when a run is told to stop; the kept parts of history.csv
// and positions.bin are on the disk before it, so that the checkpoint that is there always has what it needs.
//
// Errors   rheo::Error of reading and writing; Failure(usage) where the cut run was another one
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "phase_clock.hpp"
#include "records.hpp"
#include "rheo/io/checkpoint.hpp"

namespace app {

inline constexpr const char* checkpoint_name = "checkpoint.rheo";

// How far a run has come.
struct RunProgress {
  std::int64_t outputs = 0;  // noted
  bool simulated = false;    // to the duration's end: what is left is drawing
};

class RunCheckpoint {
 public:
  // interval: seconds; infinite: only where write() is called. identity: of the run (run_identity.hpp).
  RunCheckpoint(std::filesystem::path file, double interval, std::string identity);

  bool is_due() const;
  void write(rheo::Simulation& simulation, Records& records, const RunProgress& progress,
             const Seconds& seconds);
  // Whether there is one of this run.
  bool exists() const { return exists_; }
  // Where there is one of this run.
  void remove();
  // A cut run's, which this one goes on with.
  void adopt() { exists_ = true; }

 private:
  std::filesystem::path file_;
  double interval_;
  std::string identity_;
  bool exists_ = false;
  std::chrono::steady_clock::time_point last_;
};

// A cut run's checkpoint.
class CutRun {
 public:
  explicit CutRun(rheo::Checkpoint checkpoint);
  CutRun(const CutRun&) = delete;
  CutRun& operator=(const CutRun&) = delete;

  // Refuses where it was another run than this one.
  void require_same(const std::string& identity) const;
  // All three are as they were.
  RunProgress take_up(rheo::Simulation& simulation, Records& records, Seconds& seconds);

 private:
  rheo::Checkpoint checkpoint_;
  std::string name_;
  rheo::ByteReader in_;
  std::string identity_;
};

}  // namespace app
