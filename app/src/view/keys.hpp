// Keys as the window's interface names them: letters and signs by their ASCII capital, others by GLFW's
// numbers.
#pragma once

namespace app::view {

enum class Key : int {
  space = 32,
  minus = 45,
  period = 46,
  equal = 61,
  left_bracket = 91,
  right_bracket = 93,
  escape = 256,
  enter = 257,
  tab = 258,
  backspace = 259,
  del = 261,
  right = 262,
  left = 263,
  down = 264,
  up = 265,
  home = 268,
  end = 269,
  f1 = 290,
  f9 = 298,
  f12 = 301,
  keypad_subtract = 333,
  keypad_add = 334
};
constexpr Key key_of(char capital) {
  return static_cast<Key>(capital);
}
inline constexpr int key_count = 349;

}  // namespace app::view
