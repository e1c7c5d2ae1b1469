#include "view/key_bindings.hpp"

namespace app::view {
namespace {

constexpr KeyBinding bindings[]{{Key::space, With::nothing, "Space", Action::run_or_pause},
                                {Key::period, With::nothing, ".", Action::one_tick},
                                {key_of('R'), With::nothing, "R", Action::reset},
                                {key_of('R'), With::shift, "Shift+R", Action::restart},
                                {key_of('F'), With::nothing, "F", Action::fit},
                                {Key::home, With::nothing, "Home", Action::fit},
                                {key_of('G'), With::nothing, "G", Action::push_or_grab},
                                {key_of('W'), With::nothing, "W", Action::mesh_lines},
                                {key_of('B'), With::nothing, "B", Action::rest_shape},
                                {key_of('N'), With::nothing, "N", Action::node_numbers},
                                {key_of('D'), With::nothing, "D", Action::dark},
                                {key_of('C'), With::nothing, "C", Action::next_colour},
                                {key_of('P'), With::nothing, "P", Action::plots},
                                {Key::tab, With::nothing, "Tab", Action::panels},
                                {key_of('H'), With::nothing, "H", Action::help},
                                {Key::f1, With::nothing, "F1", Action::help},
                                {Key::escape, With::nothing, "Esc", Action::close_help},
                                {Key::equal, With::nothing, "+", Action::faster},
                                {Key::keypad_add, With::nothing, "+", Action::faster},
                                {Key::minus, With::nothing, "-", Action::slower},
                                {Key::keypad_subtract, With::nothing, "-", Action::slower},
                                {key_of('1'), With::nothing, "1", Action::real_time},
                                {Key::left_bracket, With::nothing, "[", Action::smaller_brush},
                                {Key::right_bracket, With::nothing, "]", Action::larger_brush},
                                {Key::f12, With::nothing, "F12", Action::save_picture},
                                {Key::f12, With::shift, "Shift+F12", Action::save_window},
                                {Key::f9, With::nothing, "F9", Action::record},
                                {key_of('S'), With::control, "Ctrl+S", Action::save_session},
                                {key_of('Q'), With::control, "Ctrl+Q", Action::quit}};

constexpr HelpLine lines[]{{"left drag", "push or grab the lit edges; release lets go"},
                           {"right or middle drag", "pan"},
                           {"wheel", "zoom to the cursor"},
                           {"F, Home", "fit; or a double click beside the body"},
                           {"Space", "run or pause"},
                           {".", "one tick"},
                           {"R, Shift+R", "reset, restart"},
                           {"G", "push or grab"},
                           {"[ ]", "smaller, larger brush"},
                           {"- + 1", "slower, faster, real time"},
                           {"C", "next colour"},
                           {"W B N D", "mesh, rest shape, node numbers, dark"},
                           {"Tab, P", "panels, plots"},
                           {"F9", "start or stop a sequence of pictures"},
                           {"F12, Shift+F12", "the picture, the whole window to a file"},
                           {"Ctrl+S", "save what was done as a scene"},
                           {"Ctrl+Q", "quit"},
                           {"Ctrl+click", "type a slider's value"},
                           {"H, F1", "this list; Esc closes it"}};

}  // namespace

std::span<const KeyBinding> key_bindings() {
  return bindings;
}

std::optional<Action> action_of(Key key, With held) {
  const auto find = [&](With with) -> std::optional<Action> {
    for (const KeyBinding& binding : bindings)
      if (binding.key == key && binding.with == with) return binding.action;
    return std::nullopt;
  };
  const auto action = find(held);
  return action || held != With::shift ? action : find(With::nothing);
}

std::span<const HelpLine> help_lines() {
  return lines;
}

}  // namespace app::view
