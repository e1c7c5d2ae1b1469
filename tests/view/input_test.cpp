// Keys and buttons: each does what the table says, and none of many at once is lost.
#include "view/input.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "draw_or_skip.hpp"
#include "view_scene.hpp"

namespace view_tests {
namespace {

using app::view::Action;
using app::view::Event;
using app::view::InputQueue;
using app::view::With;

void tap(InputQueue& queue, Key key) {
  for (const bool down : {true, false}) queue.push({Event::Kind::key, static_cast<int>(key), down, 0, 0, {}});
}
void type(InputQueue& queue, const std::string& text) {
  for (const char c : text) queue.push({Event::Kind::text, c, false, 0, 0, {}});
}
constexpr Key left_control = static_cast<Key>(341);

// Whether pressing it has done what it is for.
bool does(Driver& user, Action action, const std::function<void()>& press, const fs::path& folder) {
  auto& ui = user.ui;
  const app::view::PictureStyle style = ui.style();
  const float brush = ui.brush();
  const double speed = ui.shown().speed_wanted;
  const bool running = ui.shown().running;
  const std::int64_t ticks = ui.shown().ticks;
  const auto asked_speed = [&](double wanted) {
    press();
    return user.until([&](const Display& d) { return d.speed_wanted == wanted; });
  };
  const auto file = [&](const char* name) {
    fs::remove(folder / name);
    press();
    return user.until([&](const Display&) { return fs::exists(folder / name); });
  };
  switch (action) {
    case Action::run_or_pause:
      press();
      if (!user.until([&](const Display& d) { return d.running != running; })) return false;
      press();
      return user.until([&](const Display& d) { return d.running == running; });
    case Action::one_tick:
      press();
      return user.until([&](const Display& d) { return d.ticks == ticks + 1; });
    case Action::reset:
      if (!user.ticks(2)) return false;
      press();
      return user.until([](const Display& d) { return d.ticks == 0 && !d.running; });
    case Action::restart: {
      const std::int64_t run = ui.shown().run;
      press();
      const bool did = user.until([&](const Display& d) { return d.run == run + 1 && d.running; });
      user.physics.pause();
      return did && user.until([](const Display& d) { return !d.running; });
    }
    case Action::fit: {
      ui.picture().zoom(3.0, 10, 10);
      const auto zoomed = ui.picture().bounds();
      press();
      return ui.picture().bounds()[2] - ui.picture().bounds()[0] > 2.0 * (zoomed[2] - zoomed[0]);
    }
    case Action::push_or_grab: {
      const Hold mode = ui.mode();
      press();
      return ui.mode() != mode;
    }
    case Action::mesh_lines:
      press();
      return ui.style().mesh_lines != style.mesh_lines;
    case Action::rest_shape:
      press();
      return ui.style().rest_shape != style.rest_shape;
    case Action::node_numbers:
      press();
      return ui.style().node_numbers != style.node_numbers;
    case Action::dark:
      press();
      return ui.style().dark != style.dark;
    case Action::next_colour:
      press();
      return ui.style().color != style.color;
    case Action::plots: {
      press();
      const bool gone = user.widget("|w|") == nullptr && user.widget("speed") != nullptr;
      press();
      return gone && user.widget("|w|") != nullptr;
    }
    case Action::panels: {
      press();
      const bool gone = user.widget("|w|") == nullptr && user.widget("speed") == nullptr;
      press();
      return gone && user.widget("|w|") != nullptr && user.widget("speed") != nullptr;
    }
    case Action::help: {
      press();
      const bool shown = user.widget("Close") != nullptr;
      press();
      return shown && user.widget("Close") == nullptr;
    }
    case Action::close_help: {
      user.key(key_of('H'));
      const bool shown = user.widget("Close") != nullptr;
      press();
      return shown && user.widget("Close") == nullptr;
    }
    case Action::faster:
      return asked_speed(2.0 * speed);
    case Action::slower:
      return asked_speed(0.5 * speed);
    case Action::real_time:
      user.physics.set_speed(0.25);
      return asked_speed(1.0);
    case Action::smaller_brush:
      press();
      return ui.brush() < brush;
    case Action::larger_brush:
      press();
      return ui.brush() > brush;
    case Action::save_picture:
    case Action::save_window:
      return file("picture_001.png");
    case Action::record: {
      press();
      const bool made =
          user.until([&](const Display&) { return fs::exists(folder / "frames_001" / "frame_00000.png"); });
      press();
      return made && user.says("frames_001");
    }
    case Action::save_session:
      if (!user.ticks(5)) return false;
      return file("session_001.toml");
    case Action::quit:
      press();
      return ui.wants_to_quit();
  }
  return false;
}

TEST(ViewKeys, EachDoesWhatTheHelpSays) {
  RHEO_DRAW_OR_SKIP(context);
  const fs::path folder = output_folder();
  Driver user(*context, block(), folder);
  std::ostringstream help;
  for (const auto& line : app::view::help_lines()) help << ' ' << line.keys << ", " << line.meaning << ' ';
  for (const auto& binding : app::view::key_bindings()) {
    const auto press = [&] {
      user.input.control = binding.with == With::control;
      user.input.shift = binding.with == With::shift;
      user.key(binding.key);
      user.input.control = user.input.shift = false;
    };
    EXPECT_TRUE(does(user, binding.action, press, folder)) << binding.name;
    // As a word of its own.
    const bool told = help.str().find(std::string(" ") + binding.name + " ") != std::string::npos ||
                      help.str().find(std::string(" ") + binding.name + ",") != std::string::npos;
    EXPECT_TRUE(told || binding.action == Action::close_help) << binding.name << " is not in the help";
  }
  EXPECT_THAT(help.str(), testing::HasSubstr("Esc closes"));
}

TEST(ViewKeys, WithShiftThoseWithoutASecondMeaningDoTheSame) {
  EXPECT_EQ(app::view::action_of(Key::equal, With::shift), Action::faster);
  EXPECT_EQ(app::view::action_of(key_of('R'), With::shift), Action::restart);
  EXPECT_EQ(app::view::action_of(key_of('C'), With::control), std::nullopt);
  EXPECT_EQ(app::view::action_of(key_of('S'), With::nothing), std::nullopt);
}

// As on a machine that draws a frame a second.
TEST(ViewKeys, SeveralWithinOneFrameAllActInTheirOrder) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  const app::view::PictureStyle before = user.ui.style();
  InputQueue queue;
  for (int k = 0; k < 2; ++k) tap(queue, key_of('C'));
  tap(queue, key_of('W'));
  for (int k = 0; k < 3; ++k) tap(queue, Key::space);  // runs, pauses, runs
  tap(queue, Key::minus);
  tap(queue, Key::minus);
  for (int k = 0; k < 2; ++k) tap(queue, key_of('G'));
  const std::size_t frames = user.ui.frame_seconds().size();
  user.ui.frame(queue.take(1280, 720, 1.0));
  EXPECT_EQ(user.ui.frame_seconds().size(), frames + 1);
  EXPECT_TRUE(queue.is_empty());
  EXPECT_EQ(static_cast<int>(user.ui.style().color), static_cast<int>(before.color) + 2);
  EXPECT_NE(user.ui.style().mesh_lines, before.mesh_lines);
  EXPECT_EQ(user.ui.mode(), Hold::push);
  EXPECT_TRUE(user.until([](const Display& d) { return d.running && d.speed_wanted == 0.25; }));
}

TEST(ViewKeys, AClickAndTypingWithinOneFrameFillAField) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  user.input.height = 1400;
  user.frames(3);
  ASSERT_TRUE(user.click_widget("Integration"));
  user.frames(2);
  const auto* field = user.widget("omega");
  ASSERT_NE(field, nullptr);
  const float x = field->x0 + 12, y = (field->y0 + field->y1) / 2;
  user.move(x, y);
  user.frame();
  InputQueue queue;
  queue.push({Event::Kind::cursor, 0, false, x, y, {}});
  for (const bool down : {true, false}) queue.push({Event::Kind::button, 0, down, 0, 0, {}});
  queue.push({Event::Kind::key, static_cast<int>(left_control), true, 0, 0, {}});
  tap(queue, key_of('A'));
  queue.push({Event::Kind::key, static_cast<int>(left_control), false, 0, 0, {}});
  type(queue, "12");
  tap(queue, Key::backspace);
  type(queue, "3");
  tap(queue, Key::enter);
  const std::vector<app::view::Input> inputs = queue.take(1280, 1400, 0.5);
  EXPECT_GT(inputs.size(), 5u);
  user.ui.frame(inputs);
  user.input.cursor = {x, y};
  EXPECT_TRUE(user.until([](const Display& d) { return d.scene->time.baumgarte == 13.0; }));
}

TEST(ViewInputs, TimeIsTheLastOnesAndAnIdleFrameIsOneInput) {
  InputQueue queue;
  EXPECT_EQ(queue.take(300, 200, 0.25).size(), 1u);
  tap(queue, key_of('C'));
  queue.push({Event::Kind::cursor, 0, false, 7, 8, {}});
  queue.push({Event::Kind::cursor, 0, false, 9, 8, {}});
  const auto inputs = queue.take(300, 200, 0.25);
  ASSERT_EQ(inputs.size(), 3u);
  EXPECT_EQ(inputs[0].down.size(), 1u);
  EXPECT_EQ(inputs[1].down.size(), 0u);
  EXPECT_EQ(inputs[2].cursor[0], 9.0f);
  EXPECT_EQ(inputs[0].seconds + inputs[1].seconds, 0.0);
  EXPECT_EQ(inputs[2].seconds, 0.25);
}

}  // namespace
}  // namespace view_tests
