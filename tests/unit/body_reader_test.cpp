// [[body]] tables: every key missing, misspelt, of a wrong type or out of range; and what good ones make.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io_error_of.hpp"
#include "rheo/io/scene_file.hpp"

namespace rheo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// Every line can be replaced by its number.
std::vector<std::string> two_bodies() {
  return {
      "[[body]]",                                     // 1
      "name = \"soft\"",                              // 2
      "[body.mesh]",                                  // 3
      "shape = \"rectangle\"",                        // 4
      "size = [1.0, 1.0]",                            // 5
      "nodes = [3, 3]",                               // 6
      "[body.material]",                              // 7
      "lambda_ela = 7.0",                             // 8
      "mu_ela = 5.0",                                 // 9
      "lambda_vis = 4.0",                             // 10
      "mu_vis = 2.0",                                 // 11
      "density = 0.2",                                // 12
      "[[body.fix]]",                                 // 13
      "edges = \"bottom\"",                           // 14
      "[[body]]",                                     // 15
      "name = \"hard\"",                              // 16
      "position = [2.0, 0.5]",                        // 17
      "angle = 0.3",                                  // 18
      "[body.mesh]",                                  // 19
      "points = [[0, 0], [1, 0], [0, 1]]",            // 20
      "triangles = [[0, 1, 2]]",                      // 21
      "[body.edges]",                                 // 22
      "tip = [[1, 2]]",                               // 23
      "[body.material]",                              // 24
      "density = 1.0",                                // 25
      "[[body.material.maxwell]]",                    // 26
      "lambda_ela = 70.0",                            // 27
      "mu_ela = 50.0",                                // 28
      "lambda_vis = 4.0",                             // 29
      "mu_vis = 2.0",                                 // 30
      "[[body.move]]",                                // 31
      "nodes = [0]",                                  // 32
      "keys = [[0, 0, 0], [1, 0.1, 0]]",              // 33
      "[[body.traction]]",                            // 34
      "edges = \"tip\"",                              // 35
      "vector = [10.0, 0.0]",                         // 36
      "[[body.constraint]]",                          // 37
      "terms = [[1, \"y\", 1.0], [2, \"y\", -1.0]]",  // 38
      "[[body.probe]]",                               // 39
      "name = \"tip\"",                               // 40
      "edges = \"tip\"",                              // 41
      "[time]",                                       // 42
      "duration = 1.0",                               // 43
  };
}

Scene parse_lines(const std::vector<std::string>& lines) {
  return parse_scene(fmt::format("{}\n", fmt::join(lines, "\n")), "bad.toml", RHEO_TEST_DATA);
}

Scene parse_with(std::size_t line, const std::string& text) {
  auto lines = two_bodies();
  lines.at(line - 1) = text;
  return parse_lines(lines);
}

std::string refusal_with(std::size_t line, const std::string& text) {
  return error_of([&] { parse_with(line, text); });
}

TEST(BodyReader, BodiesFollowOneAnotherInOneMesh) {
  const Scene scene = parse_lines(two_bodies());
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[0].name, "soft");
  EXPECT_EQ(scene.bodies[0].first_node, 0);
  EXPECT_EQ(scene.bodies[0].node_count, 9);
  EXPECT_EQ(scene.bodies[0].triangle_count, 8);
  EXPECT_EQ(scene.bodies[1].name, "hard");
  EXPECT_EQ(scene.bodies[1].first_node, 9);
  EXPECT_EQ(scene.bodies[1].node_count, 3);
  EXPECT_EQ(scene.bodies[1].first_triangle, 8);
  EXPECT_EQ(scene.bodies[1].triangle_count, 1);
  EXPECT_EQ(scene.mesh.node_count(), 12);
  EXPECT_EQ(scene.mesh.triangles[8], (Triangle{9, 10, 11}));
  EXPECT_EQ(scene.mesh.edge_groups.at("boundary").size(), 8u + 3u);
}

TEST(BodyReader, NodeNumbersAreTheBodysOwn) {
  const Scene scene = parse_lines(two_bodies());
  EXPECT_THAT(scene.fixes.at(0).nodes, ElementsAre(0, 1, 2));
  EXPECT_THAT(scene.moves.at(0).nodes, ElementsAre(9));
  EXPECT_EQ(scene.constraints.at(0).terms[1].node, 11);
  EXPECT_THAT(scene.tractions.at(0).edges, ElementsAre(Edge{10, 11}));
  EXPECT_THAT(scene.probes.at(0).nodes, ElementsAre(10, 11));
  EXPECT_THAT(scene.mesh.edge_groups.at("hard.tip"), ElementsAre(Edge{10, 11}));
}

