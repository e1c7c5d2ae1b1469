// validate(Scene) for scenes made in C++ or changed by a command line.
#include "rheo/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "io_error_of.hpp"
#include "rheo/shapes.hpp"

namespace rheo {
namespace {

using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Scene good() {
  Scene scene;
  scene.mesh = rectangle({1.0, 0.25}, 5, 2);
  scene.material = {7.0, 5.0, 4.0, 2.0, 0.2, Mass::lumped};
  scene.fixes = {{{0, 5}, Axis::both, {}, "fix:"}};
  scene.moves = {{{4, 9}, Axis::x, {}, {{0.0, {}, {}}, {1.0, {0.5, 0.0}, {}}}, Profile::smooth, "move:"}};
  scene.constraints = {{{{9, Axis::x, 1.0}, {4, Axis::x, -1.0}}, 0.0, "constraint:"}};
  scene.tractions = {{{{4, 9}}, {{0.0, {10.0, 0.0}}}, {}, "traction:"}};
  scene.probes = {{"grip", {4, 9}, {}, "probe:"}};
  scene.time.duration = 5.0;
  return scene;
}

TEST(Scene, GoodScenesPass) {
  EXPECT_NO_THROW(validate(good()));
}

TEST(Scene, EveryRefusalNamesItsPlaceAndValue) {
  struct Case {
    const char* begin;
    const char* part;
    std::function<void(Scene&)> spoil;
  };
  const double nan = std::nan("");
  const std::vector<Case> cases = {
      {"[mesh]", "no triangles", [](Scene& s) { s.mesh = {}; }},
      {"[mesh]", "triangle 0: node 55: the nodes are numbered 0 to 9",
       [](Scene& s) { s.mesh.triangles[0][0] = 55; }},
      {"[mesh]", "triangle 0: no positive area", [](Scene& s) { s.mesh.points[0].y = 7.0; }},
      {"[mesh]", "node 10: in no triangle",
       [](Scene& s) {
         s.mesh.points.push_back({3.0, 3.0});
       }},
      {"[mesh]", "boundary", [](Scene& s) { s.mesh.edge_groups.clear(); }},
      {"traction:", "edge (9, 0): no triangle has it",
       [](Scene& s) {
         s.tractions[0].edges = {{4, 9}, {9, 0}};
       }},
      {"[material]", "density = 0", [](Scene& s) { s.material.density = 0.0; }},
      {"[body_force]", "nan", [&](Scene& s) { s.body_acceleration.y = nan; }},
      {"fix:", "no nodes", [](Scene& s) { s.fixes[0].nodes.clear(); }},
      {"fix:", "node 10: the nodes are numbered 0 to 9", [](Scene& s) { s.fixes[0].nodes[0] = 10; }},
      {"fix:", "node 5 twice",
       [](Scene& s) {
         s.fixes[0].nodes = {5, 0, 5};
       }},
      {"fix:", "from = -1", [](Scene& s) { s.fixes[0].window.from = -1.0; }},
      {"fix:", "until = 1: a time after from = 1",
       [](Scene& s) {
         s.fixes[0].window = {1.0, 1.0};
       }},
      {"move:", "until = nan", [&](Scene& s) { s.moves[0].window.until = nan; }},
      {"move:", "no keys", [](Scene& s) { s.moves[0].keys.clear(); }},
      {"move:", "key 1 at t = 0 is not after", [](Scene& s) { s.moves[0].keys[1].t = 0.0; }},
      {"move:", "key 1 at t = 1: finite", [](Scene& s) { s.moves[0].keys[1].v.x = forever; }},
      {"constraint:", "no terms", [](Scene& s) { s.constraints[0].terms.clear(); }},
      {"constraint:", "node -1", [](Scene& s) { s.constraints[0].terms[0].node = -1; }},
      {"constraint:", "\"x\" or \"y\"", [](Scene& s) { s.constraints[0].terms[0].axis = Axis::both; }},
      {"constraint:", "coefficient 0", [](Scene& s) { s.constraints[0].terms[0].coefficient = 0.0; }},
      {"constraint:", "node 9 twice along x", [](Scene& s) { s.constraints[0].terms[1].node = 9; }},
      {"constraint:", "value = inf", [](Scene& s) { s.constraints[0].value = forever; }},
      {"traction:", "no edges", [](Scene& s) { s.tractions[0].edges.clear(); }},
      {"traction:", "node 12",
       [](Scene& s) {
         s.tractions[0].edges = {{4, 12}};
       }},
      {"traction:", "edge (4, 4)",
       [](Scene& s) {
         s.tractions[0].edges = {{4, 4}};
       }},
      {"traction:", "finite", [&](Scene& s) { s.tractions[0].keys[0].p.x = nan; }},
      {"traction:", "from = inf", [](Scene& s) { s.tractions[0].window.from = forever; }},
      {"probe:", "letters", [](Scene& s) { s.probes[0].name = "a,b"; }},
      {"probe:", "letters", [](Scene& s) { s.probes[0].name = ""; }},
      {"probe:", "taken", [](Scene& s) { s.probes.push_back(s.probes[0]); }},
      {"probe:", "node 10", [](Scene& s) { s.probes[0].nodes = {10}; }},
      {"[time] duration = 0:", "> 0 (s)", [](Scene& s) { s.time.duration = 0.0; }},
      {"[time] duration = inf:", "> 0 (s)", [](Scene& s) { s.time.duration = forever; }},
      {"[time] frame_rate = -60:", "> 0", [](Scene& s) { s.time.frame_rate = -60.0; }},
      {"[time] frame_rate = 10000000000:", "5e+10 outputs", [](Scene& s) { s.time.frame_rate = 1e10; }},
      {"[time] step = -1:", "\"auto\"", [](Scene& s) { s.time.step = -1.0; }},
      {"[time] step = nan:", "\"auto\"", [&](Scene& s) { s.time.step = nan; }},
      {"[time] step = 1e-200:", "steps", [](Scene& s) { s.time.step = 1e-200; }},
      {"[time] baumgarte = -1:", "(1/s)", [](Scene& s) { s.time.baumgarte = -1.0; }},
      {"[time] baumgarte = 1e+31:", "1e-30 to 1e+30", [](Scene& s) { s.time.baumgarte = 1e31; }},
      {"traction:", "at most 1e+30", [](Scene& s) { s.tractions[0].keys[0].p.x = 1e200; }},
      {"[body_force] acceleration", "at most 1e+30", [](Scene& s) { s.body_acceleration.y = -1e40; }},
      {"[render] size = [100000, 100000]:", "a width of 240 to 16384",
       [](Scene& s) {
         s.picture.size = {100000, 100000};
       }},
      {"[render] size = [1280, 159]:", "a height of 160 to 16384",
       [](Scene& s) {
         s.picture.size = {1280, 159};
       }},
      {"[render] range = [1, 1]:", "low < high",
       [](Scene& s) {
         s.picture.range_auto = false;
         s.picture.range = {1.0, 1.0};
       }},
      {"[render] branch = 2:", "the material has 1 Maxwell branch,", [](Scene& s) { s.picture.branch = 2; }},
      {"[render] arrow_scale = -1:", "> 0", [](Scene& s) { s.picture.arrow_scale = -1.0; }},
      {"[render] every = 0:", "1 to 1000000000", [](Scene& s) { s.picture.every = 0; }},
      {"[render] branch = -1:", "from 1 on", [](Scene& s) { s.picture.branch = -1; }},
  };
  for (const Case& c : cases) {
    Scene scene = good();
    c.spoil(scene);
    EXPECT_THAT(error_of([&] { validate(scene); }), AllOf(StartsWith(c.begin), HasSubstr(c.part))) << c.part;
  }
}

}  // namespace
}  // namespace rheo
