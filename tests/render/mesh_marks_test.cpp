// What is drawn around and over the mesh: hatches, arrows, heading, rest shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh_pictures.hpp"

namespace mesh_pictures {
namespace {

TEST_F(MeshPictures, HatchesStandOutsideOfHeldEdgesOnly) {
  Body body = bodies::rectangle(2, 1, 5, 3);
  const Image without = draw(body.layout(), body.frame());
  const Box box = drawn(without);
  for (int j = 0; j < 3; ++j) body.hold(j * 5);
  const Box hatches = support::find_difference(without, draw(body.layout(), body.frame()));
  EXPECT_GT(hatches.count, 50);
  EXPECT_LE(hatches.x1, box.x0 + 2) << "outside, but for the foot under the outline";
  EXPECT_GE(hatches.x0, box.x0 - 16);
  EXPECT_GE(hatches.y0, box.y0 - 16);
  EXPECT_LE(hatches.y1, box.y1 + 16);
}

TEST_F(MeshPictures, ASingleHeldNodeIsADotAndNoHatch) {
  Body body = bodies::rectangle(2, 1, 5, 3);
  const Image without = draw(body.layout(), body.frame());
  for (const int node : {0, 7}) body.hold(node);  // a corner, and one inside
  const Box dots = support::find_difference(without, draw(body.layout(), body.frame()));
  EXPECT_GT(dots.count, 10);
  EXPECT_LT(dots.count, 100);
}

// The left side held along both axes, along x and along y: three marks, and rollers stand on a ground, a line
// along the whole side.
TEST_F(MeshPictures, RollersAreToldFromWhatIsFixedAndFromGuides) {
  Body fixed = bodies::rectangle(2, 1, 5, 9);
  Body rolls = fixed, guided = fixed;
  const Image without = draw(fixed.layout(), fixed.frame());
  for (int j = 0; j < 9; ++j) {
    fixed.hold(5 * j);
    rolls.held.push_back(2 * 5 * j);
    guided.held.push_back(2 * 5 * j + 1);
  }
  const Box box = drawn(without);
  const auto longest_column = [&](const Body& body) {
    const Image with = draw(body.layout(), body.frame());
    int longest = 0;
    for (int x = box.x0 - 16; x < box.x0 - 2; ++x) {
      int inked = 0;
      for (int y = box.y0; y <= box.y1; ++y)
        if (support::distance(at(with, x, y), at(without, x, y)) > 40) ++inked;
      longest = std::max(longest, inked);
    }
    return static_cast<double>(longest) / (box.y1 - box.y0);
  };
  EXPECT_GT(longest_column(rolls), 0.95);
  EXPECT_LT(longest_column(fixed), 0.6);
  EXPECT_LT(longest_column(guided), 0.6);
  EXPECT_GT(
      support::find_difference(draw(fixed.layout(), fixed.frame()), draw(guided.layout(), guided.frame()))
          .count,
      100);
}

// The left edge in a few parts and in parts shorter than the distance of the strokes.
TEST_F(MeshPictures, HatchesDoNotDependOnTheDivisionOfTheHeldEdge) {
  std::vector<int> inked;
  for (const int parts : {1, 2, 100}) {
    Body body = bodies::rectangle(2, 1, 2, parts + 1);
    const Image without = draw(body.layout(), body.frame());
    for (int j = 0; j <= parts; ++j) body.hold(2 * j);
    const Image with = draw(body.layout(), body.frame());
    const int edge = drawn(without).x0;
    inked.push_back(support::find(with, [&](int x, int y, const Pixel&) {
                      return x < edge - 1 && support::distance(at(with, x, y), at(without, x, y)) > 40;
                    }).count);
  }
  EXPECT_GT(inked[0], 100);
  // The same strokes, but for the rounding of the way walked.
  EXPECT_NEAR(inked[1], inked[0], 0.03 * inked[0]);
  EXPECT_NEAR(inked[2], inked[0], 0.03 * inked[0]);
}

TEST_F(MeshPictures, AShortHeldEdgeHasAHatch) {
  Body body = bodies::rectangle(2, 1, 2, 101);
  const Image without = draw(body.layout(), body.frame());
  // One edge of about three pixels in the middle of the left side.
  for (const int node : {100, 102}) body.hold(node);
  const Box hatch = support::find_difference(without, draw(body.layout(), body.frame()), 40);
  EXPECT_GT(hatch.count, 5);
  EXPECT_LT(hatch.count, 40) << "one stroke";
}

// On the right side of a 2 x 1 rectangle; the value stands beside the middle one.
std::vector<render::TractionArrow> three_arrows(double traction) {
  return {{{2.0, 0.15}, {traction, 0}}, {{2.0, 0.5}, {traction, 0}}, {{2.0, 0.85}, {traction, 0}}};
}

// The lowest of three_arrows(), of a body that is drawn in `box`.
Box lowest_arrow(const Image& image, const Box& box) {
  const int row = box.y1 - static_cast<int>(0.15 * box.height());
  return support::find(image,
                       [row](int, int y, const Pixel& p) { return std::abs(y - row) < 12 && is_red(p); });
}

int red_in_column(const Image& image, const Box& box, int x) {
  int n = 0;
  for (int y = box.y0; y <= box.y1; ++y) n += is_red(at(image, x, y));
  return n;
}

TEST_F(MeshPictures, ArrowsPullFromTheEdgeAndPressOntoIt) {
  Body body = bodies::rectangle(2, 1, 5, 3);
  render::MeshLayout layout = body.layout();
  layout.arrow_scale = 10;
  const Image without = draw(layout, body.frame());
  const Box box = drawn(without);
  for (const double pull : {10.0, -10.0}) {
    body.arrows = three_arrows(pull);
    const Image with = draw(layout, body.frame());
    const Box arrows = support::find_difference(without, with);
    EXPECT_GT(arrows.count, 80);
    EXPECT_GE(arrows.x0, box.x1 - 2) << "either way outside of the body";
    // The head is the widest: it is far from the edge when pulling, at the edge when pressing.
    const Box lowest = lowest_arrow(with, box);
    const int near = red_in_column(with, lowest, lowest.x0 + 3),
              far = red_in_column(with, lowest, lowest.x1 - 3);
    if (pull > 0) {
      EXPECT_LT(near, far);
    } else {
      EXPECT_GT(near, far);
    }
  }
}

TEST_F(MeshPictures, APullingArrowStaysOneWhenTheBodyTurnsInsideOut) {
  Body body = bodies::rectangle(2, 1, 5, 3);
  render::MeshLayout layout = body.layout();
  layout.arrow_scale = 10;
  const Image without = draw(layout, body.frame());
  body.arrows = three_arrows(10);
  const Box upright = support::find_difference(without, draw(layout, body.frame()));
  for (std::size_t i = 1; i < body.positions.size(); i += 2)
    body.positions[i] = 1 - body.positions[i];  // mirrored
  const Box mirrored = support::find_difference(without, draw(layout, body.frame()));
  EXPECT_EQ(upright.x1, mirrored.x1);
}

// The triangle's first edge goes through the origin's right in the direction `along`, its body lies on the
// left.
Body slanted_triangle(double along) {
  Body body;
  const double c = std::cos(along), s = std::sin(along);
  body.rest = {0, 0, c, s, 0.5 * c - 0.7 * s, 0.5 * s + 0.7 * c};
  body.triangles = {0, 1, 2};
  body.boundary = {0, 1, 1, 2, 2, 0};
  body.positions = body.rest;
  body.scalar.assign(3, 0.0);
  return body;
}

TEST_F(MeshPictures, ArrowsTouchTheMiddleOfASlantedEdge) {
  for (int slant = 0; slant < 360; slant += 40) {
    Body body = slanted_triangle(slant * std::numbers::pi / 180);
    render::MeshLayout layout = body.layout();
    layout.arrow_scale = 1;
    const Box box = drawn(draw(layout, body.frame()));
    const double middle_x = (body.rest[0] + body.rest[2]) / 2, middle_y = (body.rest[1] + body.rest[3]) / 2;
    // The outline adds a pixel to either side.
    const double scale = (box.width() - 2) / (layout.bounds[2] - layout.bounds[0]);
    const double x = box.x0 + 1 + (middle_x - layout.bounds[0]) * scale;
    const double y = box.y0 + 1 + (layout.bounds[3] - middle_y) * scale;
    for (int turn = 0; turn < 360; turn += 40) {
      const double angle = turn * std::numbers::pi / 180;
      body.arrows = {{{middle_x, middle_y}, {std::cos(angle), std::sin(angle)}}};
      const Image image = draw(layout, body.frame());
      double nearest = 1e9;
      support::find(image, [&](int px, int py, const Pixel& p) {
        if (is_red(p)) nearest = std::min(nearest, std::hypot(px + 0.5 - x, py + 0.5 - y));
        return false;
      });
      // A gap of 1.6 pixels, one of soft rims, and two of the box's rounding.
      EXPECT_LT(nearest, 5) << slant << " " << turn;
    }
  }
}

// A traction keeps its direction while the body turns: what pressed at rest pulls now.
TEST_F(MeshPictures, ArrowsStayOutsideOfABodyThatTurned) {
  for (const double pull : {1.0, -1.0}) {
    Body body = slanted_triangle(0);
    render::MeshLayout layout = body.layout();
    layout.bounds = {-1, -1, 1, 1};
    layout.arrow_scale = 1;
    for (int turn = 0; turn < 360; turn += 45) {
      body.positions = slanted_triangle(turn * std::numbers::pi / 180).rest;
      body.arrows.clear();
      const Image without = draw(layout, body.frame());
      const double nx = std::sin(turn * std::numbers::pi / 180),
                   ny = -std::cos(turn * std::numbers::pi / 180);
      body.arrows = {
          {{(body.positions[0] + body.positions[2]) / 2, (body.positions[1] + body.positions[3]) / 2},
           {pull * nx, pull * ny}}};
      const Image with = draw(layout, body.frame());
      const Box inside = support::find(with, [&](int x, int y, const Pixel& p) {
        const Pixel before = at(without, x, y);
        return is_red(p) && before[2] > before[0] + 20;  // the plain fill
      });
      EXPECT_LT(inside.count, 4) << turn << " " << pull;
    }
  }
}

TEST_F(MeshPictures, ArrowLengthIsProportionalToTheTraction) {
  Body body = bodies::rectangle(2, 1, 2, 2);
  render::MeshLayout layout = body.layout();
  layout.arrow_scale = 10;
  const Box box = drawn(draw(layout, body.frame()));
  const auto length = [&](double traction) {
    body.arrows = three_arrows(traction);
    return lowest_arrow(draw(layout, body.frame()), box).width();
  };
  const int full = length(10);
  EXPECT_GT(full, 20);
  EXPECT_NEAR(length(5), full / 2.0, 3);
}

TEST_F(MeshPictures, TitleAndTimeAreInTheHeading) {
  const Body body = bodies::rectangle(2, 1, 2, 2);
  render::MeshLayout layout = body.layout();
  const Image bare = draw(layout, body.frame(0.5));
  layout.title = "A title with Ünïcödé";
  const Box title = support::find_difference(bare, draw(layout, body.frame(0.5)));
  EXPECT_GT(title.count, 200);
  EXPECT_LT(title.y1, heading);
  EXPECT_LT(title.x1, width / 2);
  const Box time = support::find_difference(bare, draw(body.layout(), body.frame(0.9)));
  EXPECT_GT(time.count, 10);
  EXPECT_LT(time.y1, heading);
  EXPECT_GT(time.x0, width / 2);
}

TEST_F(MeshPictures, AnEndlessTitleLeavesTheTimeFree) {
  const Body body = bodies::rectangle(2, 1, 2, 2);
  render::MeshLayout layout = body.layout();
  const Image bare = draw(layout, body.frame(0.5));
  layout.title = std::string(500, 'W');
  const Box title = support::find_difference(bare, draw(layout, body.frame(0.5)));
  const Box time = support::find(bare, [](int, int y, const Pixel& p) {
    return y < heading && support::distance(p, support::paper) > 60;
  });
  EXPECT_LT(title.x1, time.x0);
}

TEST_F(MeshPictures, RestShapeIsAFaintDashedOutline) {
  Body body = bodies::rectangle(1, 1, 2, 2);
  for (std::size_t i = 0; i < body.positions.size(); i += 2) body.positions[i] += 2.0;
  const Image image = draw(body.layout(), body.frame());
  const Box solid = drawn(image);
  int dark = 0, light = 0;
  const int row = (solid.y0 + solid.y1) / 2;
  const Box rest = support::find(
      image, [&](int x, int y, const Pixel& p) { return y > heading && x < width / 2 && p[0] < 230; });
  for (int y = rest.y0 + 5; y < rest.y1 - 5; ++y) {
    int darkest = 255;
    for (int x = rest.x0; x < rest.x0 + 3; ++x) darkest = std::min(darkest, at(image, x, y)[0]);
    (darkest < 200 ? dark : light) += 1;
    EXPECT_GT(darkest, 90) << "fainter than the outline";
  }
  EXPECT_GT(dark, 20);
  EXPECT_GT(light, 20);
  EXPECT_EQ(at(image, (rest.x0 + rest.x1) / 2, row), support::paper) << "not filled";
}

TEST_F(MeshPictures, DashesRunOnOverTheEdgesOfAFineBoundary) {
  // The rest shape's left side and top, the deformed shape being far away: lengths of dashes and gaps.
  const auto runs = [&](int nx, int ny) {
    Body body = bodies::rectangle(1, 1, nx, ny);
    for (std::size_t i = 0; i < body.positions.size(); i += 2) body.positions[i] += 2.0;
    const Image image = draw(body.layout(), body.frame());
    const Box rest = support::find(
        image, [](int x, int y, const Pixel& p) { return y > heading && x < width / 2 - 60 && p[0] < 200; });
    std::vector<int> lengths;
    bool dashed = false;
    int share = 0;
    for (int x = rest.x0 + 3; x < rest.x1 - 3; ++x) {
      int darkest = 255;
      for (int y = rest.y0 - 1; y < rest.y0 + 3; ++y) darkest = std::min(darkest, at(image, x, y)[0]);
      const bool dash = darkest < 200;
      if (lengths.empty() || dash != dashed) lengths.push_back(0);
      ++lengths.back();
      dashed = dash;
      share += dash;
    }
    EXPECT_GT(lengths.size(), 20u);
    // Whole runs only.
    const auto [least, most] = std::minmax_element(lengths.begin() + 1, lengths.end() - 1);
    EXPECT_GE(*least, 1);
    EXPECT_LE(*most, 6) << "of a period of 6 pixels";
    return share / static_cast<double>(rest.width() - 6);
  };
  const double whole = runs(2, 2);
  EXPECT_GT(whole, 0.3);
  EXPECT_LT(whole, 0.8);
  for (const int n : {7, 40, 150}) EXPECT_NEAR(runs(n, n), whole, 0.04) << n;
}

}  // namespace
}  // namespace mesh_pictures
