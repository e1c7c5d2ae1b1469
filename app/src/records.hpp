// All that a run notes at its outputs: history.csv, warnings, the ParaView series, positions for pictures;
// begun anew, or taken up where a cut run had put them aside.
//
// Errors   those of the sinks
#pragma once

#include <optional>
#include <vector>

#include "command_line.hpp"
#include "history_file.hpp"
#include "linearity_watch.hpp"
#include "phase_clock.hpp"
#include "recorder.hpp"
#include "vtu_series.hpp"

namespace app {

class Records {
 public:
  // Writes nothing yet. All must outlive this. sheet: outputs that are drawn beside those of the frames.
  Records(const rheo::Scene& scene, OutputFolder& folder, const Options& options,
          const std::vector<std::int64_t>& sheet, Progress& progress);

  // One of these two, once the folder is ready.
  void begin();
  void take_up(rheo::ByteReader& in);

  void record(rheo::Simulation& simulation, std::int64_t k, Seconds& seconds);
  // Puts all so far aside, on the disk; the bytes go with it into a checkpoint.
  void put_aside(rheo::ByteWriter& out);
  // What was put aside goes at the end after all.
  void discard();
  // No more outputs come: history.csv and the series' index appear.
  void commit();

  const HistoryFile& history() const { return *history_; }
  const Recorder* recorder() const { return recorder_ ? &*recorder_ : nullptr; }
  const std::vector<std::string>& warnings() const { return watch_.warnings(); }

 private:
  const rheo::Scene& scene_;
  OutputFolder& folder_;
  std::optional<HistoryFile> history_;
  LinearityWatch watch_;
  std::optional<VtuSeries> vtu_;
  std::optional<Recorder> recorder_;
};

}  // namespace app
