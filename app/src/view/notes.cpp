#include "view/notes.hpp"

#include <algorithm>
#include <cmath>

namespace app::view {
namespace {

bool touch(const Area& a, const Area& b) {
  return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

}  // namespace

Notes::Notes(ImDrawList& list, const Area& room, float text)
    : list_(list),
      room_(room),
      text_(text),
      rim_x_(0.4f * text),
      rim_y_(0.2f * text),
      width_(std::floor(room.high.x - room.low.x - 2.0f * rim_x_)),  // lines are measured in whole pixels
      next_(room.high.y) {}

ImVec2 Notes::size_of(const std::string& words) const {
  const ImVec2 size = ImGui::CalcTextSize(words.c_str(), nullptr, false, width_);
  return {size.x + 2.0f * rim_x_, size.y + 2.0f * rim_y_};
}

bool Notes::is_free(const Area& area) const {
  if (area.low.x < room_.low.x || area.low.y < room_.low.y || area.high.x > room_.high.x ||
      area.high.y > room_.high.y)
    return false;
  const auto touches = [&](const Area& other) { return touch(area, other); };
  return std::ranges::none_of(taken_, touches) && std::ranges::none_of(plates_, touches);
}

// As much of the words as a plate of that height takes.
std::string Notes::cut(const std::string& words, float height) const {
  if (size_of(words).y <= height) return words;
  std::string best;
  std::size_t low = 0, high = words.size();
  while (low < high) {
    std::size_t length = (low + high + 1) / 2;
    const std::size_t tried = length;
    // Not within a character.
    while (length > 0 && (static_cast<unsigned char>(words[length]) & 0xC0) == 0x80) --length;
    std::string part = words.substr(0, length) + "\u2026";
    if (size_of(part).y <= height) {
      best = std::move(part);
      low = tried;
    } else {
      high = tried - 1;
    }
  }
  return best.size() > 8 ? best : std::string();
}

void Notes::draw(const ImVec2& corner, const ImVec2& size, const std::string& words,
                 const NoteColors& colors) {
  const ImVec2 end{corner.x + size.x, corner.y + size.y};
  list_.AddRectFilled(corner, end, colors.paper, 0.25f * text_);
  list_.AddText(nullptr, 0.0f, {corner.x + rim_x_, corner.y + rim_y_}, colors.ink, words.c_str(), nullptr,
                width_);
  plates_.push_back({corner, end});
}

std::string Notes::stack(std::span<const std::string> wordings, const NoteColors& colors) {
  if (wordings.empty() || width_ < 4.0f * text_) return {};
  std::string words = wordings.front();
  for (const std::string& wording : wordings)
    if (ImGui::CalcTextSize(wording.c_str()).x <= width_) {
      words = wording;
      break;
    }
  words = cut(words, next_ - room_.low.y);
  if (words.empty()) return {};
  const ImVec2 size = size_of(words);
  ImVec2 corner{room_.low.x, next_ - size.y};
  // Above the picture's names; what is raised above one may meet another.
  for (std::size_t k = 0; k < taken_.size(); ++k)
    for (const Area& other : taken_)
      if (touch({corner, {corner.x + size.x, corner.y + size.y}}, other) &&
          other.low.y - size.y >= room_.low.y)
        corner.y = std::min(corner.y, other.low.y - size.y);
  draw(corner, size, words, colors);
  next_ = corner.y - 0.3f * text_;
  return words;
}

std::string Notes::beside(const ImVec2& point, const std::string& words, const NoteColors& colors) {
  const ImVec2 size = size_of(words);
  const float gap = 0.7f * text_;
  const float right = point.x + gap, left = point.x - gap - size.x;
  const float below = point.y + gap, above = point.y - gap - size.y;
  const auto within_x = [&](float x) {
    return std::clamp(x, room_.low.x, std::max(room_.low.x, room_.high.x - size.x));
  };
  const auto within_y = [&](float y) {
    return std::clamp(y, room_.low.y, std::max(room_.low.y, room_.high.y - size.y));
  };
  const ImVec2 places[]{{right, below},
                        {right, above},
                        {left, below},
                        {left, above},
                        {within_x(right), within_y(below)},
                        {within_x(right), within_y(above)},
                        {within_x(left), room_.low.y}};
  for (const ImVec2& corner : places) {
    if (!is_free({corner, {corner.x + size.x, corner.y + size.y}})) continue;
    draw(corner, size, words, colors);
    return words;
  }
  return {};
}

}  // namespace app::view
