// Pass 1 of a sequence: what the pictures need of the outputs that are drawn, and what they need of all
// outputs together: the bounds of the motion and the range of the colour, so that frames compare, and do not
// depend on how many there are.
//
// Shapes   displacements n x 2, scalar n (or none), kept in float32: a mesh far from the origin loses nothing
//          by it
// Errors   those of FrameStore
// Not here drawing (sequence.hpp)
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "frame_outputs.hpp"
#include "frame_store.hpp"
#include "output_sink.hpp"
#include "rheo/io/bytes.hpp"

namespace app {

// What acts at one output.
struct RecordedLoads {
  double t = 0.0;
  std::vector<rheo::Simulation::ActiveTraction> tractions;
  std::shared_ptr<const std::vector<int>>
      held;  // 2 node + axis; shared by successive outputs where it is the same
};

class Recorder : public OutputSink {
 public:
  Recorder(const rheo::Scene& scene, const std::filesystem::path& folder, KeptOutputs kept);

  void record(rheo::Simulation& simulation, std::int64_t k) override;
  // The output recorded last, where it was to be, is the last one, and kept.
  void end();

  // For a run that is to go on: positions and colours are kept in the store's file, all else in the bytes.
  void put(rheo::ByteWriter& out);
  // Before the first record.
  void get(rheo::ByteReader& in);
  // What was kept goes after all, at once; no frame is drawn afterwards.
  void discard() { store_.discard(); }

  // Outputs so far.
  std::int64_t count() const { return static_cast<std::int64_t>(loads_.size()); }
  // The kept output nearest to output k.
  std::int64_t nearest_kept(std::int64_t k) const;
  const RecordedLoads& loads(std::int64_t k) const { return loads_[static_cast<std::size_t>(k)]; }
  // Of a kept output: fills positions (n x 2, deformed) and scalar (n; empty where nothing is coloured).
  void read(std::int64_t k, std::vector<double>& positions, std::vector<double>& scalar) const;

  // x0, y0, x1, y1 over the boundary at rest and at all outputs.
  const std::array<double, 4>& bounds() const { return bounds_; }
  // Smallest and largest scalar of all outputs; nullopt where nothing is coloured or recorded.
  std::optional<std::array<double, 2>> scalar_range() const;
  // How many scalars were computed: none where nothing is coloured.
  std::int64_t color_values() const { return color_values_; }

 private:
  void include(double x, double y);

  rheo::ColorBy color_;
  int branch_;                   // 0: all
  std::vector<double> scalars_;  // of the moment
  std::vector<double> rest_;     // n x 2
  std::vector<int> boundary_nodes_;
  KeptOutputs kept_;
  FrameStore store_;
  std::vector<RecordedLoads> loads_;
  std::vector<float> record_;  // of the latest output
  bool pending_ = false;       // it is not in the store
  std::array<double, 4> bounds_;
  std::array<double, 2> range_;
  std::int64_t color_values_ = 0;
};

// All recorded scalars are 0 and the range is theirs: a colour bar would show a range that does not exist.
bool nothing_to_colour(const rheo::PictureSettings& picture, const Recorder& recorder);

}  // namespace app