TEST(BodyReader, ABodyIsTurnedThenMoved) {
  const Scene scene = parse_lines(two_bodies());
  const double c = std::cos(0.3), s = std::sin(0.3);
  EXPECT_EQ(scene.mesh.points[9], (Vec2{2.0, 0.5}));
  EXPECT_EQ(scene.mesh.points[10], (Vec2{c + 2.0, s + 0.5}));
  EXPECT_EQ(scene.mesh.points[11], (Vec2{-s + 2.0, c + 0.5}));
  EXPECT_EQ(scene.mesh.points[8], (Vec2{1.0, 1.0})) << "no position, no angle: as it was";
}

TEST(BodyReader, VectorsKeepTheScenesAxes) {
  const Scene scene = parse_lines(two_bodies());
  EXPECT_EQ(scene.tractions.at(0).keys.at(0).p, (Vec2{10.0, 0.0}));
  EXPECT_EQ(scene.moves.at(0).keys.at(1).u, (Vec2{0.1, 0.0}));
}

TEST(BodyReader, MaterialsOfBodiesAreRegionsUnlessEqual) {
  const Scene scene = parse_lines(two_bodies());
  ASSERT_EQ(scene.regions.size(), 1u);
  EXPECT_EQ(scene.regions[0].name, "hard");
  EXPECT_EQ(scene.regions[0].material.density, 1.0);
  EXPECT_THAT(scene.region_of_triangle, ElementsAre(0, 0, 0, 0, 0, 0, 0, 0, 1));

  auto lines = two_bodies();
  lines[24] = "density = 0.2";
  lines[26] = "lambda_ela = 7.0";
  lines[27] = "mu_ela = 5.0";
  const Scene alike = parse_lines(lines);
  EXPECT_TRUE(alike.regions.empty()) << "one material, however it is written";
  EXPECT_TRUE(alike.region_of_triangle.empty());
}

TEST(BodyReader, NamesHaveADefault) {
  auto lines = two_bodies();
  lines[1] = lines[15] = "";
  const Scene scene = parse_lines(lines);
  EXPECT_EQ(scene.bodies[0].name, "body 1");
  EXPECT_EQ(scene.bodies[1].name, "body 2");
}

TEST(BodyReader, ABodyHasRegionsInItsOwnCoordinates) {
  auto lines = two_bodies();
  lines.insert(lines.begin() + 12,
               {"[[body.region]]", "name = \"left\"", "box = [0, 0, 0.5, 1]", "[body.region.material]",
                "lambda_ela = 1.0", "mu_ela = 1.0", "lambda_vis = 1.0", "mu_vis = 1.0", "density = 0.5"});
  lines.insert(lines.begin() + 1, "position = [10.0, 0.0]");
  const Scene scene = parse_lines(lines);
  ASSERT_EQ(scene.regions.size(), 2u);
  EXPECT_EQ(scene.regions[0].name, "soft.left");
  EXPECT_EQ(std::count(scene.region_of_triangle.begin(), scene.region_of_triangle.end(), 1), 4);
}

struct BadLine {
  std::size_t line;
  const char* text;
  const char* begins;
  const char* says;
};

class BadBody : public ::testing::TestWithParam<BadLine> {};

TEST_P(BadBody, IsNamedWithWhatIsAllowed) {
  const BadLine& bad = GetParam();
  EXPECT_THAT(refusal_with(bad.line, bad.text), AllOf(StartsWith(bad.begins), HasSubstr(bad.says)))
      << bad.text;
}

