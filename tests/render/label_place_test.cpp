// Places for the value of a traction: clear of arrows and body.
#include "label_place.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mesh_pictures.hpp"

namespace mesh_pictures {
namespace {

using render::free_place;
using render::Point;
using render::Rect;
using render::Stroke;

constexpr Rect area{0, 0, 400, 300};

std::vector<Stroke> outline_of(const Rect& r) {
  const Point a{r.x0, r.y0}, b{r.x1, r.y0}, c{r.x1, r.y1}, d{r.x0, r.y1};
  return {{a, b, 1}, {b, c, 1}, {c, d, 1}, {d, a, 1}};
}

TEST(FreePlace, IsTheWantedOneWhereThatIsFree) {
  const Point p = free_place({200, 150}, 40, 12, area, {}, {});
  EXPECT_EQ(p.x, 200);
  EXPECT_EQ(p.y, 150);
}

TEST(FreePlace, IsInTheAreaWhateverIsWanted) {
  for (const Point wanted : {Point{-50, 150}, {200, 1e4f}, {401, -3}}) {
    const Point p = free_place(wanted, 40, 12, area, {}, {});
    EXPECT_TRUE(p.x >= 20 && p.x <= 380 && p.y >= 6 && p.y <= 294) << p.x << " " << p.y;
  }
}

TEST(FreePlace, IsBesideAStrokeAndBesideABodyEvenFromItsMiddle) {
  const std::vector<Stroke> line{{{0, 150}, {400, 150}, 3}};
  const Point beside = free_place({200, 152}, 40, 12, area, line, {});
  EXPECT_GE(std::abs(beside.y - 150), 6 + 3);
  EXPECT_LT(std::abs(beside.y - 150), 6 + 3 + 5) << "no farther than a step of a third of its height";
  const std::vector<Stroke> body = outline_of({100, 50, 300, 250});
  const Point outside = free_place({200, 160}, 40, 12, area, {}, body);
  EXPECT_TRUE(outside.x <= 79 || outside.x >= 321 || outside.y <= 43 || outside.y >= 257)
      << outside.x << " " << outside.y;
}

TEST(FreePlace, HidesTheBodyRatherThanAStrokeWhereItMust) {
  const std::vector<Stroke> body = outline_of({-10, -10, 410, 310}), line{{{200, 0}, {200, 300}, 3}};
  const Point p = free_place({200, 150}, 40, 12, area, line, body);
  EXPECT_GE(std::abs(p.x - 200), 20 + 3);
}

TEST(FreePlace, OfRandomStrokesMeetsNone) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> x(0, 400), y(0, 300);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Stroke> strokes;
    for (int i = 0; i < 6; ++i) strokes.push_back({{x(random), y(random)}, {x(random), y(random)}, 2});
    const Point p = free_place({x(random), y(random)}, 40, 12, area, strokes, {});
    for (const Stroke& s : strokes) {
      for (int i = 0; i <= 500; ++i) {
        const float t = static_cast<float>(i) / 500;
        const float px = s.from.x + t * (s.to.x - s.from.x), py = s.from.y + t * (s.to.y - s.from.y);
        EXPECT_FALSE(std::abs(px - p.x) < 20 && std::abs(py - p.y) < 6) << trial;
      }
    }
  }
}

// A tall block sheared by a traction along its top, which tilts: the arrows stand one above another. The
// value's plate would hide part of an arrow: every arrow's row keeps as much ink as when it stands alone.
class TractionValue : public ::testing::TestWithParam<std::pair<int, int>> {};

INSTANTIATE_TEST_SUITE_P(Sizes, TractionValue,
                         ::testing::Values(std::pair{640, 360}, std::pair{800, 600}, std::pair{400, 800},
                                           std::pair{320, 180}, std::pair{240, 160}, std::pair{2000, 160},
                                           std::pair{240, 2000}));

TEST_P(TractionValue, StandsClearOfTheArrowsOfATiltedEdge) {
  const int width = GetParam().first, height = GetParam().second;
  RHEO_OPEN_OR_SKIP(context, render::Backend::automatic, width, height);
  for (const double tilt : {-0.5, -0.3, 0.0, 0.3, 0.5}) {
    Body body = bodies::rectangle(1, 2, 5, 9);
    for (std::size_t i = 0; i < body.nodes(); ++i) {
      const double x = body.rest[2 * i], y = body.rest[2 * i + 1];
      body.positions[2 * i] = x + 0.2 * y * y / 4;
      body.positions[2 * i + 1] = y + tilt * (x - 0.5) * y / 2;
    }
    std::vector<render::TractionArrow> arrows;
    // In a small picture the outer two only: more would be thinned out.
    for (std::size_t i = 40; i < 44; i += std::min(width, height) < 300 ? 3 : 1)
      arrows.push_back({{(body.positions[2 * i] + body.positions[2 * i + 2]) / 2,
                         (body.positions[2 * i + 1] + body.positions[2 * i + 3]) / 2},
                        {12300, 0}});
    render::MeshLayout layout = body.layout();
    layout.arrow_scale = 12300;
    render::MeshPicture picture(*context, layout);
    const auto draw = [&](std::vector<render::TractionArrow> drawn) {
      body.arrows = std::move(drawn);
      Image image;
      picture.draw(body.frame(), image);
      return image;
    };
    const Image together = draw(arrows), without = draw({});
    for (std::size_t k = 0; k < arrows.size(); ++k) {
      const Image alone = draw({arrows[k]});
      int arrow = 0, lost = 0;
      support::find(alone, [&](int x, int y, const Pixel& p) {
        // The arrow's own colour, whole; no figure has twelve such pixels in a row.
        for (int d = 0; d < 12; ++d)
          if (x + d >= width || !is_red(at(alone, x + d, y))) return false;
        arrow += is_red(p) && !is_red(at(without, x, y));
        lost += is_red(p) && !is_red(at(together, x, y));
        return false;
      });
      EXPECT_GT(arrow, 4) << tilt << " " << k;
      EXPECT_EQ(lost, 0) << tilt << " " << k;
    }
  }
}

}  // namespace
}  // namespace mesh_pictures
