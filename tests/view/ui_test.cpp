// The window as a person uses it: all of its content off-screen, with a synthetic cursor and keys.
#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <set>
#include <thread>

#include "draw_or_skip.hpp"
#include "render/mesh_picture.hpp"
#include "view_scene.hpp"

namespace view_tests {
namespace {

bool all_finite(const Display& d) {
  const auto finite = [](double x) { return std::isfinite(x); };
  return std::ranges::all_of(d.positions, finite) && std::ranges::all_of(d.w_lambda, finite) &&
         std::ranges::all_of(d.w_mu, finite);
}

double corner_x(const Driver& user) {
  const auto& positions = user.ui.shown().positions;
  return positions[positions.size() - 2] - 0.1;
}

int pixels_unlike(const render::Image& a, const render::Image& b) {
  if (a.rgba.size() != b.rgba.size()) return -1;
  int count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4)
    count +=
        a.rgba[i] != b.rgba[i] || a.rgba[i + 1] != b.rgba[i + 1] || a.rgba[i + 2] != b.rgba[i + 2] ? 1 : 0;
  return count;
}

TEST(ViewUi, AnEdgePushedAndReleasedComesBackPartOfTheWayAndTheWindowTells) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  // The middle of the right side lights up under the cursor.
  render::Image before, lit;
  const auto at = user.pixel(0.1, 0.03);
  user.ui.screen().read(before);
  user.move(at[0], at[1]);
  user.ui.screen().read(lit);
  EXPECT_GT(pixels_unlike(before, lit), 50);
  user.press();
  ASSERT_TRUE(user.until([](const Display& d) { return d.hand.hold == Hold::push; }));
  user.move(at[0] + 80, at[1]);
  ASSERT_TRUE(user.ticks(400));
  const double far = corner_x(user);
  EXPECT_GT(far, 1e-4);
  EXPECT_TRUE(user.says("push ")) << "the arrow's value";
  EXPECT_TRUE(user.says("Pa ("));
  EXPECT_TRUE(user.says(" N)") || user.says("mN)"));
  EXPECT_GT(user.ui.history().force.back(), 0.0);
  const double strong = user.ui.history().w_lambda.back();
  EXPECT_GT(strong, 0.0);
  user.release();
  ASSERT_TRUE(user.until([](const Display& d) { return d.hand.hold == Hold::nothing; }));
  ASSERT_TRUE(user.ticks(2000));
  EXPECT_LT(corner_x(user), 0.95 * far);
  EXPECT_GT(corner_x(user), 0.05 * far);
  EXPECT_FALSE(user.says("push "));
  EXPECT_LT(user.ui.history().w_lambda.back(), 0.2 * strong);
  for (const char* text :
       {"|w| [", "E [", "u [mm]", "F [", "steps a frame", "stable step", "kernel", "energy drift", "paused"})
    EXPECT_TRUE(user.says(text)) << text;
}

TEST(ViewUi, AGrabbedEdgeFollowsTheCursorAndShowsTheReaction) {
  RHEO_DRAW_OR_SKIP(context);
  app::view::PictureStyle style;
  style.color = rheo::ColorBy::none;  // the colour bar's numbers would move the picture under the cursor
  Driver user(*context, block(), output_folder(), style);
  user.key(key_of('G'));
  const auto at = user.pixel(0.1, 0.05), to = user.pixel(0.104, 0.052);
  user.move(at[0], at[1]);
  user.press();
  ASSERT_TRUE(user.until([](const Display& d) { return d.hand.hold == Hold::grab; }));
  user.move(to[0], to[1]);
  ASSERT_TRUE(user.ticks(600));
  const auto& positions = user.ui.shown().positions;
  const double pixel = 1.0 / user.ui.picture().plane().scale;  // Dear ImGui knows whole ones only
  EXPECT_NEAR(positions[positions.size() - 2], 0.104, pixel);
  EXPECT_NEAR(positions[positions.size() - 1], 0.052, pixel);
  EXPECT_TRUE(user.says("reaction "));
  EXPECT_FALSE(user.says("reaction 0 N"));
  user.release();
  ASSERT_TRUE(user.until([](const Display& d) { return d.hand.hold == Hold::nothing; }));
}

