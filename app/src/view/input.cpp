#include "view/input.hpp"

#include <algorithm>
#include <utility>

namespace app::view {
namespace {

constexpr int left_shift = 340, left_control = 341, right_shift = 344, right_control = 345;  // GLFW's

}  // namespace

std::vector<Input> InputQueue::take(int width, int height, double seconds) {
  std::vector<Input> inputs;
  input_.width = width;
  input_.height = height;
  input_.seconds = 0.0;
  do {
    next();
    inputs.push_back(input_);
  } while (!events_.empty());
  inputs.back().seconds = seconds;
  return inputs;
}

// Events up to a second change of a button or key, or up to where the cursor or the typing goes on after a
// first one: within one frame Dear ImGui takes characters before keys.
void InputQueue::next() {
  using Kind = Event::Kind;
  input_.wheel = 0.0f;
  input_.text.clear();
  input_.dropped.clear();
  bool changed = false;
  while (!events_.empty()) {
    Event& event = events_.front();
    const bool change = event.kind == Kind::button || event.kind == Kind::key;
    if (changed && (change || event.kind == Kind::cursor || event.kind == Kind::text)) break;
    switch (event.kind) {
      case Kind::cursor:
        input_.cursor = {event.x, event.y};
        break;
      case Kind::button:
        input_.buttons[static_cast<std::size_t>(event.code)] = event.down;
        break;
      case Kind::wheel:
        input_.wheel += event.y;
        break;
      case Kind::key:
        std::erase(input_.down, static_cast<Key>(event.code));
        if (event.down) input_.down.push_back(static_cast<Key>(event.code));
        if (event.code == left_control || event.code == right_control) input_.control = event.down;
        if (event.code == left_shift || event.code == right_shift) input_.shift = event.down;
        break;
      case Kind::text:
        input_.text.push_back(static_cast<unsigned>(event.code));
        break;
      case Kind::drop:
        input_.dropped.emplace_back(event.path);
        break;
    }
    changed = changed || change;
    events_.pop_front();
  }
}

}  // namespace app::view
