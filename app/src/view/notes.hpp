// Plates with words over a picture, which lie neither over each other nor over the words of the picture.
//
// Units    pixels of the window from the top left
// Errors   none: what has no room is cut short or left out
#pragma once

#include <imgui.h>

#include <span>
#include <string>
#include <vector>

namespace app::view {

struct Area {
  ImVec2 low, high;
};

struct NoteColors {
  ImU32 ink, paper;
};

class Notes {
 public:
  // room: where plates may lie.
  Notes(ImDrawList& list, const Area& room, float text);
  // Words that are there already.
  void keep_clear_of(const Area& words) { taken_.push_back(words); }

  // At the bottom left, above the ones before: the first of `wordings` that has room in one line, else the
  // first on several. Returns what was written of it; empty: nothing.
  std::string stack(std::span<const std::string> wordings, const NoteColors& colors);
  // Near a point, on the side where there is room.
  std::string beside(const ImVec2& point, const std::string& words, const NoteColors& colors);
  const std::vector<Area>& plates() const { return plates_; }

 private:
  ImVec2 size_of(const std::string& words) const;
  std::string cut(const std::string& words, float height) const;
  bool is_free(const Area& area) const;
  void draw(const ImVec2& corner, const ImVec2& size, const std::string& words, const NoteColors& colors);

  ImDrawList& list_;
  Area room_;
  float text_, rim_x_, rim_y_, width_, next_;  // next_: the bottom of the next plate of the stack
  std::vector<Area> taken_, plates_;
};

}  // namespace app::view