// What `rheo render` draws of the same state at the same place and size: not a pixel differs.
TEST(ViewUi, ItsPictureIsTheRenderersOwn) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder(),
              {.range_mode = app::view::RangeMode::typed, .typed = {0.0f, 8.0f}});
  const auto at = user.pixel(0.1, 0.03);
  user.move(at[0], at[1]);
  user.press();
  ASSERT_TRUE(user.until([](const Display& d) { return d.hand.hold == Hold::push; }));
  user.move(at[0] + 80, at[1]);
  ASSERT_TRUE(user.ticks(300));
  user.release();
  ASSERT_TRUE(user.until([](const Display& d) { return d.hand.hold == Hold::nothing; }));
  ASSERT_TRUE(user.ticks(50));
  user.frame();
  render::Image shown, alone, whole;
  user.ui.picture().read(shown);
  user.ui.screen().read(whole);

  const Display& d = user.ui.shown();
  std::vector<double> rest;
  for (const rheo::Vec2& p : d.scene->mesh.points) rest.insert(rest.end(), {p.x, p.y});
  std::vector<int> triangles, boundary;
  for (const auto& t : d.scene->mesh.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  for (const auto& e : d.scene->mesh.edge_groups.at("boundary"))
    boundary.insert(boundary.end(), e.begin(), e.end());
  const auto [x, y, width, height] = user.ui.picture_area();
  const auto other = render::open_context(render::Backend::automatic, width, height);
  render::MeshPicture picture(*other, {.rest = rest,
                                       .triangles = triangles,
                                       .boundary = boundary,
                                       .title = "Block",
                                       .scalar_name = "|w_lambda|",
                                       .scalar_unit = "Pa m",
                                       .range = {0.0, 8.0},
                                       .bar_room = render::BarRoom::fixed,
                                       .bounds = user.ui.picture().bounds(),
                                       .arrow_scale = user.ui.picture().mesh_picture().view().arrow_scale});
  picture.draw({.positions = d.positions, .scalar = d.w_lambda, .held = d.held, .arrows = {}, .time = d.t},
               alone);
  ASSERT_EQ(alone.width, shown.width);
  EXPECT_EQ(pixels_unlike(alone, shown), 0);
  // In the window it lies beside the panels; over it there is the clock's plate only, at the bottom.
  int unlike = 0;
  for (int row = 0; row < height - 40; ++row)
    for (int column = 0; column < width; ++column) {
      const auto i = 4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(column));
      const auto j = 4 * (static_cast<std::size_t>(row + y) * static_cast<std::size_t>(whole.width) +
                          static_cast<std::size_t>(column + x));
      for (std::size_t k = 0; k < 3; ++k) unlike += alone.rgba[i + k] != whole.rgba[j + k] ? 1 : 0;
    }
  // The lit edges and the brush under the cursor, where it rests.
  EXPECT_LT(unlike, 6000);
}

TEST(ViewUi, PausesStepsResetsByKeys) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  user.key(Key::space);
  EXPECT_TRUE(user.until([](const Display& d) { return d.running && d.ticks > 0; }));
  user.key(Key::space);
  ASSERT_TRUE(user.until([](const Display& d) { return !d.running; }));
  user.frame();
  EXPECT_TRUE(user.says("paused"));
  const std::int64_t ticks = user.ui.shown().ticks;
  user.key(Key::period);
  EXPECT_TRUE(user.until([&](const Display& d) { return d.ticks == ticks + 1; }));
  user.key(key_of('R'));
  EXPECT_TRUE(user.until([](const Display& d) { return d.ticks == 0; }));
  user.key(Key::minus);
  EXPECT_TRUE(user.until([](const Display& d) { return d.speed_wanted == 0.5; }));
  user.key(key_of('H'));
  EXPECT_TRUE(user.says("push or grab the lit edges; release lets go"));
}

