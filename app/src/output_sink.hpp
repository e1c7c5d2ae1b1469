// Something that takes the state at every output time.
#pragma once

#include <cstdint>

#include "rheo/simulation.hpp"

namespace app {

class OutputSink {
 public:
  virtual ~OutputSink() = default;
  // The simulation stands at output k; all its numbers are finite.
  virtual void record(rheo::Simulation& simulation, std::int64_t k) = 0;
};

}  // namespace app
