// What the window's keys do: one table, which the window obeys, the help tells and the tests go through.
#pragma once

#include <optional>
#include <span>

#include "view/keys.hpp"

namespace app::view {

enum class Action {
  run_or_pause,
  one_tick,
  reset,
  restart,
  fit,
  push_or_grab,
  mesh_lines,
  rest_shape,
  node_numbers,
  dark,
  next_colour,
  plots,
  panels,
  help,
  close_help,
  faster,
  slower,
  real_time,
  smaller_brush,
  larger_brush,
  save_picture,
  save_window,
  record,
  save_session,
  quit
};

enum class With { nothing, shift, control };  // nothing: with Shift too, where that has no action of its own

struct KeyBinding {
  Key key;
  With with;
  const char* name;  // as in the help
  Action action;
};

std::span<const KeyBinding> key_bindings();
std::optional<Action> action_of(Key key, With held);

struct HelpLine {
  const char *keys, *meaning;
};
std::span<const HelpLine> help_lines();

}  // namespace app::view