TEST(ViewUi, ABrokenSceneThatIsDroppedIsAMessageAndTheOldOneGoesOn) {
  RHEO_DRAW_OR_SKIP(context);
  const fs::path folder = output_folder();
  std::ofstream(folder / "broken.toml") << "[mesh]\nshape = \"rectangel\"\n";
  Driver user(*context, block(), folder);
  user.input.dropped = {folder / "broken.toml"};
  user.frame();
  ASSERT_TRUE(user.until([&](const Display& d) { return d.message_number > 0; }));
  user.frame();
  EXPECT_TRUE(user.says("rectangel"));
  EXPECT_EQ(user.ui.shown().scene->title, "Block");
  EXPECT_TRUE(user.ticks(3));
  user.input.dropped = {fs::path(RHEO_SOURCE_DIR) / "app" / "scenes" / "beam.toml"};
  user.frame();
  ASSERT_TRUE(user.until([&](const Display& d) { return d.body == 1; }));
  user.frame();
  EXPECT_EQ(user.ui.shown().scene->mesh.triangles.size(), 8u);
}

TEST(ViewUi, ASliderOfTheMaterialActsBetweenSteps) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  user.input.height = 1300;
  user.frames(3);
  const auto* slider = user.widget("mu_ela");
  ASSERT_NE(slider, nullptr);
  const double before = user.ui.shown().scene->material.mu_ela;
  user.move((slider->x0 + slider->x1) / 2 - 40, (slider->y0 + slider->y1) / 2);
  user.press();
  user.release();
  EXPECT_TRUE(user.until([&](const Display& d) { return d.scene->material.mu_ela != before; }));
  EXPECT_TRUE(user.ticks(20));
  EXPECT_TRUE(all_finite(user.ui.shown()));
}

TEST(ViewUi, AnySizeIsDrawn) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  for (const auto& [width, height] : {std::pair{300, 200}, {2560, 1440}, {760, 519}, {1, 1}, {1280, 720}}) {
    user.input.width = width;
    user.input.height = height;
    user.frames(2);
    render::Image image;
    user.ui.screen().read(image);
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
    // The body is in it: its fill or its outline in the middle of the picture's area.
    if (width < 10) continue;
    std::set<std::uint32_t> colours;
    const auto [x, y, w, h] = user.ui.picture_area();
    for (int k = 0; k < w && x + k < width; ++k) {
      const auto i = 4 * (static_cast<std::size_t>(y + h / 2) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(x + k));
      colours.insert(
          static_cast<std::uint32_t>(image.rgba[i] << 16 | image.rgba[i + 1] << 8 | image.rgba[i + 2]));
    }
    EXPECT_GT(colours.size(), 3u) << width << " x " << height;
  }
}

TEST(ViewUi, ARecordingHasOneFrameForEachSixtiethAndLosesNone) {
  RHEO_DRAW_OR_SKIP(context);
  const fs::path folder = output_folder();
  Driver user(*context, block(), folder);
  user.key(Key::f9);
  user.frames(5);
  EXPECT_TRUE(user.says("recording, frame 1: waits")) << "as the body, which is paused";
  EXPECT_EQ(user.ui.shown().ticks, 0);
  user.key(Key::space);
  ASSERT_TRUE(user.until([](const Display& d) { return d.ticks >= 100; }));
  user.key(Key::period);
  EXPECT_TRUE(user.says("takes its own steps"));
  user.key(Key::space);
  ASSERT_TRUE(user.until([&](const Display&) { return user.says("waits") && !user.ui.is_lively(); }));
  const std::int64_t waited = user.ui.shown().ticks;
  user.frames(20);
  EXPECT_EQ(user.ui.shown().ticks, waited);
  EXPECT_NE(user.widget("Run"), nullptr);
  user.key(Key::period);  // it waits, and one tick can be taken: the next frame's time is the same
  ASSERT_TRUE(user.until([&](const Display& d) { return d.ticks == waited + 1; }));
  user.key(Key::space);
  EXPECT_NE(user.widget("Pause"), nullptr);
  ASSERT_TRUE(user.until([](const Display& d) { return d.ticks >= 200; }));
  EXPECT_EQ(user.ui.shown().ticks, 200) << "12 / 60 s";
  user.key(Key::f9);
  user.key(Key::f12);
  int count = 0;
  while (fs::exists(folder / "frames_001" / ("frame_0000" + std::to_string(count) + ".png")) && count < 10)
    ++count;
  EXPECT_EQ(count, 10);  // 200 ms are 12 frames
  EXPECT_TRUE(fs::exists(folder / "picture_001.png"));
}

