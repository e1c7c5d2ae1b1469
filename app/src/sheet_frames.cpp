#include "sheet_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "rheo/simulation.hpp"

namespace app {
namespace {

constexpr int fewest_wanted = 8;
constexpr int most_wanted = 12;
// More keys than this are a curve, not moments to show.
constexpr std::size_t most_keys = 8;

std::vector<std::int64_t> evenly(std::int64_t outputs, int count) {
  std::vector<std::int64_t> frames;
  for (int i = 0; i < count; ++i)
    frames.push_back(std::llround(static_cast<double>(outputs - 1) * i / static_cast<double>(count - 1)));
  return frames;
}

bool contains(const std::vector<std::int64_t>& frames, std::int64_t k) {
  return std::ranges::binary_search(frames, k);
}

}  // namespace

std::vector<double> event_times(const rheo::Scene& scene) {
  std::vector<double> times;
  const auto add_window = [&](const rheo::Window& window) {
    times.insert(times.end(), {window.from, window.until});
  };
  const auto add_keys = [&](const auto& keys) {
    if (keys.size() > 1 && keys.size() <= most_keys)
      for (const auto& key : keys) times.push_back(key.t);
  };
  for (const rheo::Fix& fix : scene.fixes) add_window(fix.window);
  for (const rheo::Move& move : scene.moves) add_window(move.window), add_keys(move.keys);
  for (const rheo::Traction& traction : scene.tractions) add_window(traction.window), add_keys(traction.keys);
  std::erase_if(times, [&](double t) { return !(t > 0.0 && t < scene.time.duration); });
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::vector<std::int64_t> sheet_frames(std::int64_t outputs, double frame_rate,
                                       const std::vector<double>& events, std::optional<int> wanted,
                                       int room) {
  const int fewest = std::clamp(room, 2, fewest_wanted), most = std::clamp(room, 2, most_wanted);
  if (outputs <= (wanted ? *wanted : fewest)) {
    std::vector<std::int64_t> all;
    for (std::int64_t k = 0; k < outputs; ++k) all.push_back(k);
    return all;
  }
  std::vector<std::int64_t> event_outputs;
  for (const double t : events) {
    const std::int64_t k = std::llround(t * frame_rate);
    if (k > 0 && k < outputs - 1) event_outputs.push_back(k);
  }

  int count = wanted ? *wanted : most;
  if (!wanted) {
    // Equal spacing first, then events met, then the more shapes the better.
    std::tuple<bool, std::ptrdiff_t, int> best{false, -1, 0};
    for (int n = fewest; n <= most && n <= outputs; ++n) {
      const std::vector<std::int64_t> frames = evenly(outputs, n);
      const auto met =
          std::ranges::count_if(event_outputs, [&](std::int64_t k) { return contains(frames, k); });
      const std::tuple<bool, std::ptrdiff_t, int> score{(outputs - 1) % (n - 1) == 0, met, n};
      if (score > best) best = score;
    }
    count = std::get<2>(best);
  }

  std::vector<std::int64_t> frames = evenly(outputs, count);
  for (const std::int64_t k : event_outputs) {
    if (contains(frames, k)) continue;
    // The nearest shape that is not the first, the last or another event's.
    auto nearest = frames.end();
    for (auto frame = frames.begin() + 1; frame < frames.end() - 1; ++frame)
      if (std::ranges::find(event_outputs, *frame) == event_outputs.end() &&
          (nearest == frames.end() || std::abs(*frame - k) < std::abs(*nearest - k)))
        nearest = frame;
    if (nearest == frames.end()) break;
    *nearest = k;
    std::ranges::sort(frames);
  }
  return frames;
}

std::vector<std::int64_t> frames_at(const std::vector<double>& times, std::int64_t outputs,
                                    double frame_rate) {
  std::vector<std::int64_t> frames;
  for (const double t : times) {
    const std::int64_t k = std::llround(t * frame_rate);
    if (k < outputs && (frames.empty() || k > frames.back())) frames.push_back(k);
  }
  if (frames.empty()) frames.push_back(outputs - 1);
  return frames;
}

std::vector<std::string> notes_on_sheet_times(const rheo::Scene& scene, std::int64_t outputs) {
  const rheo::TimeSettings& time = scene.time;
  std::vector<std::string> notes;
  std::int64_t before = -1;
  for (const double t : scene.picture.sheet) {
    const std::int64_t k = std::llround(t * time.frame_rate);
    const double shown = rheo::output_time(time, std::min(k, outputs - 1));
    if (k >= outputs)
      notes.push_back(
          fmt::format("no shape of the sheet is of t = {:.6g} s: outputs end at {:.6g} s", t, shown));
    else if (k == before)
      notes.push_back(
          fmt::format("the sheet shows {:.6g} s once: the output nearest to t = {:.6g} s too", shown, t));
    else if (std::abs(shown - t) * time.frame_rate > 1e-3)
      notes.push_back(
          fmt::format("the sheet shows t = {:.6g} s for {:.6g} s, which is between outputs", shown, t));
    before = k;
  }
  return notes;
}

}  // namespace app
