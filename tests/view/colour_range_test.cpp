// The range of the colours: automatic, held, typed; what another quantity and another scene make of it.
#include <gmock/gmock.h>

#include <fstream>

#include "draw_or_skip.hpp"
#include "rheo/io/scene_text.hpp"
#include "view_scene.hpp"

namespace view_tests {
namespace {

using app::view::RangeMode;
using testing::ElementsAre;

// A load that makes w some tens of Pa m at most.
rheo::Scene loaded_block() {
  rheo::Scene scene = block();
  rheo::Traction& load = scene.tractions.emplace_back();
  load.edges = scene.mesh.edge_groups.at("right");
  load.keys = {{0.0, {100.0, 0.0}}};
  return scene;
}

// Ten times the load, between ticks.
void load_more(Driver& user) {
  rheo::Scene scene = *user.ui.shown().scene;
  scene.tractions[0].keys[0].p.x *= 10.0;
  user.physics.edit(scene);
  ASSERT_TRUE(user.until([](const Display& d) { return d.scene->tractions[0].keys[0].p.x > 500.0; }));
  ASSERT_TRUE(user.ticks(200));
}

TEST(ViewColours, AHeldRangeKeepsItsNumbersUnderAnotherLoad) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, loaded_block(), output_folder());
  ASSERT_TRUE(user.ticks(200));
  ASSERT_TRUE(user.click_widget("held"));
  user.frames(2);
  const std::array<double, 2> held = user.ui.picture().range();
  load_more(user);
  EXPECT_EQ(user.ui.picture().range(), held);
  EXPECT_EQ(user.ui.style().range_mode, RangeMode::held);
  ASSERT_TRUE(user.click_widget("auto"));
  user.frames(2);
  EXPECT_GT(user.ui.picture().range()[1], 2.0 * held[1]) << "the load has changed what is to be seen";
}

TEST(ViewColours, ATypedRangeIsTakenAsAWholeOrRefused) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, loaded_block(), output_folder());
  ASSERT_TRUE(user.ticks(200));
  const std::array<double, 2> seen = user.ui.picture().range();
  ASSERT_TRUE(user.click_widget("typed"));
  user.frames(2);
  EXPECT_EQ(user.ui.picture().range(), seen) << "to begin with";
  ASSERT_TRUE(user.type_into("low, high y", "8"));
  EXPECT_THAT(user.ui.picture().range(), ElementsAre(0.0, 8.0));
  load_more(user);
  EXPECT_THAT(user.ui.picture().range(), ElementsAre(0.0, 8.0));

  for (const char* low : {"8", "20", "-1e31"}) {  // none, the wrong way round, too large
    ASSERT_TRUE(user.type_into("low, high x", low));
    EXPECT_THAT(user.ui.picture().range(), ElementsAre(0.0, 8.0)) << low;
    EXPECT_TRUE(user.says("low < high is needed")) << low;
  }
  ASSERT_TRUE(user.type_into("low, high x", "20"));
  ASSERT_TRUE(user.type_into("low, high y", "30"));
  EXPECT_THAT(user.ui.picture().range(), ElementsAre(20.0, 30.0)) << "both ends, one after the other";
  EXPECT_TRUE(user.says("colours from 20 to 30"));
  EXPECT_FALSE(user.says("low < high is needed"));
}

TEST(ViewColours, ARangeDoesNotOutliveItsUnit) {
  RHEO_DRAW_OR_SKIP(context);
  Driver user(*context, loaded_block(), output_folder());
  ASSERT_TRUE(user.ticks(200));
  ASSERT_TRUE(user.click_widget("held"));
  user.frames(2);
  const std::array<double, 2> held = user.ui.picture().range();
  user.key(key_of('C'));
  user.frames(2);
  ASSERT_EQ(user.ui.style().color, rheo::ColorBy::w_mu);
  EXPECT_EQ(user.ui.picture().range(), held) << "of the same unit, to be compared";
  user.key(key_of('C'));
  user.key(key_of('C'));
  user.frames(2);
  ASSERT_EQ(user.ui.style().color, rheo::ColorBy::speed);
  EXPECT_EQ(user.ui.style().range_mode, RangeMode::automatic);
  EXPECT_NE(user.ui.picture().range(), held);
}

TEST(ViewColours, AnotherSceneBringsItsOwn) {
  RHEO_DRAW_OR_SKIP(context);
  const fs::path folder = output_folder();
  const auto drop = [&](Driver& user, const rheo::Scene& scene, std::int64_t body) {
    std::ofstream(folder / "other.toml") << rheo::scene_text(scene);
    user.input.dropped = {folder / "other.toml"};
    user.frame();
    const bool there = user.until([&](const Display& d) { return d.body == body; });
    user.frames(2);
    return there;
  };
  Driver user(*context, loaded_block(), folder);
  ASSERT_TRUE(user.click_widget("held"));
  rheo::Scene other = loaded_block();
  other.picture.color = rheo::ColorBy::w_mu;
  other.picture.range_auto = false;
  other.picture.range = {1.0, 4.0};
  ASSERT_TRUE(drop(user, other, 1));
  EXPECT_EQ(user.ui.style().color, rheo::ColorBy::w_mu);
  EXPECT_EQ(user.ui.style().range_mode, RangeMode::typed);
  EXPECT_THAT(user.ui.picture().range(), ElementsAre(1.0, 4.0));
  other.picture.range_auto = true;
  ASSERT_TRUE(drop(user, other, 2));
  EXPECT_EQ(user.ui.style().range_mode, RangeMode::automatic);
}

}  // namespace
}  // namespace view_tests