TEST(ViewUi, ZoomKeepsWhatIsUnderTheCursorAndFitBringsAllBack) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  const auto at = user.pixel(0.02, 0.04);
  user.input.cursor = at;
  user.input.wheel = 3.0f;
  user.frame();
  user.frame();
  const auto now = user.pixel(0.02, 0.04);
  EXPECT_NEAR(now[0], at[0], 0.6f);
  EXPECT_NEAR(now[1], at[1], 0.6f);
  EXPECT_GT(user.pixel(0.1, 0.0)[0] - user.pixel(0.0, 0.0)[0], 1.4f * 0.9f * (at[0] - user.pixel(0, 0)[0]));
  user.press(1);
  user.move(at[0] + 30, at[1] + 20);
  user.release(1);
  user.frame();
  EXPECT_NEAR(user.pixel(0.02, 0.04)[0], at[0] + 30, 0.6f);
  user.key(key_of('F'));
  const auto area = user.ui.picture_area();
  EXPECT_GT(user.pixel(0.0, 0.0)[0], static_cast<float>(area[0]));
  EXPECT_LT(user.pixel(0.1, 0.0)[0], static_cast<float>(area[0] + area[2]));
}

bool apart(const app::view::Area& a, const app::view::Area& b) {
  return a.high.x <= b.low.x || b.high.x <= a.low.x || a.high.y <= b.low.y || b.high.y <= a.low.y;
}

// A strained body under the hand, a saved picture told: four plates at once.
TEST(ViewUi, NothingThatIsWrittenOverThePictureLiesOnOtherWords) {
  RHEO_DRAW_OR_SKIP(context);
  const fs::path folder = output_folder();
  Driver user(*context, block(), folder);
  for (const auto& [width, height] : {std::pair{300, 200}, {1280, 720}, {760, 400}}) {
    user.input.width = width;
    user.input.height = height;
    user.key(key_of('F'));
    const auto at = user.pixel(0.1, 0.04);
    user.move(at[0], at[1]);
    user.press();
    ASSERT_TRUE(user.until([](const Display& d) { return d.hand.hold == Hold::push; }));
    for (int mm = 1; mm < 100 && !user.says("strain "); ++mm) {
      user.move(user.pixel(0.1 + 1e-3 * mm, 0.04)[0], at[1]);
      ASSERT_TRUE(user.ticks(50));
    }
    user.key(Key::f12);
    const std::string size = std::to_string(width) + " x " + std::to_string(height);
    for (const char* words : {"paused", "strain ", "saved "}) EXPECT_TRUE(user.says(words)) << size << words;
    const std::vector<app::view::Area>& plates = user.ui.plates();
    EXPECT_GE(plates.size(), 3u) << size;
    const render::PictureArea body = user.ui.picture().mesh_picture().body_area();
    const auto x = static_cast<float>(user.ui.picture_area()[0]);
    EXPECT_TRUE(user.says("push ") || width < 1280) << size;
    if (user.says("push ")) {  // beside the arrows' value, which the picture writes
      for (const render::TextBox& box : user.ui.picture().mesh_picture().texts())
        EXPECT_TRUE(apart(plates.back(), {{x + box.x0, box.y0}, {x + box.x1, box.y1}})) << size << box.text;
    }
    for (std::size_t i = 0; i < plates.size(); ++i) {
      EXPECT_GE(plates[i].low.x, x);
      EXPECT_LE(plates[i].high.x, x + body.x1) << size << ": over the colour bar";
      EXPECT_GE(plates[i].low.y, body.y0) << size << ": over the title";
      EXPECT_LE(plates[i].high.y, static_cast<float>(user.ui.picture_area()[3])) << size;
      for (std::size_t j = 0; j < i; ++j) EXPECT_TRUE(apart(plates[i], plates[j])) << size << i << j;
    }
    user.release();
    ASSERT_TRUE(user.until([](const Display& d) { return d.hand.hold == Hold::nothing; }));
    ASSERT_TRUE(user.ticks(1500));
  }
}

