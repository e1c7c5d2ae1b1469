#include "frame_outputs.hpp"

#include <algorithm>

#include "rheo/scene.hpp"

namespace app {

std::int64_t frame_count(std::int64_t outputs, int every) {
  return outputs > 0 ? (outputs - 2 + every) / every + 1 : 0;
}

std::int64_t most_kept(std::int64_t outputs, int every) {
  return std::min(outputs, frame_count(outputs, every) + static_cast<std::int64_t>(rheo::most_sheet_times));
}

std::int64_t frame_output(std::int64_t frame, std::int64_t outputs, int every) {
  return std::min(frame * every, outputs - 1);
}

KeptOutputs::KeptOutputs(std::int64_t outputs, int every, const std::vector<std::int64_t>& others)
    : outputs_(outputs), every_(every), between_(others) {
  between_.push_back(outputs - 1);
  std::erase_if(between_, [&](std::int64_t k) { return k % every == 0; });
  std::ranges::sort(between_);
  between_.erase(std::unique(between_.begin(), between_.end()), between_.end());
}

bool KeptOutputs::has(std::int64_t k) const {
  return k % every_ == 0 || std::ranges::binary_search(between_, k);
}

std::int64_t KeptOutputs::below(std::int64_t k) const {
  const auto between = std::ranges::lower_bound(between_, k) - between_.begin();
  return (k + every_ - 1) / every_ + static_cast<std::int64_t>(between);
}

}  // namespace app
