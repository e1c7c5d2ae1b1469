#include "render/mesh_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bodies.hpp"
#include "colormap.hpp"
#include "render/context.hpp"
#include "support.hpp"

namespace {

using bodies::Body;
using render::Image;
using support::at;
using support::Box;
using support::Pixel;

constexpr int width = 640, height = 360;
constexpr int heading = 48;  // rows that title and time take at this size
const double nan = std::numeric_limits<double>::quiet_NaN();

class MeshPictures : public ::testing::Test {
 protected:
  void SetUp() override {
    context_ = support::open(render::Backend::automatic, width, height);
    if (!context_)
      GTEST_SKIP() << "no OpenGL for drawing without a window (libosmesa6, or libegl1 with libgl1-mesa-dri)";
  }

  Image draw(const render::MeshLayout& layout, const render::MeshFrame& frame) {
    render::MeshPicture picture(*context_, layout);
    Image image;
    picture.draw(frame, image);
    return image;
  }

  // Everything below the heading that is not paper.
  static Box drawn(const Image& image) {
    return support::find(image, [](int, int y, const Pixel& p) {
      return y > heading && support::distance(p, support::paper) > 60;
    });
  }

  std::unique_ptr<render::Context> context_;
};

Pixel map_colour(double t) {
  const render::Rgb c = render::make_colormap()[static_cast<std::size_t>(std::lround(255 * t))];
  return {c[0], c[1], c[2]};
}

render::MeshLayout coloured(const Body& body) {
  render::MeshLayout layout = body.layout();
  layout.scalar_name = "|w|";
  layout.scalar_unit = "Pa m";
  return layout;
}

TEST_F(MeshPictures, CornersAreBackground) {
  const Body body = bodies::pulled_beam(9, 4, 2);
  const Image image = draw(coloured(body), body.frame());
  for (const int x : {0, width - 1}) {
    for (const int y : {0, height - 1}) EXPECT_EQ(at(image, x, y), support::paper);
  }
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    ASSERT_EQ(image.rgba[i], 255) << "pictures are opaque";
}

TEST_F(MeshPictures, CameraKeepsTheShapeAndFillsThePicture) {
  for (const double ratio : {0.2, 0.5, 1.0, 2.0, 5.0}) {
    const Body body = bodies::rectangle(ratio * 3e-3, 3e-3, 4, 4);
    const Box box = drawn(draw(body.layout(), body.frame()));
    // The outline's strong part is about a pixel wider than the shape, and each side is cut to whole pixels.
    EXPECT_NEAR(static_cast<double>(box.width() - 1) / (box.height() - 1), ratio,
                3.0 * (1 + ratio) / box.height());
    EXPECT_TRUE(box.width() > 0.8 * width || box.height() > 0.7 * height) << ratio;
    EXPECT_NEAR((box.x0 + box.x1) / 2.0, width / 2.0, 2) << "centred";
  }
}

TEST_F(MeshPictures, TheTopOfTheBodyIsAtTheTop) {
  Body body = bodies::rectangle(1, 1, 2, 2);
  const render::MeshLayout layout = body.layout();
  body.positions[6] = body.positions[4];  // the top right corner moves to the left: the top gets narrow
  const Image image = draw(layout, body.frame());
  const Box box = drawn(image);
  const auto row_width = [&](int y) {
    int n = 0;
    for (int x = 0; x < width; ++x) n += support::distance(at(image, x, y), support::paper) > 20;
    return n;
  };
  EXPECT_GT(row_width(box.y1 - 10), 3 * row_width(box.y0 + 30));
}

TEST_F(MeshPictures, InteriorHasTheColourOfItsValue) {
  Body body = bodies::rectangle(1, 1, 2, 2);
  render::MeshLayout layout = coloured(body);
  layout.range = {-2, 3};
  for (const double t : {0.0, 0.25, 0.5, 0.8, 1.0}) {
    body.scalar.assign(4, -2 + 5 * t);
    const Image image = draw(layout, body.frame());
    const Box box = support::find(image, [](int x, int y, const Pixel& p) {
      return y > heading && x < width - 70 && support::distance(p, support::paper) > 60;
    });
    const int x = box.x0 + box.width() / 3,
              y = box.y1 - box.height() / 3 + 20;  // inside of the first triangle
    EXPECT_LE(support::distance(at(image, x, y), map_colour(t)), 2) << t;
  }
}

TEST_F(MeshPictures, ColourIsLinearOverATriangle) {
  Body body = bodies::rectangle(2, 1, 2, 2);
  body.scalar = {0, 1, 0, 1};  // x / 2
  const Image image = draw(coloured(body), body.frame());
  const Box box = support::find(image, [](int x, int y, const Pixel& p) {
    return y > heading && x < width - 70 && support::distance(p, support::paper) > 60;
  });
  const int y = box.y1 - 12;  // below the diagonal but at the right end
  for (int x = box.x0 + 10; x < box.x1 - 60; x += 25) {
    const double t = (x + 0.5 - box.x0 - 1) / (box.width() - 2);
    EXPECT_LE(support::distance(at(image, x, y), map_colour(t)), 4)
        << x;  // a pixel is two steps of the map at most
  }
}

TEST_F(MeshPictures, ValuesOutsideOfTheRangeAreClamped) {
  Body body = bodies::rectangle(1, 1, 2, 2);
  const auto colour = [&](double value, std::array<double, 2> range) {
    body.scalar.assign(4, value);
    render::MeshLayout layout = coloured(body);
    layout.range = range;
    const Image image = draw(layout, body.frame());
    return at(image, width / 2 - 70, height / 2 + 60);
  };
  EXPECT_LE(support::distance(colour(-100, {0, 1}), map_colour(0)), 2);
  EXPECT_LE(support::distance(colour(100, {0, 1}), map_colour(1)), 2);
  EXPECT_LE(support::distance(colour(std::numeric_limits<double>::infinity(), {0, 1}), map_colour(1)), 2);
  EXPECT_LE(support::distance(colour(nan, {0, 1}), map_colour(0)), 2);
  EXPECT_LE(support::distance(colour(7, {7, 7}), map_colour(0)), 2) << "a range without extent";
  EXPECT_LE(support::distance(colour(7, {nan, nan}), map_colour(0)), 2) << "a range without numbers";
  EXPECT_LE(support::distance(colour(7, {0, std::numeric_limits<double>::infinity()}), map_colour(0)), 2);
}

TEST_F(MeshPictures, WithoutAScalarThereIsNoBar) {
  const Body body = bodies::rectangle(1, 1, 2, 2);
  const Image plain = draw(body.layout(), body.frame());
  const Image bar = draw(coloured(body), body.frame());
  const auto right = [](int x, int y, const Pixel& p) {
    return x > width - 80 && y > heading && support::distance(p, support::paper) > 60;
  };
  EXPECT_EQ(support::find(plain, right).count, 0);
  EXPECT_GT(support::find(bar, right).count, 500);
}

TEST_F(MeshPictures, HatchesStandOutsideOfHeldEdgesOnly) {
  Body body = bodies::rectangle(2, 1, 5, 3);
  const Image without = draw(body.layout(), body.frame());
  const Box box = drawn(without);
  for (int j = 0; j < 3; ++j) body.held.push_back(j * 5);
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
  body.held = {0, 7};  // a corner, and one inside
  const Box dots = support::find_difference(without, draw(body.layout(), body.frame()));
  EXPECT_GT(dots.count, 10);
  EXPECT_LT(dots.count, 100);
}

// The left edge in a few parts and in parts shorter than the distance of the strokes.
TEST_F(MeshPictures, HatchesDoNotDependOnTheDivisionOfTheHeldEdge) {
  std::vector<int> inked;
  for (const int parts : {1, 2, 100}) {
    Body body = bodies::rectangle(2, 1, 2, parts + 1);
    const Image without = draw(body.layout(), body.frame());
    for (int j = 0; j <= parts; ++j) body.held.push_back(2 * j);
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
  body.held = {100, 102};  // one edge of about three pixels in the middle of the left side
  const Box hatch = support::find_difference(without, draw(body.layout(), body.frame()), 40);
  EXPECT_GT(hatch.count, 5);
  EXPECT_LT(hatch.count, 40) << "one stroke";
}

// On the right side of a 2 x 1 rectangle; the value stands beside the middle one.
std::vector<render::TractionArrow> three_arrows(double traction) {
  return {{{2.0, 0.15}, {traction, 0}}, {{2.0, 0.5}, {traction, 0}}, {{2.0, 0.85}, {traction, 0}}};
}

bool is_red(const Pixel& p) {
  return p[0] > p[2] + 80;
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

TEST_F(MeshPictures, InvertedTrianglesAreDrawnToo) {
  Body body = bodies::rectangle(1, 1, 2, 2);
  render::MeshLayout layout = body.layout();
  for (std::size_t i = 0; i < body.positions.size(); i += 2)
    body.positions[i] = 1 - body.positions[i];  // mirrored
  const Image image = draw(layout, body.frame());
  EXPECT_GT(support::distance(at(image, width / 2 - 50, height / 2), support::paper), 20);
  EXPECT_GT(support::distance(at(image, width / 2 + 50, height / 2), support::paper), 20);
}

TEST_F(MeshPictures, LinesOfADenseMeshFadeInsteadOfTurningItBlack) {
  const Body coarse = bodies::rectangle(2, 1, 9, 5), dense = bodies::rectangle(2, 1, 401, 201);
  const auto darkest_inside = [&](const Body& body) {
    const Image image = draw(body.layout(), body.frame());
    int darkest = 255;
    for (int y = 150; y < 250; ++y) {
      for (int x = 200; x < 440; ++x) darkest = std::min(darkest, at(image, x, y)[2]);
    }
    return darkest;
  };
  EXPECT_LT(darkest_inside(coarse), 160) << "lines are visible";
  EXPECT_GT(darkest_inside(dense), 215) << "only the fill is left, blue 226";
}

TEST_F(MeshPictures, PositionsThatAreNotFiniteDropTheirTrianglesOnly) {
  Body body = bodies::rectangle(2, 1, 3, 2);
  const render::MeshLayout layout = coloured(body);
  const Image whole = draw(layout, body.frame());
  body.positions[4] = nan;  // the lower right node
  body.held = {0, 1, 2};
  body.arrows = {
      {{nan, 0.5}, {10, 0}}, {{2, 0.5}, {nan, 0}}, {{2, 0.5}, {std::numeric_limits<double>::infinity(), 0}}};
  const Image image = draw(layout, body.frame(nan));
  const Box box = support::find(whole, [](int x, int y, const Pixel& p) {
    return y > heading && x < width - 70 && support::distance(p, support::paper) > 60;
  });
  EXPECT_EQ(at(image, box.x0 + box.width() / 8, box.y1 - 20),
            at(whole, box.x0 + box.width() / 8, box.y1 - 20));
  EXPECT_EQ(at(image, box.x1 - 20, box.y1 - 20), support::paper);
  body.positions.assign(body.positions.size(), nan);
  EXPECT_NO_THROW(draw(layout, body.frame()));
  body.positions.assign(body.positions.size(), 1e300);
  EXPECT_NO_THROW(draw(layout, body.frame()));
}

TEST_F(MeshPictures, BoundsOfAnyKindGiveAPicture) {
  const Body body = bodies::rectangle(1, 1, 2, 2);
  const double inf = std::numeric_limits<double>::infinity();
  for (const std::array<double, 4>& bounds : {std::array<double, 4>{0, 0, 0, 0},
                                              {nan, nan, nan, nan},
                                              {0, 0, inf, inf},
                                              {1, 1, 0, 0},
                                              {-1e300, 0, 1e300, 1},
                                              {0, 0, 1, 0},
                                              {5e5, 5e5, 5e5, 5e5}}) {
    render::MeshLayout layout = body.layout();
    layout.bounds = bounds;
    EXPECT_NO_THROW(draw(layout, body.frame()));
  }
}

TEST_F(MeshPictures, AnEmptyMeshIsAnEmptyPicture) {
  const Body body;
  render::MeshLayout layout;
  layout.title = "";
  EXPECT_EQ(drawn(draw(layout, body.frame())).count, 0);
}

TEST_F(MeshPictures, BoundaryOfManyEdgesIsDrawnWhole) {
  Body body = bodies::rectangle(40000, 20000, 40001, 2);  // 80002 boundary edges
  body.held.resize(body.nodes());
  for (std::size_t i = 0; i < body.nodes(); ++i) body.held[i] = static_cast<int>(i);
  const Image image = draw(body.layout(), body.frame());
  const Box box = drawn(image);
  for (const int x : {box.x0 + 30, (box.x0 + box.x1) / 2, box.x1 - 30}) {
    for (const bool top : {true, false}) {
      int darkest = 255;
      for (int k = 0; k < 30; ++k)
        darkest = std::min(darkest, at(image, x, top ? box.y0 + k : box.y1 - k)[0]);
      EXPECT_LT(darkest, 120) << x;  // 1.4 pixels of ink may lie between two rows
    }
  }
}

TEST_F(MeshPictures, ANodeBeyondTheFirstTextureRowIsFound) {
  const Body body = bodies::rectangle(2, 1, 100, 50);  // 5000 nodes, 1024 a row
  const Box small =
      drawn(draw(bodies::rectangle(2, 1, 2, 2).layout(), bodies::rectangle(2, 1, 2, 2).frame()));
  const Box large = drawn(draw(body.layout(), body.frame()));
  EXPECT_EQ(small.x0, large.x0);
  EXPECT_EQ(small.x1, large.x1);
  EXPECT_EQ(small.y0, large.y0);
  EXPECT_EQ(small.y1, large.y1);
}

TEST_F(MeshPictures, FramesDoNotLeakIntoEachOther) {
  Body body = bodies::pulled_beam(9, 4, 2);
  render::MeshLayout layout = coloured(body);
  layout.arrow_scale = 10;
  render::MeshPicture picture(*context_, layout);
  Image first, other, again;
  picture.draw(body.frame(0.1), first);
  Body rest = bodies::rectangle(1, 0.25, 9, 4);
  picture.draw(rest.frame(0.2), other);
  picture.draw(body.frame(0.1), again);
  EXPECT_NE(first.rgba, other.rgba);
  EXPECT_EQ(first.rgba, again.rgba);
  render::MeshPicture moved = std::move(picture);
  moved.draw(body.frame(0.1), again);
  EXPECT_EQ(first.rgba, again.rgba);
}

// Connected parts of ink larger than a letter.
std::vector<Box> large_parts(const Image& image) {
  std::vector<char> seen(image.rgba.size() / 4, 0);
  std::vector<Box> parts;
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
  };
  const auto inked = [&](int x, int y) { return support::distance(at(image, x, y), support::paper) > 20; };
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (seen[index(x, y)] || !inked(x, y)) continue;
      Box box;
      std::vector<std::pair<int, int>> stack{{x, y}};
      seen[index(x, y)] = 1;
      while (!stack.empty()) {
        const auto [px, py] = stack.back();
        stack.pop_back();
        box.x0 = std::min(box.x0, px);
        box.x1 = std::max(box.x1, px);
        box.y0 = std::min(box.y0, py);
        box.y1 = std::max(box.y1, py);
        for (const auto& [qx, qy] : {std::pair{px + 1, py}, {px - 1, py}, {px, py + 1}, {px, py - 1}}) {
          if (qx < 0 || qy < 0 || qx >= image.width || qy >= image.height || seen[index(qx, qy)] ||
              !inked(qx, qy))
            continue;
          seen[index(qx, qy)] = 1;
          stack.push_back({qx, qy});
        }
      }
      if (box.width() > 30 && box.height() > 20) parts.push_back(box);
    }
  }
  return parts;
}

