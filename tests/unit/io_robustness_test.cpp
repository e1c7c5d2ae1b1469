// Damaged files: cut at every byte, bytes flipped, runs inserted and taken out. Nothing but an Error of one
// line may come out of a reader (and under sanitizers nothing is read or written out of bounds).
#include <gtest/gtest.h>

#include <random>

#include "io/table_file.hpp"
#include "io/toml_tree.hpp"
#include "io_error_of.hpp"
#include "rheo/io/mesh_file.hpp"
#include "rheo/io/scene_file.hpp"

namespace rheo {
namespace {

namespace fs = std::filesystem;
using testing::read_text;

const fs::path scenes = fs::path(RHEO_SOURCE_DIR) / "app" / "scenes";
const fs::path meshes = fs::path(RHEO_TEST_DATA) / "msh";

// True when it was read, false when it was refused as it should be.
template <typename Read>
bool reads(Read read, const std::string& bytes) {
  try {
    read(bytes);
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    EXPECT_LT(std::string(error.what()).size(), 1000u) << error.what();
    return false;
  }
}

template <typename Read>
void cut_everywhere(Read read, const std::string& bytes) {
  for (std::size_t length = 0; length < bytes.size(); ++length) reads(read, bytes.substr(0, length));
}

template <typename Read>
void damage(Read read, const std::string& bytes, int variants) {
  std::mt19937 random(20261123);
  const auto below = [&](std::size_t limit) { return static_cast<std::size_t>(random() % limit); };
  int refused = 0;
  for (int i = 0; i < variants; ++i) {
    std::string copy = bytes;
    for (std::size_t k = 0; k <= below(4); ++k) {
      const std::size_t at = below(copy.size());
      switch (below(4)) {
        case 0:
          copy[at] = static_cast<char>(random());
          break;
        case 1:
          copy[at] = "0123456789.-e[]{}\"=,\n"[below(21)];
          break;
        case 2:
          copy.erase(at, 1 + below(8));
          break;
        default:
          copy.insert(at, bytes, below(bytes.size()), below(16));
          break;
      }
      if (copy.empty()) copy = bytes;
    }
    refused += reads(read, copy) ? 0 : 1;
  }
  EXPECT_GT(refused, variants / 10) << "hardly any variant was damaged enough to show";
}

void read_prepared_mesh(const std::string& bytes) {
  Mesh mesh = parse_msh(bytes, "m.msh");
  prepare(mesh, "m.msh");
}

void read_scene_text(const std::string& text) {
  parse_scene(text, "s.toml", scenes);
}

class DamagedMesh : public ::testing::TestWithParam<const char*> {};

TEST_P(DamagedMesh, IsReadOrRefused) {
  const std::string bytes = read_text(meshes / GetParam());
  ASSERT_TRUE(reads(read_prepared_mesh, bytes));
  cut_everywhere(read_prepared_mesh, bytes);
  damage(read_prepared_mesh, bytes, 2000);
}

INSTANTIATE_TEST_SUITE_P(Gmsh, DamagedMesh,
                         ::testing::Values("ascii22.msh", "binary22.msh", "ascii41.msh", "binary41.msh",
                                           "all22.msh", "parametric41b.msh"),
                         [](const auto& suite) {
                           const std::string name = suite.param;
                           return name.substr(0, name.find('.'));
                         });

class DamagedScene : public ::testing::TestWithParam<const char*> {};

TEST_P(DamagedScene, IsReadOrRefused) {
  const std::string text = read_text(scenes / GetParam());
  ASSERT_TRUE(reads(read_scene_text, text));
  cut_everywhere(read_scene_text, text);
  damage(read_scene_text, text, 1000);
}

INSTANTIATE_TEST_SUITE_P(Shipped, DamagedScene,
                         ::testing::Values("beam.toml", "liver.toml", "food_disk.toml"),
                         [](const auto& suite) {
                           const std::string name = suite.param;
                           return name.substr(0, name.find('.'));
                         });

TEST(DamagedToml, IsReadOrRefused) {
  const auto read = [](const std::string& text) { parse_toml(text, "t.toml"); };
  const std::string text = R"(title = """
a "quoted" \u00e9\t é"""  # é
a = '''b'''
[x.y]
date = 1979-05-27T07:32:00Z
time = 07:32:00
"q é".'z' = {a = [1, {b = 2}], c.d = 0x1F, e = [-inf, +nan, 1_000.5e-3]}
[[list.of.tables]]
s = "\u00e9\U0001F600"
)";
  ASSERT_TRUE(reads(read, text));
  cut_everywhere(read, text);
  damage(read, text, 4000);
}

TEST(DamagedTable, IsReadOrRefused) {
  const auto read = [](const std::string& text) { parse_table(text, "t.csv", 3, "t, x, y"); };
  const std::string text = "# comment\nt,x,y\n0,1,2\n1.5,-2e-3,+4\n\"3\",4,5\n";
  cut_everywhere(read, text);
  damage(read, text, 2000);
}

}  // namespace
}  // namespace rheo
