// Rectangles and disks: numbering, areas, groups, refusals before memory is asked for.
#include "rheo/shapes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "io_error_of.hpp"

namespace rheo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;

double area_of(const Mesh& mesh) {
  double area = 0.0;
  for (int i = 0; i < mesh.triangle_count(); ++i) area += signed_area(mesh, i);
  return area;
}

TEST(Rectangle, IsThePapersBeam) {
  const Mesh mesh = rectangle({1.0, 0.25}, 5, 2);
  ASSERT_EQ(mesh.node_count(), 10);
  EXPECT_EQ(mesh.points[4], (Vec2{1.0, 0.0}));
  EXPECT_EQ(mesh.points[5], (Vec2{0.0, 0.25}));
  EXPECT_EQ(mesh.points[9], (Vec2{1.0, 0.25}));
  EXPECT_THAT(mesh.triangles,
              ElementsAre(Triangle{0, 1, 5}, Triangle{6, 5, 1}, Triangle{1, 2, 6}, Triangle{7, 6, 2},
                          Triangle{2, 3, 7}, Triangle{8, 7, 3}, Triangle{3, 4, 8}, Triangle{9, 8, 4}));
  EXPECT_THAT(mesh.edge_groups.at("left"), ElementsAre(Edge{5, 0}));
  EXPECT_THAT(mesh.edge_groups.at("right"), ElementsAre(Edge{4, 9}));
  EXPECT_EQ(mesh.edge_groups.at("bottom").size(), 4u);
  EXPECT_EQ(mesh.edge_groups.at("top").size(), 4u);
  EXPECT_EQ(mesh.edge_groups.at("boundary").size(), 10u);
}

TEST(Rectangle, DiagonalsAreAsDocumented) {
  EXPECT_THAT(rectangle({1, 1}, 2, 2, Diagonal::falling).triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{3, 2, 1}));
  EXPECT_THAT(rectangle({1, 1}, 2, 2, Diagonal::rising).triangles,
              ElementsAre(Triangle{0, 1, 3}, Triangle{0, 3, 2}));
  EXPECT_THAT(rectangle({2, 1}, 3, 2, Diagonal::alternating).triangles,
              ElementsAre(Triangle{0, 1, 3}, Triangle{4, 3, 1}, Triangle{1, 2, 5}, Triangle{1, 5, 4}));
}

TEST(Rectangle, FillsItsAreaAtAnyScale) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Mesh mesh = rectangle({3.0 * scale, 2.0 * scale}, 7, 4, Diagonal::alternating);
    // 36 triangles are added up: their rounding errors stay far below 1e-14.
    EXPECT_NEAR(area_of(mesh) / (6.0 * scale * scale), 1.0, 1e-14);
    EXPECT_EQ(mesh.points.back(), (Vec2{3.0 * scale, 2.0 * scale}));
  }
}

TEST(Disk, IsNumberedRingByRing) {
  const Mesh mesh = disk(2.0, 3);
  ASSERT_EQ(mesh.node_count(), 1 + 6 + 12 + 18);
  ASSERT_EQ(mesh.triangle_count(), 6 * 9);
  EXPECT_EQ(mesh.points[0], (Vec2{0.0, 0.0}));
  for (int k = 1; k <= 3; ++k) {
    const int first = 1 + 3 * k * (k - 1);
    for (int i = 0; i < 6 * k; ++i) {
      const Vec2 p = mesh.points[static_cast<std::size_t>(first + i)];
      EXPECT_NEAR(std::hypot(p.x, p.y), 2.0 * k / 3.0, 1e-15);
      EXPECT_NEAR(
          std::remainder(std::atan2(p.y, p.x) - std::numbers::pi * i / (3.0 * k), 2.0 * std::numbers::pi),
          0.0, 1e-15);
    }
  }
  // The area of its outline, a regular polygon of 18 corners.
  EXPECT_NEAR(area_of(mesh), 0.5 * 18 * 4.0 * std::sin(2.0 * std::numbers::pi / 18), 1e-13);
}

TEST(Disk, RimIsTheBoundary) {
  const Mesh mesh = disk(1.0, 5);
  EXPECT_EQ(mesh.edge_groups.at("rim").size(), 30u);
  EXPECT_THAT(mesh.edge_groups.at("boundary"),
              ::testing::UnorderedElementsAreArray(mesh.edge_groups.at("rim")));
  EXPECT_THAT(mesh.edge_groups.at("rim").front(), ElementsAre(61, 62));
  EXPECT_THAT(mesh.edge_groups.at("rim").back(), ElementsAre(90, 61));
}

TEST(Shapes, RefuseSizesThatMakeNoMesh) {
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(error_of([&] { rectangle({bad, 1.0}, 2, 2); }), HasSubstr("width"));
    EXPECT_THAT(error_of([&] { rectangle({1.0, bad}, 2, 2); }), HasSubstr("height"));
    EXPECT_THAT(error_of([&] { disk(bad, 2); }), HasSubstr("radius"));
  }
  EXPECT_THAT(error_of([] { rectangle({1, 1}, 1, 5); }), HasSubstr("[1, 5]"));
  EXPECT_THAT(error_of([] { rectangle({1, 1}, 5, -3); }), HasSubstr("at least 2"));
  EXPECT_THAT(error_of([] { disk(1.0, 0); }), HasSubstr("at least 1"));
}

TEST(Shapes, RefuseHugeMeshesBeforeTheMemoryIsAskedFor) {
  constexpr int most = std::numeric_limits<int>::max();
  EXPECT_THAT(error_of([] {
                rectangle({1, 1}, 1'000'000, 1'000'000);
              }),
              AllOf(HasSubstr("[1000000, 1000000]"), HasSubstr("1e+12 nodes"), HasSubstr("1.4e+05 GB"),
                    HasSubstr("--memory-limit")));
  EXPECT_THAT(error_of([] {
                rectangle({1, 1}, 100, 100, Diagonal::falling, 1e6);
              }),
              HasSubstr("1e+04 nodes need about 1.4 MB of memory, the limit is 1 MB"));
  EXPECT_THAT(error_of([] {
                rectangle({1, 1}, 20'000, 20'000, Diagonal::falling, 1e15);
              }),
              HasSubstr("150 million"));
  EXPECT_THAT(error_of([] { rectangle({1, 1}, most, most); }), HasSubstr("GB"));
  EXPECT_THAT(error_of([] { disk(1.0, 100'000); }), AllOf(HasSubstr("100000"), HasSubstr("3e+10 nodes")));
  EXPECT_THAT(error_of([] { disk(1.0, most); }), HasSubstr("GB"));
}

}  // namespace
}  // namespace rheo
