// Which edges a cursor takes, and how hard.
#include "view/hand.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "rheo/io/scene_file.hpp"
#include "view/core.hpp"
#include "view_scene.hpp"

namespace view_tests {
namespace {

using app::view::default_push;
using app::view::Display;
using app::view::Reach;
using app::view::reach_at;

// Two squares of 0.1 m with a gap of 10 mm, the right one ten times as stiff, its upper half ten times more.
rheo::Scene two_squares() {
  const std::string body = R"(
[[body]]
name = "NAME"
position = [AT, 0.0]
[body.mesh]
shape = "rectangle"
size = [0.1, 0.1]
nodes = [11, 11]
[body.material]
lambda_ela = STIFF
mu_ela = STIFF
lambda_vis = 800
mu_vis = 300
density = 1000
[[body.fix]]
edges = "bottom"
)";
  const auto with = [&](const std::string& name, const std::string& at, const std::string& stiff) {
    std::string text = body;
    text.replace(text.find("NAME"), 4, name);
    text.replace(text.find("AT,"), 2, at);
    text.replace(text.find("STIFF"), 5, stiff);
    return text.replace(text.find("STIFF"), 5, stiff);
  };
  const std::string hard = R"(
[[body.region]]
name = "cap"
box = [0.0, 0.05, 0.1, 0.1]
[body.region.material]
lambda_ela = 100000
mu_ela = 100000
lambda_vis = 800
mu_vis = 300
density = 1000
)";
  return rheo::parse_scene(
      with("soft", "0.0", "1000") + with("hard", "0.11", "10000") + hard + "[time]\nduration = 5\n",
      "squares.toml", ".");
}

struct Shown {
  explicit Shown(rheo::Scene scene) : pieces(rheo::pieces_of(scene.mesh)) {
    app::view::Core(std::move(scene), {}).show(display);
  }
  // 1 mm is 10 pixels, the picture's origin is the plane's.
  Reach reach(double x, double y, double radius) const {
    const auto cursor = plane.pixel(x, y);
    return reach_at(display, pieces, plane, cursor, radius, 64);
  }
  rheo::Vec2 at(int node) const { return display.scene->mesh.points[static_cast<std::size_t>(node)]; }

  std::vector<int> pieces;
  Display display;
  render::PlaneInPicture plane{0.0, 0.0, 10000.0};
};

TEST(ViewHand, TakesEdgesOfTheNearestBodyOnly) {
  const Shown shown(two_squares());
  // 4 mm from the left one, 6 mm from the right one; the brush reaches 20 mm.
  const Reach left = shown.reach(0.104, 0.05, 200.0);
  ASSERT_GE(left.edges.size(), 3u);
  for (const rheo::Edge& edge : left.edges) EXPECT_LE(shown.at(edge[0]).x, 0.1);
  EXPECT_LE(shown.at(left.nearest.edge[0]).x, 0.1);
  const Reach right = shown.reach(0.106, 0.05, 200.0);
  ASSERT_GE(right.edges.size(), 3u);
  for (const rheo::Edge& edge : right.edges) EXPECT_GE(shown.at(edge[0]).x, 0.11);
  EXPECT_TRUE(shown.reach(0.05, 0.05, 200.0).edges.empty()) << "within the body";
}

TEST(ViewHand, HoldsThePickedEdgeNextToTheCursorThere) {
  const Shown shown(two_squares());
  const Reach reach = shown.reach(0.101, 0.043, 200.0);
  EXPECT_THAT(reach.edges, testing::Contains(reach.nearest.edge));
  const rheo::Vec2 place = app::view::place_of(reach.nearest, shown.display.positions);
  EXPECT_NEAR(place.x, 0.1, 1e-6);
  EXPECT_NEAR(place.y, 0.043, 1e-6);
  // One edge alone, by its end.
  const Reach end = shown.reach(0.1, 0.049, 20.0);
  ASSERT_EQ(end.edges.size(), 1u);
  EXPECT_NEAR(app::view::place_of(end.nearest, shown.display.positions).y, 0.049, 1e-6);
}

TEST(ViewHand, PushesAsHardAsTheMaterialThereAsksFor) {
  const Shown shown(two_squares());
  const auto push = [&](double x, double y) {
    const Reach reach = shown.reach(x, y, 100.0);
    return default_push(*shown.display.scene, shown.pieces, reach.nearest.edge);
  };
  const double diagonal = std::hypot(0.1, 0.1);
  EXPECT_NEAR(push(0.0, 0.055), 0.5 * 3000 / diagonal, 1e-6);
  EXPECT_NEAR(push(0.21, 0.025), 0.5 * 30000 / diagonal, 1e-5);
  EXPECT_NEAR(push(0.21, 0.075), 0.5 * 300000 / diagonal, 1e-4) << "the cap";
}

}  // namespace
}  // namespace view_tests
