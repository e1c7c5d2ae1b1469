// Scenes as they should be: every key read, every default as documented, the shipped scenes.
#include "rheo/io/scene_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io_error_of.hpp"

namespace rheo {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::error_of;
using testing::fresh_folder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::write_text;

const char* const smallest = R"(
[mesh]
shape = "rectangle"
size = [1, 0.25]
nodes = [5, 2]
[material]
lambda_ela = 7
mu_ela = 5.0
lambda_vis = inf
mu_vis = 2
density = 0.2
[time]
duration = 5
)";

Scene parse(const std::string& text, const fs::path& folder = {}) {
  return parse_scene(text, "scene.toml", folder);
}

TEST(SceneFile, DefaultsAreAsDocumented) {
  const Scene scene = parse(smallest);
  EXPECT_EQ(scene.title, "scene.toml");
  EXPECT_EQ(scene.mesh.node_count(), 10);
  EXPECT_EQ(scene.mesh.triangles[0], (Triangle{0, 1, 5})) << "falling diagonals";
  EXPECT_EQ(scene.mesh.thickness, 1.0);
  EXPECT_EQ(scene.material.lambda_ela, 7.0);
  EXPECT_EQ(scene.material.lambda_vis, forever);
  EXPECT_EQ(scene.material.mass, Mass::lumped);
  EXPECT_EQ(scene.body_acceleration, (Vec2{0.0, 0.0}));
  EXPECT_THAT(scene.fixes, IsEmpty());
  EXPECT_EQ(scene.time.duration, 5.0);
  EXPECT_EQ(scene.time.frame_rate, 60.0);
  EXPECT_EQ(scene.time.integrator, IntegratorKind::automatic);
  EXPECT_EQ(scene.time.step, 0.0);
  EXPECT_EQ(scene.time.accuracy, 0.0);
  EXPECT_EQ(scene.time.baumgarte, 20.0);
  EXPECT_EQ(scene.time.constraints, ConstraintMethod::automatic);
  EXPECT_EQ(scene.picture.color, ColorBy::w_lambda);
  EXPECT_TRUE(scene.picture.range_auto);
  EXPECT_THAT(scene.picture.size, ElementsAre(1280, 720));
  EXPECT_THAT(scene.notes, IsEmpty());
}

