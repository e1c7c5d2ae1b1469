// Which outputs of a run have a frame: the first, every so many-th after it, and the last.
//
//   every = 3, 9 outputs:   0 . . 3 . . 6 . 8   are frames 0 to 3
//
// Errors   none
#pragma once

#include <cstdint>
#include <vector>

namespace app {

// How many frames so many outputs have.
std::int64_t frame_count(std::int64_t outputs, int every);

// How many outputs' shapes are kept at most: those of the frames and of the sheet.
std::int64_t most_kept(std::int64_t outputs, int every);

// The output of a frame, of which there are frame_count().
std::int64_t frame_output(std::int64_t frame, std::int64_t outputs, int every);

// The outputs whose shapes are kept until they are drawn: those of the frames, and others that the sheet
// shows.
class KeptOutputs {
 public:
  // others: any of the outputs, in any order.
  KeptOutputs(std::int64_t outputs, int every, const std::vector<std::int64_t>& others);

  bool has(std::int64_t k) const;
  // How many of them lie below output k.
  std::int64_t below(std::int64_t k) const;
  std::int64_t count() const { return below(outputs_); }

 private:
  std::int64_t outputs_;
  int every_;
  std::vector<std::int64_t> between_;  // two frames of `every`; rising
};

}  // namespace app