INSTANTIATE_TEST_SUITE_P(
    BodyReader, BadBody,
    ::testing::Values(
        BadLine{2, "name = 7", "bad.toml:2: [[body]] name = 7", "a text in quotes"},
        BadLine{2, "name = \"\"", "bad.toml:2: [[body]] name = \"\"", "a name of its own"},
        BadLine{2, "name = \"hard\"", "bad.toml:16: [[body]] name = \"hard\"", "a name of its own"},
        BadLine{2, "nqme = \"soft\"", "bad.toml:2: [[body]] nqme", "did you mean name?"},
        BadLine{17, "position = 2", "bad.toml:17: [[body]] position = 2", "[x, y], each a finite number (m)"},
        BadLine{17, "position = [nan, 0]", "bad.toml:17: [[body]] position", "finite number (m)"},
        BadLine{17, "position = [1e15, 0]", "bad.toml:17: [[body]] position",
                "a million times the body's size"},
        BadLine{17, "psition = [0, 0]", "bad.toml:17: [[body]] psition", "did you mean position?"},
        BadLine{18, "angle = \"up\"", "bad.toml:18: [[body]] angle = \"up\"", "rad, counter-clockwise"},
        BadLine{18, "angle = inf", "bad.toml:18: [[body]] angle = inf", "rad, counter-clockwise"},
        BadLine{18, "angle = 5000", "bad.toml:18: [[body]] angle = 5000", "rad, counter-clockwise"},
        BadLine{3, "[body.mqesh]", "bad.toml:3: [[body]] mqesh", "did you mean mesh?"},
        BadLine{4, "", "bad.toml:3: [body.mesh]", "shape"},
        BadLine{5, "size = [0, 1]", "bad.toml:5: [body.mesh] size", "> 0"},
        BadLine{8, "", "bad.toml:7: [body.material]", "lambda_ela is missing"},
        BadLine{9, "mu_ela = -1", "bad.toml:9: [body.material] mu_ela = -1", ">= 0"},
        BadLine{12, "mass = \"consistent\"\ndensity = 0.2", "bad.toml:25: [body.material]", "mass"},
        BadLine{14, "edges = \"bttom\"", "bad.toml:14: [[body.fix]] edges = \"bttom\"", "bottom"},
        BadLine{21, "triangles = [[0, 1, 3]]", "bad.toml:21: [body.mesh] triangles", "2"},
        BadLine{23, "tip = [[1, 3]]", "bad.toml:23: [body.edges] tip", "2"},
        BadLine{28, "mu_ela = \"x\"", "bad.toml:28: [[body.material.maxwell]] mu_ela", "Pa"},
        BadLine{32, "nodes = [3]", "bad.toml:32: [[body.move]] nodes", "2"},
        BadLine{35, "edges = \"right\"", "bad.toml:35: [[body.traction]] edges = \"right\"", "tip"},
        BadLine{38, "terms = [[7, \"y\", 1.0]]", "bad.toml:38: [[body.constraint]] terms", "2"},
        BadLine{41, "edges = 3", "bad.toml:41: [[body.probe]] edges = 3", ""},
        BadLine{20, "points = [[0, 0], [1, 0], [0, 1]]\nthickness = [2.0, 2.0]",
                "bad.toml:21: [body.mesh] thickness", "3 nodes"},
        BadLine{20, "points = [[0, 0], [1, 0], [0, 1]]\nthickness = [2.0, 2.0, 0.0]",
                "bad.toml:21: [body.mesh] thickness[2] = 0", "> 0"},
        BadLine{20, "points = [[0, 0], [1, 0], [0, 1]]\nthickness = [2.0, 2.0, 1.0]",
                "bad.toml:", "differ in thickness"},
        BadLine{42, "[mesh]\nshape = \"disk\"\n[time]", "bad.toml:42: mesh beside [[body]]", "body.mesh"},
        BadLine{42, "[[fix]]\nnodes = [0]\n[time]", "bad.toml:42: fix beside [[body]]", "body.fix"},
        BadLine{13, "[[body.probe]]\nname = \"tip\"\nedges = \"top\"\n[[body.fix]]", "bad.toml:", "tip"}));

TEST(BodyReader, WhatABodyNeedsIsNamed) {
  const auto without = [](std::size_t first, std::size_t last) {
    auto lines = two_bodies();
    for (std::size_t i = first; i <= last; ++i) lines[i - 1] = "";
    return error_of([&] { parse_lines(lines); });
  };
  EXPECT_THAT(without(3, 6), StartsWith("bad.toml:1: [body.mesh] is missing; needed: "));
  EXPECT_THAT(without(24, 30), StartsWith("bad.toml:15: [body.material] is missing; needed: "));
  EXPECT_THAT(without(42, 43), StartsWith("bad.toml:1: [time] is missing; needed: "));
}

TEST(BodyReader, OneTableInsteadOfAListIsRefused) {
  EXPECT_THAT(error_of([] { parse_scene("[body]\nname = \"a\"\n[time]\nduration = 1\n", "bad.toml", {}); }),
              AllOf(StartsWith("bad.toml:"), HasSubstr("[[body]]")));
  EXPECT_THAT(error_of([] { parse_scene("body = []\n[time]\nduration = 1\n", "bad.toml", {}); }),
              HasSubstr("[[body]]"));
}

}  // namespace
}  // namespace rheo