TEST(SceneFile, ReadsEveryKey) {
  const Scene scene = parse(R"(
title = "All of it"
[mesh]
shape = "rectangle"
size = [1.0, 0.25]
nodes = [5, 2]
diagonal = "rising"
thickness = 0.5
[edges]
grip = [[9, 4]]
[material]
lambda_ela = 7.0
mu_ela = 0
lambda_vis = 4.0
mu_vis = 2.0
density = 0.2
mass = "consistent"
[body_force]
acceleration = [0.0, -9.81]
[[fix]]
edges = "left"
axis = "x"
from = 0.5
until = 2
[[fix]]
nodes = [3, 0]
[[move]]
edges = [[3, 4], [4, 9]]
axis = "y"
from = 0.25
until = 3.0
keys = [[0, 0, 0], [1, 0.5, 0.25]]
profile = "linear"
[[move]]
edges = "grip"
keys = [[0.0, 0.0, 0.0, 1.0, 2.0]]
profile = "hermite"
[[constraint]]
terms = [[9, "x", 1.0], [4, "y", -2]]
value = 0.125
[[traction]]
edges = "right"
vector = [10.0, -1]
until = 1.0
[[traction]]
edges = [[1, 0]]
keys = [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]]
from = 0.5
[[probe]]
name = "grip-1_A"
edges = "grip"
[[probe]]
name = "corner"
nodes = [9]
[time]
duration = 2.5
frame_rate = 30
integrator = "euler"
step = 1e-3
baumgarte = 50
constraints = "baumgarte"
[render]
color = "speed"
branch = 1
range = [0, 2.5]
size = [640, 480]
every = 20
arrow_scale = 12.5
)");
  EXPECT_EQ(scene.title, "All of it");
  EXPECT_EQ(scene.mesh.triangles[0], (Triangle{0, 1, 6}));
  EXPECT_EQ(scene.mesh.thickness, 0.5);
  EXPECT_THAT(scene.mesh.edge_groups.at("grip"), ElementsAre(Edge{4, 9}))
      << "turned: the interior on its left";
  EXPECT_EQ(scene.material.mass, Mass::consistent);
  EXPECT_EQ(scene.body_acceleration, (Vec2{0.0, -9.81}));
  ASSERT_EQ(scene.fixes.size(), 2u);
  EXPECT_THAT(scene.fixes[0].nodes, ElementsAre(0, 5));
  EXPECT_EQ(scene.fixes[0].axis, Axis::x);
  EXPECT_EQ(scene.fixes[0].window.from, 0.5);
  EXPECT_EQ(scene.fixes[0].window.until, 2.0);
  EXPECT_EQ(scene.fixes[0].where, "scene.toml:20: [[fix]]");
  EXPECT_THAT(scene.fixes[1].nodes, ElementsAre(0, 3));
  EXPECT_EQ(scene.fixes[1].window.until, forever);
  ASSERT_EQ(scene.moves.size(), 2u);
  EXPECT_THAT(scene.moves[0].nodes, ElementsAre(3, 4, 9));
  EXPECT_EQ(scene.moves[0].profile, Profile::linear);
  EXPECT_EQ(scene.moves[0].keys[1].u, (Vec2{0.5, 0.25}));
  EXPECT_EQ(scene.moves[1].profile, Profile::hermite);
  EXPECT_EQ(scene.moves[1].keys[0].v, (Vec2{1.0, 2.0}));
  ASSERT_EQ(scene.constraints.size(), 1u);
  EXPECT_EQ(scene.constraints[0].terms[1].node, 4);
  EXPECT_EQ(scene.constraints[0].terms[1].axis, Axis::y);
  EXPECT_EQ(scene.constraints[0].terms[1].coefficient, -2.0);
  EXPECT_EQ(scene.constraints[0].value, 0.125);
  ASSERT_EQ(scene.tractions.size(), 2u);
  EXPECT_EQ(scene.tractions[0].keys[0].p, (Vec2{10.0, -1.0}));
  EXPECT_EQ(scene.tractions[0].window.until, 1.0);
  EXPECT_THAT(scene.tractions[1].edges, ElementsAre(Edge{0, 1}));
  EXPECT_EQ(scene.tractions[1].keys[1].p, (Vec2{2.0, 3.0}));
  ASSERT_EQ(scene.probes.size(), 2u);
  EXPECT_THAT(scene.probes[0].nodes, ElementsAre(4, 9));
  EXPECT_THAT(scene.probes[0].edges, ElementsAre(Edge{4, 9}));
  EXPECT_THAT(scene.probes[1].edges, IsEmpty());
  EXPECT_EQ(scene.time.integrator, IntegratorKind::euler);
  EXPECT_EQ(scene.time.step, 1e-3);
  EXPECT_EQ(scene.time.constraints, ConstraintMethod::baumgarte);
  EXPECT_EQ(scene.picture.color, ColorBy::speed);
  EXPECT_EQ(scene.picture.branch, 1);
  EXPECT_FALSE(scene.picture.range_auto);
  EXPECT_THAT(scene.picture.range, ElementsAre(0.0, 2.5));
  EXPECT_THAT(scene.picture.size, ElementsAre(640, 480));
  EXPECT_EQ(scene.picture.every, 20);
  EXPECT_EQ(scene.picture.arrow_scale, 12.5);
}

const char* const rest = R"(
[material]
lambda_ela = 7
mu_ela = 5
lambda_vis = 4
mu_vis = 2
density = 1
[time]
duration = 1
step = "auto"
[render]
range = "auto"
)";

TEST(SceneFile, ReadsDisksAndInlineMeshes) {
  EXPECT_EQ(parse(std::string("[mesh]\nshape = \"disk\"\nradius = 2\nrings = 4\n") + rest).mesh.node_count(),
            61);
  const Scene scene =
      parse(std::string(
                "[mesh]\npoints = [[0, 0], [1, 0], [1, 1.0], [0, 1]]\ntriangles = [[0, 2, 1], [0, 2, 3]]\n") +
            rest);
  EXPECT_EQ(scene.mesh.triangle_count(), 2);
  EXPECT_THAT(scene.notes, ElementsAre("1 clockwise triangle was turned round"));
  EXPECT_EQ(scene.mesh.edge_groups.at("boundary").size(), 4u);
}

