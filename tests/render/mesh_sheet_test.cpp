// Sheets of successive shapes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh_pictures.hpp"

namespace mesh_pictures {
namespace {

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

TEST_F(MeshPictures, SheetShowsCaptionsWhereAllHaveRoom) {
  const Body body = bodies::rectangle(1, 0.5, 3, 2);
  render::MeshPicture picture(*context_, coloured(body));
  const auto texts_of = [&](std::size_t count) {
    std::vector<render::MeshFrame> frames(count, body.frame());
    frames[0].caption = "(a) natural";
    frames[1].caption = "(b) pushed";
    picture.sheet(frames);
    std::vector<std::string> texts;
    for (const render::TextBox& text : picture.texts()) texts.push_back(text.text);
    return texts;
  };
  EXPECT_THAT(texts_of(4), testing::IsSupersetOf(
                               {testing::EndsWith("   (a) natural"), testing::EndsWith("   (b) pushed")}));
  const std::string longest(200, 'x');
  {
    std::vector<render::MeshFrame> frames(4, body.frame());
    frames[0].caption = longest;
    frames[1].caption = "(b) pushed";
    picture.sheet(frames);
    std::vector<std::string> texts;
    for (const render::TextBox& text : picture.texts()) texts.push_back(text.text);
    EXPECT_THAT(texts, testing::AllOf(testing::Contains(testing::HasSubstr("   xxxxxx")),
                                      testing::Contains(testing::EndsWith("   (b) pushed"))))
        << "one that is too long is cut and hides no other";
  }
  EXPECT_THAT(texts_of(60), testing::Not(testing::Contains(testing::HasSubstr("pushed"))));
}

TEST_F(MeshPictures, SheetOfNothingAndOfManyFrames) {
  const Body body = bodies::rectangle(1, 0.5, 3, 2);
  render::MeshPicture picture(*context_, coloured(body));
  EXPECT_NO_THROW(picture.sheet({}));
  const std::vector<render::MeshFrame> frames(200, body.frame());
  EXPECT_NO_THROW(picture.sheet(frames));
}

}  // namespace
}  // namespace mesh_pictures
