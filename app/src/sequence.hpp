// Pass 2 of a sequence: frames, the sheet of successive shapes and the plot of the residual forces.
//
// The graphics library is loaded by the constructor, before anything is simulated or written, so that a
// machine which cannot draw says so at once.
//
// Errors   std::runtime_error and render::FileError of the renderer: one line each; Failure(usage) in a build
// without it
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "history_file.hpp"
#include "output_folder.hpp"
#include "phase_clock.hpp"
#include "progress.hpp"
#include "recorder.hpp"

namespace app {

// What frames and sheet have cost so far.
struct DrawCounters {
  std::int64_t frames_drawn = 0;
  std::int64_t frames_repeated = 0;  // like the frame before but for the time, which alone was drawn
  std::int64_t mesh_uploads = 0;     // of positions and colours to the graphics library
};

// What drawing asks before each frame.
struct DrawHooks {
  std::function<bool(std::int64_t)> is_there;  // whether the frame of this number is drawn already
  std::function<bool()> goes_on;
};

class Sequence {
 public:
  Sequence(const rheo::PictureSettings& picture, const Options& options);
  ~Sequence();

  // Backend, driver and versions.
  std::string description() const;
  // Those that the sheet of a run of so many outputs shows.
  std::vector<std::int64_t> sheet_outputs(const rheo::Scene& scene, std::int64_t outputs) const;
  // DIR/frames/... (frame_outputs.hpp), then DIR/sheet.png and DIR/residual.png. False where it did not go
  // on: the frames before are whole, and no others there.
  bool draw(const rheo::Scene& scene, const Recorder& recorder, const HistoryFile& history,
            OutputFolder& folder, Progress& progress, Seconds& seconds, const DrawHooks& hooks);
  DrawCounters counters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace app
