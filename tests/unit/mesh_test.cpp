// Mesh::prepare accepts what makes a body and names what does not.
#include "rheo/mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io_error_of.hpp"
#include "rheo/shapes.hpp"

namespace rheo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// Two triangles on a unit square, scaled: (0, 1, 2) and (0, 2, 3).
Mesh square(double scale = 1.0) {
  Mesh mesh;
  mesh.points = {{0, 0}, {scale, 0}, {scale, scale}, {0, scale}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

std::string refusal(Mesh mesh) {
  return error_of([&] { prepare(mesh); });
}

TEST(Mesh, PiecesShareNoNode) {
  Mesh mesh = square();
  EXPECT_EQ(piece_count(mesh), 1);
  for (const double shift : {2.0, 4.0}) {
    const int first = mesh.node_count();
    for (int i = 0; i < 4; ++i) mesh.points.push_back({mesh.points[i].x + shift, mesh.points[i].y});
    mesh.triangles.push_back({first + 3, first + 2, first});
    mesh.triangles.push_back({first + 2, first + 1, first});
  }
  EXPECT_EQ(piece_count(mesh), 3);
  EXPECT_EQ(pieces_of(mesh), (std::vector<int>{0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8}));
  EXPECT_EQ(piece_count(rectangle({1, 1}, 30, 40)), 1);
}

TEST(Mesh, ClockwiseTrianglesAreTurnedRoundAndCounted) {
  Mesh mesh = square();
  mesh.triangles = {{0, 2, 1}, {0, 2, 3}};
  EXPECT_EQ(prepare(mesh), 1);
  for (int i = 0; i < mesh.triangle_count(); ++i) EXPECT_DOUBLE_EQ(signed_area(mesh, i), 0.5);
  EXPECT_EQ(prepare(mesh), 0) << "preparing twice changes nothing";
}

TEST(Mesh, BoundaryHasTheInteriorOnItsLeft) {
  Mesh mesh = square();
  mesh.triangles = {{0, 2, 1}, {3, 2, 0}};
  prepare(mesh);
  const auto& boundary = mesh.edge_groups.at("boundary");
  ASSERT_EQ(boundary.size(), 4u);
  for (const Edge& edge : boundary) {
    const Vec2 a = mesh.points[static_cast<std::size_t>(edge[0])];
    const Vec2 b = mesh.points[static_cast<std::size_t>(edge[1])];
    // The middle of the square lies to the left of a -> b.
    EXPECT_GT((b.x - a.x) * (0.5 - a.y) - (b.y - a.y) * (0.5 - a.x), 0.0);
  }
}

TEST(Mesh, EdgesOfOtherGroupsAreTurnedToo) {
  Mesh mesh = square();
  mesh.edge_groups["side"] = {{2, 1}, {3, 2}};
  mesh.edge_groups["inside"] = {{2, 0}};
  prepare(mesh);
  EXPECT_THAT(mesh.edge_groups["side"], ElementsAre(Edge{1, 2}, Edge{2, 3}));
  EXPECT_THAT(mesh.edge_groups["inside"], ElementsAre(Edge{2, 0}));
}

TEST(Mesh, ScaleDoesNotMatter) {
  for (const double scale : {1e-8, 1.0, 1e8}) {
    Mesh mesh = square(scale);
    EXPECT_NO_THROW(prepare(mesh));
    Mesh thin = square(scale);
    thin.points[2] = {scale, 1e-13 * scale};
    thin.points[3] = {0, scale};
    EXPECT_THAT(refusal(thin), HasSubstr("triangle 0 (0, 1, 2): it has no area"));
  }
}

TEST(Mesh, RefusesSizesThatMakeNoBody) {
  EXPECT_THAT(refusal(Mesh{}), HasSubstr("no triangles"));
  for (const double thickness : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    Mesh mesh = square();
    mesh.thickness = thickness;
    EXPECT_THAT(refusal(mesh), StartsWith("thickness = "));
  }
}

TEST(Mesh, RefusesNodeNumbersOutOfRange) {
  Mesh mesh = square();
  mesh.triangles[1] = {0, 2, 7};
  EXPECT_THAT(refusal(mesh),
              AllOf(HasSubstr("triangle 1 (0, 2, 7)"), HasSubstr("no node 7"), HasSubstr("0 to 3")));
  mesh.triangles[1] = {0, 2, -1};
  EXPECT_THAT(refusal(mesh), HasSubstr("no node -1"));
}

TEST(Mesh, RefusesTrianglesWithARepeatedNodeOrNoArea) {
  Mesh mesh = square();
  mesh.triangles[1] = {3, 0, 3};
  EXPECT_THAT(refusal(mesh), AllOf(HasSubstr("triangle 1 (3, 0, 3)"), HasSubstr("node 3 twice")));
  mesh = square();
  mesh.points[2] = {2.0, 0.0};
  EXPECT_THAT(refusal(mesh),
              AllOf(HasSubstr("triangle 0 (0, 1, 2)"), HasSubstr("no area"), HasSubstr("side of 2 m")));
}

TEST(Mesh, RefusesTheSameTriangleTwice) {
  Mesh mesh = square();
  mesh.triangles.push_back({3, 0, 2});
  EXPECT_THAT(refusal(mesh), AllOf(HasSubstr("triangle 2 (3, 0, 2)"), HasSubstr("the same as triangle 1")));
}

TEST(Mesh, RefusesThreeTrianglesOnAnEdge) {
  Mesh mesh = square();
  mesh.points.push_back({2.0, 3.0});
  mesh.triangles.push_back({0, 2, 4});
  EXPECT_THAT(refusal(mesh),
              AllOf(HasSubstr("edge (0, 2) belongs to 3 triangles"), HasSubstr("at most two")));
}

TEST(Mesh, RefusesTwoTrianglesOnOneSideOfAnEdge) {
  Mesh mesh;
  mesh.points = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  EXPECT_THAT(refusal(mesh), AllOf(HasSubstr("edge (0, 1)"), HasSubstr("triangle 0"), HasSubstr("triangle 1"),
                                   HasSubstr("same side")));
}

TEST(Mesh, RefusesNodesWithoutATriangleAndNonFiniteCoordinates) {
  Mesh mesh = square();
  mesh.points.push_back({5.0, 6.0});
  EXPECT_THAT(refusal(mesh), HasSubstr("node 4 at (5, 6) belongs to no triangle"));
  mesh = square();
  mesh.points[3].y = std::nan("");
  EXPECT_THAT(refusal(mesh), HasSubstr("node 3 at (0, nan)"));
  mesh.points[3].y = 1e200;  // its square is not finite
  EXPECT_THAT(refusal(mesh), HasSubstr("node 3 at (0, 1e+200): at most 1e+30 m"));
  EXPECT_THAT(refusal(square(1e-31)), HasSubstr("triangle 0 (0, 1, 2): its longest side has"));
}

TEST(Mesh, RefusesGroupEdgesThatAreNoEdges) {
  for (const Edge edge : {Edge{1, 3}, Edge{0, 0}, Edge{2, 9}, Edge{-1, 2}}) {
    Mesh mesh = square();
    mesh.edge_groups["grip"] = {{0, 1}, edge};
    EXPECT_THAT(refusal(mesh),
                AllOf(HasSubstr("of group \"grip\" is no edge"), HasSubstr(std::to_string(edge[1]))));
  }
  Mesh mesh = square();
  mesh.edge_groups["grip"] = {{0, 1}, {1, 0}};
  EXPECT_THAT(refusal(mesh), HasSubstr("edge (0, 1) is twice in group \"grip\""));
  mesh = square();
  mesh.edge_groups["boundary"] = {{0, 1}};
  EXPECT_THAT(refusal(mesh), HasSubstr("group \"boundary\""));
}

TEST(Mesh, MessagesBeginWithTheGivenPlace) {
  Mesh mesh;
  EXPECT_THAT(error_of([&] { prepare(mesh, "liver.msh"); }), StartsWith("liver.msh: "));
}

TEST(Mesh, NodesOfEdgesAreUniqueAndSorted) {
  EXPECT_THAT(nodes_of({{4, 9}, {9, 2}, {2, 4}}), ElementsAre(2, 4, 9));
  EXPECT_TRUE(nodes_of({}).empty());
}

TEST(Mesh, BoundaryIsClosed) {
  // Each boundary node of a disk with a hole is entered once and left once.
  Mesh mesh = disk(1.0, 4);
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 6);
  mesh.points.erase(mesh.points.begin());
  for (Triangle& t : mesh.triangles) {
    for (int& node : t) --node;
  }
  mesh.edge_groups.clear();
  prepare(mesh);
  std::vector<int> balance(mesh.points.size(), 0);
  for (const Edge& edge : mesh.edge_groups.at("boundary")) {
    ++balance[static_cast<std::size_t>(edge[0])];
    --balance[static_cast<std::size_t>(edge[1])];
  }
  EXPECT_THAT(balance, ::testing::Each(0));
  EXPECT_EQ(mesh.edge_groups.at("boundary").size(), 24u + 6u);
}

}  // namespace
}  // namespace rheo
