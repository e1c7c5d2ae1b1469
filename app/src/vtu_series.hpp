// The ParaView series of a run: DIR/vtu/state_00000.vtu ... and its index state.pvd.
//
// Errors   rheo::Error::Kind::file; Failure(file) where a file of the earlier outputs is gone
#pragma once

#include <vector>

#include "output_folder.hpp"
#include "output_sink.hpp"
#include "rheo/io/results.hpp"

namespace app {

class VtuSeries : public OutputSink {
 public:
  explicit VtuSeries(OutputFolder& folder) : folder_(folder) {}

  void record(rheo::Simulation& simulation, std::int64_t k) override;
  // Goes on behind outputs at these times, whose files are there.
  void take_up(const std::vector<double>& times);
  // Writes the index of what was recorded.
  void finish();

 private:
  OutputFolder& folder_;
  std::vector<rheo::VtuEntry> entries_;
  std::vector<double> stress_;  // of the moment, m x 3
};

}  // namespace app
