// Says once, with time and place, that a state has left what a linear model means: a triangle turned inside
// out, strain or rotation beyond the limits of rheo/deformation.hpp.
#pragma once

#include <string>
#include <vector>

#include "output_sink.hpp"
#include "progress.hpp"
#include "rheo/io/bytes.hpp"

namespace app {

class LinearityWatch : public OutputSink {
 public:
  explicit LinearityWatch(Progress& progress) : progress_(progress) {}

  void record(rheo::Simulation& simulation, std::int64_t k) override;
  // For a run that is to go on: what was said is not said again.
  void put(rheo::ByteWriter& out) const;
  void get(rheo::ByteReader& in);
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void warn(const std::string& text);

  Progress& progress_;
  bool inverted_ = false;
  bool strained_ = false;
  bool rotated_ = false;
  std::vector<std::string> warnings_;
};

}  // namespace app
