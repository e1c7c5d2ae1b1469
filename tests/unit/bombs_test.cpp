// Scenes and meshes that ask for more than there is: refused with an estimate and the limit, before memory
// goes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "io_error_of.hpp"
#include "rheo/io/mesh_file.hpp"
#include "rheo/io/scene_file.hpp"
#include "rheo/memory_limit.hpp"
#include "rheo/memory_need.hpp"
#include "rheo/shapes.hpp"
#include "rheo/simulation.hpp"

namespace rheo {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* rest =
    "[material]\nlambda_ela = 7\nmu_ela = 5\nlambda_vis = 4\nmu_vis = 2\ndensity = 0.2\n[time]\nduration = "
    "1\n";
constexpr const char* square = "[mesh]\nshape = \"rectangle\"\nsize = [1, 1]\nnodes = [11, 11]\n";

Scene read(const std::string& text, double memory = 0.0) {
  return parse_scene(text, "bomb.toml", RHEO_TEST_OUTPUT, {.memory = memory});
}

std::string repeated(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

TEST(Bombs, AMeshOfManyNodes) {
  const std::string mesh = "[mesh]\nshape = \"rectangle\"\nsize = [1, 1]\nnodes = [{0}, {0}]\n";
  const auto text = [&](int nodes) { return fmt::format(fmt::runtime(mesh), nodes) + rest; };
  EXPECT_THAT(error_of([&] { read(text(1'000'000)); }),
              AllOf(StartsWith("bomb.toml:4: [mesh] nodes = [1000000, 1000000]: "),
                    HasSubstr("1e+12 nodes need about 1.4e+05 GB of memory"), HasSubstr("--memory-limit")));
  EXPECT_THAT(error_of([&] { read(text(1000), 1e8); }),
              HasSubstr("need about 140 MB of memory, the limit is"));
  EXPECT_EQ(read(text(100), 1e8).mesh.node_count(), 10'000);
}

TEST(Bombs, ManyBodiesOfOneMeshAreCountedTogether) {
  const std::string body =
      "[[body]]\nmesh = {shape = \"rectangle\", size = [1, 1], nodes = [100, 100]}\nmaterial = {lambda_ela = "
      "1, "
      "mu_ela = 1, lambda_vis = 1, mu_vis = 1, density = 1}\n";
  const std::string time = "[time]\nduration = 1\n";
  EXPECT_EQ(read(repeated(3, body) + time, 5e6).bodies.size(), 3u);
  EXPECT_THAT(error_of([&] { read(repeated(30, body) + time, 5e6); }),
              AllOf(HasSubstr("[body.mesh] nodes"), HasSubstr("the limit is"), HasSubstr("--memory-limit")));
}

TEST(Bombs, LongLists) {
  const std::string keys = repeated(100'000, "[0,0,0],");
  const std::string text = square + std::string("[[move]]\nedges = \"left\"\nkeys = [") + keys + "]\n" + rest;
  EXPECT_THAT(error_of([&] { read(text, 5e7); }),
              AllOf(StartsWith("bomb.toml: 4e+05 values need about "), HasSubstr("the limit is 50 MB"),
                    HasSubstr("--memory-limit")));
  // In texts and comments they take no more than their characters.
  EXPECT_EQ(read("title = \"" + keys + "\"  # " + keys + "\n" + square + rest, 5e7).title, keys);
}

TEST(Bombs, TablesOfNumbersInFiles) {
  const fs::path folder = testing::fresh_folder("bombs");
  std::string rows;
  for (int i = 0; i < 100'000; ++i) rows += fmt::format("{},0,0\n", i);
  testing::write_text(folder / "k.csv", rows);
  const std::string move = "[[move]]\nedges = \"left\"\nkeys = \"k.csv\"\n";
  const auto read_moves = [&](int count, double memory) {
    return parse_scene(square + repeated(count, move) + rest, "bomb.toml", folder, {.memory = memory});
  };
  EXPECT_EQ(read_moves(1, 3e7).moves.size(), 1u);
  EXPECT_THAT(error_of([&] { read_moves(1, 1e7); }),
              AllOf(StartsWith("bomb.toml:7: [[move]] keys"), HasSubstr("100001 rows need about"),
                    HasSubstr("--memory-limit")));
  EXPECT_THAT(error_of([&] { read_moves(3, 3e7); }), HasSubstr("need about"));
}

TEST(Bombs, AHoleInAFileOfATerabyte) {
  const fs::path folder = testing::fresh_folder("bombs_hole");
  testing::write_text(folder / "hole.msh", "$MeshFormat\n");
  fs::resize_file(folder / "hole.msh", std::uintmax_t{1} << 31);
  const std::string text = std::string("[mesh]\nfile = \"hole.msh\"\n") + rest;
  EXPECT_THAT(error_of([&] { parse_scene(text, "bomb.toml", folder, {.memory = 1e8}); }),
              AllOf(HasSubstr("the file's bytes need about 2.15 GB of memory"), HasSubstr("--memory-limit")));
}

TEST(Bombs, AGroupNamedManyTimes) {
  const std::string fix = "[[fix]]\nedges = \"boundary\"\n";
  EXPECT_EQ(read(square + repeated(10, fix) + rest, 1e6).fixes.size(), 10u);
  EXPECT_THAT(error_of([&] { read(square + repeated(300, fix) + rest, 1e6); }),
              AllOf(HasSubstr("[[fix]] 40 nodes need about"), HasSubstr("--memory-limit")));
}

TEST(Bombs, OutputsWithoutEnd) {
  EXPECT_THAT(error_of([&] { read(square + std::string(rest) + "frame_rate = 1e9\n"); }),
              AllOf(StartsWith("bomb.toml:13: [time] frame_rate = 1"),
                    HasSubstr("1e+09 outputs in 1 s, 300 GB of memory"), HasSubstr("1e+07"),
                    HasSubstr("--output-limit")));
  const std::string text = square + std::string(rest) + "frame_rate = 1e3\n";
  EXPECT_THAT(error_of([&] { parse_scene(text, "bomb.toml", {}, {.outputs = 100}); }),
              HasSubstr("1e+02 are"));
  EXPECT_EQ(parse_scene(text + "# more", "bomb.toml", {}, {.outputs = 1e9}).time.most_outputs, 1e9);
}

TEST(Bombs, PicturesAndSheets) {
  EXPECT_THAT(error_of([&] { read(square + std::string(rest) + "[render]\nsize = [100000, 100000]\n"); }),
              AllOf(StartsWith("bomb.toml:14: [render] size = [100000, 100000]"), HasSubstr("480 GB"),
                    HasSubstr("16384")));
  std::string times = "0";
  for (int i = 1; i < 100'000; ++i) times += fmt::format(",{}e-5", i);
  EXPECT_THAT(error_of([&] { read(square + std::string(rest) + "[render]\nsheet = [" + times + "]\n"); }),
              AllOf(StartsWith("bomb.toml:14: [render] sheet"), HasSubstr("100000 times: at most 64")));
}

TEST(Bombs, MeshesThatPromiseMoreThanTheyHold) {
  for (const char* count : {"1152921504606846976", "9223372036854775807", "4294967296"}) {
    const std::string head = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
    EXPECT_THAT(error_of([&] { parse_msh(head + "$Nodes\n1 " + count + " 1 1\n2 1 0 1\n", "m.msh"); }),
                AllOf(HasSubstr(count), HasSubstr("bytes left in the file cannot hold so many")));
    EXPECT_THAT(error_of([&] { parse_msh(head + "$Nodes\n1 1 1 1\n2 1 0 " + count + "\n", "m.msh"); }),
                HasSubstr("cannot hold so many"));
    EXPECT_THAT(error_of([&] { parse_msh(head + "$Entities\n" + count + " 0 0 0\n", "m.msh"); }),
                HasSubstr("cannot hold so many"));
    EXPECT_THAT(error_of([&] { parse_msh(head + "$Elements\n1 " + count + " 1 1\n", "m.msh"); }),
                HasSubstr("cannot hold so many"));
  }
  EXPECT_THAT(error_of([] {
                parse_msh("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1152921504606846976\n", "m.msh");
              }),
              AllOf(HasSubstr("1152921504606846976"), HasSubstr("whole number from -2147483648 to")));
  // Binary: 2^60 nodes in one block.
  const auto bytes = [](auto... values) {
    std::string all;
    const auto add = [&](const auto& value) {
      char raw[sizeof value];
      std::memcpy(raw, &value, sizeof value);
      all.append(raw, sizeof value);
    };
    (add(values), ...);
    return all;
  };
  constexpr std::int64_t many = std::int64_t{1} << 60;
  const std::string head = "$MeshFormat\n4.1 1 8\n" + bytes(1) + "\n$EndMeshFormat\n$Nodes\n";
  EXPECT_THAT(error_of([&] {
                parse_msh(head + bytes(std::int64_t{1}, many, std::int64_t{1}, many) + "\n", "m.msh");
              }),
              AllOf(HasSubstr("1152921504606846976"), HasSubstr("cannot hold so many")));
}

TEST(Bombs, ATriangleInManyGroups) {
  // 1000 triangles, each in 1000 physical surfaces, in some 20 kB of text.
  std::string groups, triangles;
  for (int i = 1; i <= 1000; ++i) groups += fmt::format(" {}", i), triangles += fmt::format("{} 1 2 3\n", i);
  const std::string text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 1 1 0 1000" +
                           groups +
                           " 0\n$EndEntities\n$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 "
                           "0\n$EndNodes\n$Elements\n1 1000 1 "
                           "1000\n2 1 2 1000\n" +
                           triangles + "$EndElements\n";
  EXPECT_THAT(error_of([&] { parse_msh(text, "m.msh", nullptr, 1e8); }),
              AllOf(StartsWith("m.msh:"), HasSubstr("1000000 elements need about"), HasSubstr("the limit is"),
                    HasSubstr("--memory-limit")));
}

Scene clamped(int constraints, Mass mass) {
  Scene scene;
  scene.mesh = rectangle({1.0, 1.0}, 21, 21);
  scene.material = {.lambda_ela = 7, .mu_ela = 5, .lambda_vis = 4, .mu_vis = 2, .density = 0.2, .mass = mass};
  scene.time.duration = 1.0;
  for (int i = 0; i < constraints; ++i)
    scene.constraints.push_back({.terms = {{0, Axis::x, 1.0 + i}, {1 + i % 400, Axis::y, 1.0}}, .where = {}});
  return scene;
}

TEST(Bombs, ConstraintsThatAllMeet) {
  // A million of them would take 4e13 bytes.
  EXPECT_THAT(error_of([] { require_memory(clamped(1'000'000, Mass::lumped), 0.0); }),
              AllOf(StartsWith("1000000 general constraints need about "), HasSubstr("e+04 GB of memory"),
                    HasSubstr("take fewer [[constraint]]"), HasSubstr("--memory-limit")));
  EXPECT_THAT(error_of([] { Simulation(clamped(2000, Mass::consistent), {.memory = 1e8}); }),
              AllOf(StartsWith("2000 general constraints with mass = \"consistent\" need about 16"),
                    HasSubstr("the limit is 100 MB"), HasSubstr("--memory-limit")));
}

// Few meet, so that a matrix of them would have room.
TEST(Bombs, MoreConstraintsThanThereIsToHold) {
  Scene scene = clamped(0, Mass::lumped);
  scene.mesh = rectangle({1.0, 1.0}, 11, 11);
  for (int i = 0; i < 100'000; ++i)
    scene.constraints.push_back(
        {.terms = {{i % 121, Axis::x, 1.0}, {(i + 1 + i / 121) % 121, Axis::y, 1.0}}, .where = {}});
  EXPECT_THAT(error_of([&] { Simulation{scene}; }),
              AllOf(StartsWith("100000 constraints hold at once what can move in "), HasSubstr(" ways only"),
                    HasSubstr("take those out")));
}

TEST(Bombs, TheFillOfTheConstraintsFactorIsKnownBeforeItIsMade) {
  // Each meets some others of a random graph: few entries, a factor that is all but full.
  Scene scene = clamped(0, Mass::lumped);
  scene.mesh = rectangle({1.0, 1.0}, 101, 101);
  unsigned state = 1;
  const auto multiple_of_3 = [&] {
    return static_cast<int>((state = state * 1664525u + 1013904223u) >> 8) % 2000 * 3;
  };
  for (int i = 0; i < 6000; ++i) {
    scene.constraints.push_back({.terms = {{i, Axis::x, 1.0},
                                           {multiple_of_3(), Axis::y, 1.0},
                                           {multiple_of_3() + 1, Axis::y, 0.5},
                                           {multiple_of_3() + 2, Axis::y, 2.0}},
                                 .where = {}});
  }
  EXPECT_LT(memory_need(scene).total(), 4e7);
  EXPECT_THAT(error_of([&] { Simulation(scene, {.memory = 4e7}); }),
              AllOf(HasSubstr("6000 general constraints need "), HasSubstr("--memory-limit")));
}

TEST(Bombs, ManyWindows) {
  Scene scene = clamped(0, Mass::lumped);
  for (int i = 0; i < 100'000; ++i)
    scene.fixes.push_back({.nodes = {i % 441}, .window = {.from = 1e-6 * i}, .where = {}});
  EXPECT_THAT(error_of([&] { require_memory(scene, 1e9); }),
              AllOf(StartsWith("100000 [[fix]] and [[move]] with times of their own need about 30 GB"),
                    HasSubstr("--memory-limit")));
}

TEST(MemoryNeed, CountsANodeForEachMaterialAndBranchThatItHas) {
  Scene scene = clamped(0, Mass::lumped);
  const double plain = memory_need(scene).total();
  Region region;
  region.name = "r";
  region.material = scene.material;
  region.material.lambda_ela = 8;
  scene.regions.push_back(region);
  scene.region_of_triangle.assign(scene.mesh.triangles.size(), 0);
  EXPECT_EQ(memory_need(scene).total(), plain);
  // One triangle of the other material: its three nodes are of both.
  scene.region_of_triangle[100] = 1;
  EXPECT_EQ(memory_need(scene).total(), plain + 3 * 128);
  scene.regions[0].material.more_branches.assign(4, {1, 1, 1, 1});
  EXPECT_EQ(memory_need(scene).total(), plain + 3 * 5 * 128);
}

// Assembled matrices take more than the kernels' forms.
TEST(MemoryNeed, CountsTheMatricesThatGeneralConstraintsNeed) {
  Scene scene = clamped(0, Mass::lumped);
  const double plain = memory_need(scene).nodes;
  scene.constraints.push_back({.terms = {{0, Axis::x, 1.0}, {1, Axis::x, -1.0}}, .where = {}});
  EXPECT_GT(memory_need(scene).nodes, 3 * plain);
}

TEST(MemoryLimit, IsWhatIsAskedForOrWhatThereIs) {
  EXPECT_EQ(memory_limit(1e6).bytes, 1e6);
  EXPECT_GT(memory_limit(0.0).bytes, 1e6);
  EXPECT_EQ(beyond(memory_limit(2.5e9), "take fewer"),
            "the limit is 2.5 GB: take fewer, or raise the limit with --memory-limit");
}

}  // namespace
}  // namespace rheo
