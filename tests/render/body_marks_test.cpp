// What tells bodies and materials apart: lines where materials meet, names beside bodies.
#include <gtest/gtest.h>

#include "body_labels.hpp"
#include "mesh_pictures.hpp"

namespace mesh_pictures {
namespace {

using render::Rect;

bool meet(const Rect& a, const Rect& b) {
  return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

TEST(LabelBoxes, StandBelowTheirBodies) {
  const std::vector<Rect> bodies{{10, 10, 60, 60}, {80, 10, 130, 60}};
  const std::vector<render::Point> sizes{{30, 10}, {40, 10}};
  const auto boxes = render::label_boxes(bodies, sizes, 4, {0, 0, 200, 100});
  ASSERT_EQ(boxes.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_FLOAT_EQ(boxes[k].y0, 64);
    EXPECT_FLOAT_EQ((boxes[k].x0 + boxes[k].x1) / 2, (bodies[k].x0 + bodies[k].x1) / 2);
  }
}

TEST(LabelBoxes, MeetNeitherBodiesNorOneAnotherNorLeaveThePicture) {
  // One above the other, with too little room between them and at the left.
  const std::vector<Rect> bodies{{5, 20, 60, 50}, {5, 52, 60, 82}, {62, 20, 120, 82}};
  const std::vector<render::Point> sizes{{50, 10}, {50, 10}, {50, 10}};
  const Rect area{0, 0, 200, 100};
  const auto boxes = render::label_boxes(bodies, sizes, 2, area);
  int placed = 0;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    if (!(boxes[k].width() > 0)) continue;
    ++placed;
    EXPECT_GE(boxes[k].x0, area.x0);
    EXPECT_LE(boxes[k].y1, area.y1);
    for (const Rect& body : bodies) EXPECT_FALSE(meet(boxes[k], body)) << k;
    for (std::size_t j = 0; j < k; ++j) EXPECT_FALSE(meet(boxes[k], boxes[j])) << k << " " << j;
  }
  EXPECT_EQ(placed, 3);
}

TEST(LabelBoxes, ANameWithoutAPlaceIsLeftOut) {
  const std::vector<Rect> bodies{{0, 0, 100, 100}};
  const std::vector<render::Point> sizes{{30, 10}};
  EXPECT_EQ(render::label_boxes(bodies, sizes, 2, {0, 0, 100, 100})[0].width(), 0);
}

// Small bodies in a row, with wide names and much room for arrows about them.
TEST(LabelBoxes, ANameThatWouldStandBesideAnotherBodyIsLeftOut) {
  const std::vector<Rect> bodies{{100, 50, 120, 70}, {125, 50, 145, 70}, {150, 50, 170, 70}};
  const std::vector<render::Point> sizes{{70, 10}, {40, 10}, {60, 10}};
  const auto boxes = render::label_boxes(bodies, sizes, 35, {0, 0, 250, 120});
  EXPECT_FLOAT_EQ((boxes[0].x0 + boxes[0].x1) / 2, 110);
  EXPECT_GT(boxes[1].width(), 0) << "above, as below is taken";
  EXPECT_EQ(boxes[2].width(), 0) << "at " << boxes[2].x0 << ", " << boxes[2].y0;
}

TEST_F(MeshPictures, NamesAreWrittenBelowTheBody) {
  Body body = bodies::rectangle(2, 1, 5, 3);
  const std::vector<render::BodyLabel> labels{{"block", 0, static_cast<int>(body.nodes())}};
  render::MeshLayout layout = body.layout();
  layout.labels = labels;
  render::MeshPicture picture(*context_, layout);
  Image image;
  picture.draw(body.frame(), image);
  const auto& texts = picture.texts();
  const auto name = std::find_if(texts.begin(), texts.end(), [](const auto& t) { return t.text == "block"; });
  ASSERT_NE(name, texts.end());
  for (int y = static_cast<int>(name->y0); y < static_cast<int>(name->y1); ++y)
    for (int x = static_cast<int>(name->x0); x < static_cast<int>(name->x1); ++x)
      EXPECT_GT(support::distance(at(image, x, y), {198, 210, 226}), 10) << "the body's fill in its name";
  const Image sheet = picture.sheet(std::vector{body.frame(), body.frame(1)});
  EXPECT_EQ(std::count_if(picture.texts().begin(), picture.texts().end(),
                          [](const auto& t) { return t.text == "block"; }),
            2)
      << "on every panel of the sheet";
}

// The line between two materials is darker than the mesh's lines beside it, and has a light rim.
TEST_F(MeshPictures, ALineStandsWhereMaterialsMeet) {
  Body body = bodies::rectangle(2, 1, 9, 5);
  const Image without = draw(body.layout(), body.frame());
  std::vector<int> interfaces;
  for (int i = 0; i < 8; ++i) interfaces.insert(interfaces.end(), {2 * 9 + i, 2 * 9 + i + 1});
  render::MeshLayout layout = body.layout();
  layout.interfaces = interfaces;
  const Image with = draw(layout, body.frame());
  const Box line = support::find_difference(without, with);
  const Box box = drawn(without);
  EXPECT_NEAR(line.width(), box.width(), 8);
  EXPECT_LE(line.height(), 8);
  EXPECT_NEAR((line.y0 + line.y1) / 2.0, (box.y0 + box.y1) / 2.0, 2.0);
  // Between two mesh lines: ink, and paper beside it.
  const int x = box.x0 + box.width() * 3 / 16;
  int darkest = 255, lightest = 0;
  for (int y = line.y0; y <= line.y1; ++y) {
    darkest = std::min(darkest, at(with, x, y)[1]);
    lightest = std::max(lightest, at(with, x, y)[1]);
  }
  EXPECT_LT(darkest, 170);
  EXPECT_GT(lightest, 225);
}

}  // namespace
}  // namespace mesh_pictures