TEST(SceneFile, PathsAreRelativeToTheScene) {
  const fs::path folder = fresh_folder("scene_paths");
  fs::create_directories(folder / "data");
  fs::copy_file(fs::path(RHEO_TEST_DATA) / "msh" / "binary41.msh", folder / "data" / "plate.msh");
  write_text(folder / "data" / "keys.csv", "# measured\nt,ux,uy\n0,0,0\n1.5, 1e-3, 0\r\n");
  write_text(folder / "scene.toml", std::string("[mesh]\nfile = \"data/plate.msh\"\nthickness = 0.1\n") +
                                        rest + "[[move]]\nedges = \"wall side\"\nkeys = \"data/keys.csv\"\n");
  const Scene scene = read_scene(folder / "scene.toml");
  EXPECT_EQ(scene.title, "scene.toml");
  EXPECT_EQ(scene.mesh.triangle_count(), 20);
  EXPECT_EQ(scene.mesh.thickness, 0.1);
  ASSERT_EQ(scene.moves[0].keys.size(), 2u);
  EXPECT_EQ(scene.moves[0].keys[1].t, 1.5);
  EXPECT_EQ(scene.moves[0].keys[1].u, (Vec2{1e-3, 0.0}));
}

TEST(SceneFile, WindowsTextWithAByteOrderMarkIsRead) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : std::string(smallest)) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(parse(text).mesh.node_count(), 10);
}

TEST(SceneFile, FilesThatCannotBeReadAreAnotherKindOfError) {
  const fs::path folder = fresh_folder("scene_unreadable");
  EXPECT_THAT(error_of([&] { read_scene(folder / "none.toml"); }, Error::Kind::file),
              AllOf(HasSubstr("none.toml"), HasSubstr("No such file")));
  EXPECT_THAT(error_of([&] { read_scene(folder); }, Error::Kind::file), HasSubstr("is a folder"));
}

TEST(SceneFile, HugeFilesAreRefusedBeforeTheyAreRead) {
  const fs::path file = fresh_folder("scene_huge") / "huge.toml";
  write_text(file, "title = \"x\"\n");
  fs::resize_file(file, std::uintmax_t{1} << 40);  // a hole: no disk is used
  EXPECT_THAT(error_of([&] { read_scene(file); }), AllOf(HasSubstr("huge.toml"), HasSubstr("64 MB")));
  if (fs::exists("/dev/zero")) {
    EXPECT_THAT(error_of([] { read_scene("/dev/zero"); }), HasSubstr("64 MB"));
  }
}

TEST(ShippedScenes, AreAllReadWithoutRemarks) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(RHEO_SOURCE_DIR) / "app" / "scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const Scene scene = read_scene(entry.path());
    EXPECT_THAT(scene.notes, IsEmpty()) << entry.path();
    EXPECT_NE(scene.title, entry.path().filename().string()) << "a shipped scene has a title";
    EXPECT_LE(scene.mesh.triangle_count(), 5000) << entry.path();
    ++count;
  }
  EXPECT_EQ(count, 8);
}

TEST(ShippedScenes, BeamIsThePapersBeam) {
  const Scene beam = read_scene(fs::path(RHEO_SOURCE_DIR) / "app" / "scenes" / "beam.toml");
  EXPECT_EQ(beam.mesh.node_count(), 10);
  EXPECT_EQ(beam.mesh.triangle_count(), 8);
  EXPECT_EQ(beam.mesh.points[9], (Vec2{1.0, 0.25}));
  EXPECT_EQ(beam.material.lambda_ela, 7.0);
  EXPECT_EQ(beam.material.mu_ela, 5.0);
  EXPECT_EQ(beam.material.lambda_vis, 4.0);
  EXPECT_EQ(beam.material.mu_vis, 2.0);
  EXPECT_EQ(beam.material.density, 0.2);
  EXPECT_EQ(beam.material.mass, Mass::consistent);
  EXPECT_THAT(beam.fixes.at(0).nodes, ElementsAre(0, 5));
  EXPECT_THAT(beam.tractions.at(0).edges, ElementsAre(Edge{4, 9}));
  EXPECT_EQ(beam.tractions.at(0).keys.at(0).p, (Vec2{10.0, 0.0}));
  EXPECT_EQ(beam.tractions.at(0).window.until, 1.0);
  EXPECT_EQ(beam.time.duration, 5.0);
}

}  // namespace
}  // namespace rheo
