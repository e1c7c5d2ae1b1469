// The mesh itself: camera, colour, lines, and bodies of every kind.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh_pictures.hpp"

namespace mesh_pictures {
namespace {

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

TEST_F(MeshPictures, ABodyThinnerThanItsOutlineStillShowsItsColour) {
  Body body = bodies::rectangle(1, 1e-4, 41, 2);
  render::MeshLayout layout = coloured(body);
  layout.range = {0, 1};
  for (std::size_t i = 0; i < body.nodes(); ++i) body.scalar[i] = body.rest[2 * i];
  const Image image = draw(layout, body.frame());
  const Box box = support::find(image, [](int x, int y, const Pixel& p) {
    return y > heading && x < width - 70 && support::distance(p, support::paper) > 20;
  });
  EXPECT_LE(box.height(), 5);
  for (const double t : {0.1, 0.5, 0.9}) {
    const int x = box.x0 + static_cast<int>(std::lround(t * (box.width() - 1)));
    int nearest = 765;  // one of the line's rows has its full strength
    for (int y = box.y0; y <= box.y1; ++y)
      nearest = std::min(nearest, support::distance(at(image, x, y), map_colour(t)));
    EXPECT_LT(nearest, 25) << t;
  }
  const Image bare = draw(body.layout(), body.frame());
  const Pixel ink = at(bare, width / 2, (drawn(bare).y0 + drawn(bare).y1) / 2);
  EXPECT_LT(ink[0], 150);
  EXPECT_LT(std::abs(ink[0] - ink[2]), 20) << "without a scalar: ink";
}

TEST_F(MeshPictures, PositionsThatAreNotFiniteDropTheirTrianglesOnly) {
  Body body = bodies::rectangle(2, 1, 3, 2);
  const render::MeshLayout layout = coloured(body);
  const Image whole = draw(layout, body.frame());
  body.positions[4] = nan;  // the lower right node
  for (const int node : {0, 1, 2}) body.hold(node);
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
  for (std::size_t i = 0; i < body.nodes(); ++i) body.hold(static_cast<int>(i));
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
}  // namespace mesh_pictures
