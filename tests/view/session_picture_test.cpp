// What F12 saves and what `rheo render` draws of the saved session are the same pixels.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>

#include "draw_or_skip.hpp"
#include "render/decode.hpp"
#include "rheo/io/scene_file.hpp"
#include "rheo/simulation.hpp"
#include "view_scene.hpp"

namespace view_tests {
namespace {

enum class Then { hold_on, let_go };

// Takes the block's right side, drags it, and lets it go or not; then F12 and Ctrl+S, at the same tick.
void expect_the_same_picture(Driver& user, const fs::path& folder, Hold hold, Then then) {
  if (user.ui.mode() != hold) user.key(key_of('G'));
  const auto at = user.pixel(0.1, 0.03);
  user.move(at[0], at[1]);
  user.press();
  ASSERT_TRUE(user.until([&](const Display& d) { return d.hand.hold == hold; }));
  user.move(at[0] + 60, at[1] - 15);
  ASSERT_TRUE(user.ticks(40));
  if (then == Then::let_go) {
    user.release();
    ASSERT_TRUE(user.until([](const Display& d) { return d.hand.hold == Hold::nothing; }));
    ASSERT_TRUE(user.ticks(8));
  }
  user.frames(2);
  user.key(Key::f12);
  user.key_with_control(key_of('S'));
  ASSERT_TRUE(user.until([&](const Display&) { return fs::exists(folder / "session_001.toml"); }));
  // An output a tick, a frame every 20 of them and the last.
  const rheo::Scene session = rheo::read_scene(folder / "session_001.toml");
  const std::int64_t last = user.ui.shown().ticks;
  EXPECT_EQ(session.time.frame_rate, 1000.0);
  EXPECT_EQ(session.picture.every, 20);
  EXPECT_EQ(rheo::output_count(session.time), last + 1);
  const auto last_frame = static_cast<int>((last + 19) / 20);
  const std::string command = std::string("\"") + RHEO_PROGRAM + "\" render \"" +
                              (folder / "session_001.toml").string() + "\" -o \"" +
                              (folder / "again").string() + "\" --quiet";
  ASSERT_EQ(WEXITSTATUS(std::system(command.c_str())), 0) << command;
  const render::Image shown = read_png(folder / "picture_001.png");
  char name[32];
  std::snprintf(name, sizeof name, "frame_%05d.png", last_frame);
  const render::Image drawn = read_png(folder / "again/frames" / name);
  ASSERT_EQ(shown.width, drawn.width);
  ASSERT_EQ(shown.height, drawn.height);
  EXPECT_TRUE(shown.rgba == drawn.rgba) << "see " << folder;
  EXPECT_GT(last, 39);
  std::snprintf(name, sizeof name, "frame_%05d.png", last_frame + 1);
  EXPECT_FALSE(fs::exists(folder / "again/frames" / name));
}

TEST(ViewSession, UnderAPushItsPictureIsThatOfRender) {
  RHEO_DRAW_OR_SKIP(context);
  const fs::path folder = output_folder();
  Driver user(*context, block(), folder);
  expect_the_same_picture(user, folder, Hold::push, Then::hold_on);
}

TEST(ViewSession, UnderAGrabItsPictureIsThatOfRender) {
  RHEO_DRAW_OR_SKIP(context);
  const fs::path folder = output_folder();
  Driver user(*context, block(), folder);
  expect_the_same_picture(user, folder, Hold::grab, Then::hold_on);
}

TEST(ViewSession, ReleasedAndUnderTheScenesOwnLoadItsPictureIsThatOfRender) {
  RHEO_DRAW_OR_SKIP(context);
  const fs::path folder = output_folder();
  rheo::Scene scene = block();
  rheo::Traction& load = scene.tractions.emplace_back();
  load.edges = scene.mesh.edge_groups.at("top");
  load.keys = {{0.0, {0, -20}}};
  Driver user(*context, scene, folder);
  user.ui.picture().zoom(1.3, 200, 200);
  user.frames(2);
  expect_the_same_picture(user, folder, Hold::push, Then::let_go);
}

// The colour bar's numbers and the arrows come and go beside the body, which stays where it is.
TEST(ViewPicture, StaysWhereItIsUnderTheHand) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  const auto place = user.pixel(0.1, 0.03);
  const std::array<double, 2> range = user.ui.picture().range();
  user.move(place[0], place[1]);
  user.press();
  ASSERT_TRUE(user.until([](const Display& d) { return d.hand.hold == Hold::push; }));
  std::set<double> ranges;
  for (int k = 0; k < 60; ++k) {
    user.move(place[0] + static_cast<float>(2 * k), place[1]);
    ASSERT_TRUE(user.ticks(4));
    ranges.insert(user.ui.picture().range()[1]);
    ASSERT_EQ(user.pixel(0.1, 0.03), place) << "range up to " << user.ui.picture().range()[1];
  }
  EXPECT_GT(ranges.size(), 3u);
  EXPECT_NE(user.ui.picture().range(), range);
}

}  // namespace
}  // namespace view_tests
