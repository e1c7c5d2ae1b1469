// The panel of materials on the running body, and what a session keeps of it.
#include <gmock/gmock.h>

#include <cmath>

#include "draw_or_skip.hpp"
#include "rheo/io/scene_file.hpp"
#include "view_scene.hpp"

namespace view_tests {
namespace {

using Holds = std::function<bool(const rheo::Material&)>;

class ViewMaterial : public testing::Test {
 protected:
  void open(rheo::Scene scene) {
    context_ = open_or_null();
    if (!context_) GTEST_SKIP() << "this machine has no way to draw (libosmesa6)";
    folder_ = output_folder();
    user_ = std::make_unique<Driver>(*context_, std::move(scene), folder_);
    user_->input.height = 1600;
    user_->frames(3);
  }
  bool becomes(const Holds& holds) {
    const bool so = user_->until([&](const Display& d) { return holds(d.scene->material); });
    user_->frames(3);
    return so;
  }
  bool click(const std::string& name, const Holds& holds) {
    return user_->click_widget(name) && becomes(holds);
  }

  std::unique_ptr<render::Context> context_;
  fs::path folder_;
  std::unique_ptr<Driver> user_;
};

TEST_F(ViewMaterial, ABranchIsMadeElasticAndRelaxingAgain) {
  open(block());
  if (!user_) return;
  ASSERT_TRUE(user_->ticks(10));
  EXPECT_TRUE(click("lambda relaxes", [](auto& m) { return std::isinf(m.lambda_vis); }));
  EXPECT_EQ(user_->widget("lambda_vis"), nullptr);
  EXPECT_NE(user_->widget("mu_vis"), nullptr);
  EXPECT_TRUE(user_->ticks(10)) << "it goes on";
  EXPECT_TRUE(click("lambda relaxes", [](auto& m) { return m.lambda_vis == 800.0; })) << "as it was";
  EXPECT_TRUE(click("mu relaxes", [](auto& m) { return std::isinf(m.mu_vis); }));
  EXPECT_TRUE(click("mu relaxes", [](auto& m) { return m.mu_vis == 300.0; }));
  EXPECT_TRUE(user_->ticks(10));
}

TEST_F(ViewMaterial, APurelyElasticSceneCanRelax) {
  rheo::Scene scene = block();
  scene.material.lambda_vis = scene.material.mu_vis = rheo::forever;
  open(std::move(scene));
  if (!user_) return;
  EXPECT_EQ(user_->widget("lambda_vis"), nullptr);
  EXPECT_TRUE(click("lambda relaxes", [](auto& m) { return m.lambda_vis == 4000.0; })) << "within a second";
  EXPECT_NE(user_->widget("lambda_vis"), nullptr);
  EXPECT_TRUE(user_->ticks(10));
}

TEST_F(ViewMaterial, BranchesAndPartsComeAndGoAndASessionKeepsThem) {
  open(block());
  if (!user_) return;
  Driver& user = *user_;
  ASSERT_TRUE(user.ticks(10));
  EXPECT_EQ(user.widget("Remove the last"), nullptr);
  EXPECT_TRUE(click("Add a branch", [](auto& m) { return m.more_branches.size() == 1; }));
  EXPECT_TRUE(click("Add a branch", [](auto& m) { return m.more_branches.size() == 2; }));
  EXPECT_NE(user.widget("branch 3"), nullptr);
  EXPECT_TRUE(click("Remove the last", [](auto& m) { return m.more_branches.size() == 1; }));
  EXPECT_EQ(user.widget("branch 3"), nullptr);
  const rheo::MaxwellBranch added = user.ui.shown().scene->material.more_branches[0];
  EXPECT_EQ(added.lambda_ela, 4000.0);
  EXPECT_DOUBLE_EQ(added.lambda_vis, 80.0) << "a decade quicker";
  // The scene has neither part; both are there to be moved.
  EXPECT_TRUE(click("elastic mu", [](auto& m) { return m.elastic.mu > 0.0; }));
  EXPECT_TRUE(click("viscous lambda", [](auto& m) { return m.viscous.lambda > 0.0; }));
  EXPECT_TRUE(user.ticks(10)) << "applied between steps";
  const rheo::Material edited = user.ui.shown().scene->material;
  user.key(key_of('R'));
  ASSERT_TRUE(user.until([](const Display& d) { return d.ticks == 0; }));
  ASSERT_TRUE(user.ticks(20));
  user.key_with_control(key_of('S'));
  ASSERT_TRUE(user.until([&](const Display&) { return fs::exists(folder_ / "session_001.toml"); }));
  EXPECT_EQ(rheo::read_scene(folder_ / "session_001.toml").material, edited);
}

TEST_F(ViewMaterial, TheBranchThatIsColouredIsRemovedAndAllOfThemShown) {
  rheo::Scene scene = block();
  scene.material.more_branches.push_back({100, 50, 20, 10});
  scene.picture.branch = 2;
  open(std::move(scene));
  if (!user_) return;
  EXPECT_TRUE(click("Remove the last", [](auto& m) { return m.more_branches.empty(); }));
  EXPECT_EQ(user_->ui.shown().scene->picture.branch, 0);
}

}  // namespace
}  // namespace view_tests