TEST_F(MeshPictures, SheetShowsEveryShapeAtOneScale) {
  Body body = bodies::rectangle(1, 0.5, 3, 2);
  render::MeshLayout layout = body.layout();
  layout.bounds = {0, 0, 1.5, 0.5};
  layout.title = "Sheet";
  std::vector<Body> shapes;
  for (int k = 0; k < 5; ++k) {
    shapes.push_back(body);
    for (std::size_t i = 0; i < body.nodes(); ++i) shapes.back().positions[2 * i] *= 1 + 0.1 * k;
  }
  std::vector<render::MeshFrame> frames;
  for (std::size_t k = 0; k < shapes.size(); ++k)
    frames.push_back(shapes[k].frame(0.25 * static_cast<double>(k)));
  render::MeshPicture picture(*context_, layout);
  const std::vector<Box> parts = large_parts(picture.sheet(frames));
  ASSERT_EQ(parts.size(), 5u);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    EXPECT_NEAR(parts[k].height(), parts[0].height(), 1);
    // The outline adds about three pixels to either side.
    EXPECT_NEAR(parts[k].width() - 3, (parts[0].width() - 3) * (1 + 0.1 * static_cast<double>(k)), 3);
  }
}

TEST_F(MeshPictures, SheetLeavesRoomForArrowsOnlyWhereTheyAre) {
  Body body = bodies::rectangle(4, 1, 5, 2);
  render::MeshLayout layout = body.layout();
  layout.arrow_scale = 10;
  render::MeshPicture picture(*context_, layout);
  const auto shape_width = [&](const std::vector<render::TractionArrow>& arrows) {
    body.arrows = arrows;
    const std::vector<render::MeshFrame> frames{body.frame()};
    const Image image = picture.sheet(frames);
    EXPECT_EQ(support::find(image,
                            [](int x, int y, const Pixel& p) {
                              return is_red(p) && (x < 8 || x >= width - 8 || y >= height - 8);
                            })
                  .count,
              0);
    return support::find(image,
                         [](int, int y, const Pixel& p) {
                           return y > heading + 20 && p[0] < p[2] + 20 &&
                                  support::distance(p, support::paper) > 60;
                         })
        .width();
  };
  const int bare = shape_width({});
  EXPECT_GT(bare, 0.92 * width);
  EXPECT_EQ(shape_width({{{2, 1}, {0, -10}}}), bare) << "above, where there is room";
  const int right = shape_width({{{4, 0.5}, {10, 0}}});
  EXPECT_LT(right, bare - 15);
  EXPECT_GT(right, bare - 45) << "on one side only";
}

TEST_F(MeshPictures, SheetOfNothingAndOfManyFrames) {
  const Body body = bodies::rectangle(1, 0.5, 3, 2);
  render::MeshPicture picture(*context_, coloured(body));
  EXPECT_NO_THROW(picture.sheet({}));
  const std::vector<render::MeshFrame> frames(200, body.frame());
  EXPECT_NO_THROW(picture.sheet(frames));
}

TEST_F(MeshPictures, EveryPictureSizeWorks) {
  const Body body = bodies::pulled_beam(5, 2, 3);
  for (const auto& [w, h] : {std::pair{1, 1}, {8, 8}, {60, 400}, {400, 60}, {33, 27}}) {
    const auto context = render::open_context(render::Backend::automatic, w, h);
    render::MeshLayout layout = coloured(body);
    layout.title = "Title";
    layout.arrow_scale = 10;
    render::MeshPicture picture(*context, layout);
    Image image;
    EXPECT_NO_THROW(picture.draw(body.frame(), image));
    EXPECT_NO_THROW(picture.sheet(std::vector<render::MeshFrame>(3, body.frame())));
    EXPECT_EQ(image.rgba.size(), static_cast<std::size_t>(4 * w * h));
  }
}

}  // namespace