TEST(ViewUi, APushThatThePhysicsHasNotTakenIsNotShown) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  const auto at = user.pixel(0.1, 0.03);
  std::atomic<bool> free{false};
  user.physics.post([&free](app::view::Core&) {
    while (!free) std::this_thread::yield();
  });
  user.move(at[0], at[1]);
  user.press();
  user.move(at[0] + 80, at[1]);
  EXPECT_EQ(user.ui.shown().hand.hold, Hold::nothing) << "the physics is at something else";
  EXPECT_FALSE(user.says("push "));
  free = true;
  ASSERT_TRUE(user.until([](const Display& d) { return d.hand.hold == Hold::push; }));
  user.frame();
  EXPECT_TRUE(user.says("push 0 Pa (0 N), paused"));
  ASSERT_TRUE(user.ticks(200));
  EXPECT_FALSE(user.says("push 0 Pa"));
  EXPECT_TRUE(user.says("push "));
  // Pressed again before the physics looks: what it still shows is the push before.
  free = false;
  user.physics.post([&free](app::view::Core&) {
    while (!free) std::this_thread::yield();
  });
  user.release();
  user.move(at[0], at[1]);
  user.press();
  EXPECT_FALSE(user.says("push "));
  free = true;
  ASSERT_TRUE(user.until([&](const Display&) { return user.says("push 0 Pa"); }));
}

TEST(ViewUi, AMessageGoesWhenItHasBeenReadAtRestToo) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  EXPECT_EQ(user.ui.next_change(), rheo::forever);
  user.key(Key::f12);
  EXPECT_TRUE(user.says("saved "));
  user.frames(10);
  EXPECT_FALSE(user.ui.is_lively());
  const double left = user.ui.next_change();
  EXPECT_GT(left, 5.0);
  EXPECT_LT(left, 10.0);
  user.input.seconds = left;
  user.frame();
  EXPECT_FALSE(user.says("saved "));
  EXPECT_EQ(user.ui.next_change(), rheo::forever);
}

TEST(ViewUi, ARecordingSlowerThanATickAFrameSaysHowFastItIs) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  for (int k = 0; k < 7; ++k) user.key(Key::minus);
  user.key(Key::f9);
  EXPECT_TRUE(user.says("a tick a frame, x0.06 of real time"));
  user.key(Key::space);
  ASSERT_TRUE(user.until([](const Display& d) { return d.ticks >= 5; }));
  EXPECT_EQ(user.ui.shown().ticks, 5);
  EXPECT_TRUE(user.says("recording, frame 6"));
}

TEST(ViewUi, TheSessionsStateIsToldFromTheFirstChangeOn) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, block(), output_folder());
  EXPECT_TRUE(user.says("session: nothing has happened yet"));
  ASSERT_TRUE(user.ticks(5));
  user.frame();
  EXPECT_TRUE(user.says("session: whole"));
  rheo::Scene edited = *user.ui.shown().scene;
  edited.material.mu_ela *= 2.0;
  user.physics.edit(edited);
  ASSERT_TRUE(
      user.until([&](const Display& d) { return d.scene->material.mu_ela == edited.material.mu_ela; }));
  user.frame();
  EXPECT_TRUE(user.says("no session: changed at t > 0"));
  user.key(key_of('R'));
  ASSERT_TRUE(user.until([](const Display& d) { return d.ticks == 0; }));
  ASSERT_TRUE(user.ticks(5));
  user.frame();
  EXPECT_TRUE(user.says("session: whole"));
}

}  // namespace
}  // namespace view_tests
