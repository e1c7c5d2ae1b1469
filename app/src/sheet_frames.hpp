// Which outputs the sheet of successive shapes shows, and the moments at which a scene changes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rheo/scene.hpp"

namespace app {

// Times inside (0, duration) at which loads or constraints begin, end or have a key; sorted, each once.
std::vector<double> event_times(const rheo::Scene& scene);

// Output numbers below `outputs`, rising, the first and the last among them, `wanted` or 8 to 12 (fewer where
// there is `room` for fewer): the count whose equal spacing is a whole number of outputs and meets most
// events; events that it misses take the place of a neighbour.
std::vector<std::int64_t> sheet_frames(std::int64_t outputs, double frame_rate,
                                       const std::vector<double>& events, std::optional<int> wanted,
                                       int room);

// Those nearest to these times, each once; times beyond the last output are left out.
std::vector<std::int64_t> frames_at(const std::vector<double>& times, std::int64_t outputs,
                                    double frame_rate);

// What becomes of the scene's own sheet times that none of the first `outputs` outputs has.
std::vector<std::string> notes_on_sheet_times(const rheo::Scene& scene, std::int64_t outputs);

}  // namespace app
