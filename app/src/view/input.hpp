// What a user has done since the last frame, and events in a row as such inputs.
//
// Units    pixels of the framebuffer from the top left
// Errors   none
#pragma once

#include <array>
#include <deque>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "view/keys.hpp"

namespace app::view {

// One change of a button or key: Dear ImGui 1.86 keeps no queue. A frame may take several of these.
struct Input {
  int width = 1280, height = 720;
  double seconds = 1.0 / 60.0;  // since the input before
  std::array<float, 2> cursor{-1e6f, -1e6f};
  std::array<bool, 3> buttons{};  // left, right, middle
  float wheel = 0.0f;
  bool control = false, shift = false;
  std::vector<Key> down;       // all keys that are down
  std::vector<unsigned> text;  // characters typed
  std::vector<std::filesystem::path> dropped;
};

struct Event {
  enum class Kind { cursor, button, wheel, key, text, drop } kind = Kind::cursor;
  int code = 0;
  bool down = false;
  float x = 0.0f, y = 0.0f;
  std::string path;
};

class InputQueue {
 public:
  void push(Event event) { events_.push_back(std::move(event)); }
  bool is_empty() const { return events_.empty(); }
  // All events so far, in their order, in as few inputs as they take; one at least. The time is the last
  // one's: what came before it came at once.
  std::vector<Input> take(int width, int height, double seconds);

 private:
  void next();

  std::deque<Event> events_;
  Input input_;
};

}  // namespace app::view
