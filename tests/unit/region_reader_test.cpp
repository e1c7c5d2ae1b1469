// [[region]] tables: which triangles each takes, and every key missing, misspelt, of a wrong type, out of
// range.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io_error_of.hpp"
#include "rheo/io/mesh_file.hpp"
#include "rheo/io/scene_file.hpp"

namespace rheo {
namespace {

using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// A square of 4 x 4 cells of 1 m, or Gmsh's layers.
const char* const square = "[mesh]\nshape = \"rectangle\"\nsize = [4, 4]\nnodes = [5, 5]\n";  // lines 1 to 4
const char* const layers = "[mesh]\nfile = \"msh/layers41.msh\"\n\n\n";
const char* const materials =
    "[material]\nlambda_ela = 7\nmu_ela = 5\nlambda_vis = 4\nmu_vis = 2\ndensity = 1\n"  // lines 5 to 10
    "[time]\nduration = 1\n";                                                            // 11, 12
const char* const own =
    "[region.material]\nlambda_ela = 70\nmu_ela = 50\nlambda_vis = 4\nmu_vis = 2\n"
    "density = 3\n";

Scene parse(const std::string& mesh, const std::string& regions) {
  return parse_scene(mesh + materials + regions, "bad.toml", RHEO_TEST_DATA);
}

// One region after line 12; `keys` begin in line 14.
std::string region(const std::string& keys, const std::string& material = own) {
  return "[[region]]\n" + keys + "\n" + material;
}

Vec2 centroid(const Mesh& mesh, std::size_t t) {
  Vec2 c;
  for (const int node : mesh.triangles[t]) {
    c.x += mesh.points[static_cast<std::size_t>(node)].x / 3;
    c.y += mesh.points[static_cast<std::size_t>(node)].y / 3;
  }
  return c;
}

template <typename Inside>
void expect_region(const Scene& scene, Inside inside) {
  ASSERT_EQ(scene.region_of_triangle.size(), scene.mesh.triangles.size());
  int count = 0;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    EXPECT_EQ(scene.region_of_triangle[t] != 0, inside(centroid(scene.mesh, t))) << "triangle " << t;
    count += scene.region_of_triangle[t] != 0 ? 1 : 0;
  }
  EXPECT_GT(count, 0);
}

TEST(RegionReader, ABoxTakesTheTrianglesWhoseCentroidLiesInside) {
  const Scene scene = parse(square, region("box = [1, 0, 3, 2]"));
  ASSERT_EQ(scene.regions.size(), 1u);
  EXPECT_EQ(scene.regions[0].name, "region 1");
  EXPECT_EQ(scene.regions[0].material.mu_ela, 50.0);
  EXPECT_EQ(scene.regions[0].material.density, 3.0);
  expect_region(scene, [](Vec2 c) { return c.x > 1 && c.x < 3 && c.y < 2; });
}

TEST(RegionReader, ADiskTakesTheTrianglesWhoseCentroidLiesInside) {
  expect_region(parse(square, region("name = \"core\"\ndisk = [2, 2, 1.2]")),
                [](Vec2 c) { return std::hypot(c.x - 2, c.y - 2) <= 1.2; });
}

TEST(RegionReader, APolygonMayBeConcave) {
  // An L: the lower half and the left half.
  expect_region(parse(square, region("polygon = [[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]]")),
                [](Vec2 c) { return c.y < 2 || c.x < 2; });
}

TEST(RegionReader, APhysicalSurfaceIsFoundByNameAndByNumber) {
  const auto upper = [](Vec2 c) { return c.y > 0.01; };
  const auto middle = [](Vec2 c) { return c.y > 0.01 && c.y < 0.03; };
  expect_region(parse(layers, region("physical = \"upper\"")), upper);
  expect_region(parse(layers, region("physical = 33")), upper);
  expect_region(parse(layers, region("physical = 32")), middle);
  expect_region(parse(layers, region("physical = \"physical_32\"")), middle);
  expect_region(parse(layers, region("physical = \"crust\"")), [&](Vec2 c) { return !middle(c); });
}

TEST(RegionReader, ALaterRegionTakesTrianglesFromAnEarlierOne) {
  const Scene scene = parse(square, region("box = [0, 0, 4, 2]") + region("box = [0, 0, 2, 4]"));
  ASSERT_EQ(scene.regions.size(), 2u);
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const Vec2 c = centroid(scene.mesh, t);
    EXPECT_EQ(scene.region_of_triangle[t], c.x < 2 ? 2 : c.y < 2 ? 1 : 0);
  }
}

TEST(RegionReader, WhereRegionsCoverTheMeshNothingIsOfMaterial) {
  const Scene scene = parse(square, region("box = [0, 0, 4, 2]") + region("box = [0, 2, 4, 4]"));
  EXPECT_EQ(scene.material.density, 3.0);
  EXPECT_EQ(scene.material_name, "region 1");
  ASSERT_EQ(scene.regions.size(), 1u);
  EXPECT_EQ(scene.regions[0].name, "region 2");
}

TEST(RegionReader, ARegionHasAllThatMaterialHas) {
  const Scene scene = parse(square, region("box = [0, 0, 4, 2]",
                                           "[region.material]\ndensity = 1\n[region.material.elastic]\n"
                                           "young = 1000\npoisson = 0.3\n[region.material.viscous]\n"
                                           "lambda = 1\nmu = 2\n[[region.material.maxwell]]\nlambda_ela = 1\n"
                                           "mu_ela = 2\ntime = 3\n"));
  EXPECT_GT(scene.regions.at(0).material.elastic.mu, 0.0);
  EXPECT_EQ(scene.regions.at(0).material.viscous.mu, 2.0);
  EXPECT_EQ(scene.regions.at(0).material.branch(0).mu_vis, 6.0);
}

struct Bad {
  const char* keys;
  const char* begins;
  const char* says;
};
class BadRegion : public ::testing::TestWithParam<Bad> {};

TEST_P(BadRegion, IsNamedWithWhatIsAllowed) {
  const Bad& bad = GetParam();
  EXPECT_THAT(error_of([&] { parse(square, region(bad.keys)); }),
              AllOf(StartsWith(bad.begins), HasSubstr(bad.says)))
      << bad.keys;
}

INSTANTIATE_TEST_SUITE_P(
    RegionReader, BadRegion,
    ::testing::Values(Bad{"", "bad.toml:13: [[region]]", "box"},
                      Bad{"box = [0, 0, 1, 1]\ndisk = [0, 0, 1]", "bad.toml:", "disk"},
                      Bad{"bqox = [0, 0, 1, 1]", "bad.toml:14: [[region]] bqox", "did you mean box?"},
                      Bad{"name = 3\nbox = [0, 0, 1, 1]", "bad.toml:14: [[region]] name = 3",
                          "a text in quotes"},
                      Bad{"box = 3", "bad.toml:14: [[region]] box = 3", "[x0, y0, x1, y1]"},
                      Bad{"box = [0, 0, 1]", "bad.toml:14: [[region]] box", "[x0, y0, x1, y1]"},
                      Bad{"box = [0, 0, 1, inf]", "bad.toml:14: [[region]] box", "finite"},
                      Bad{"box = [1, 0, 0, 1]", "bad.toml:14: [[region]] box", "x0 < x1"},
                      Bad{"box = [9, 9, 10, 10]", "bad.toml:14: [[region]] box", "no triangle"},
                      Bad{"disk = [0, 0]", "bad.toml:14: [[region]] disk", "[x, y, radius]"},
                      Bad{"disk = [0, 0, 0]", "bad.toml:14: [[region]] disk", "radius > 0"},
                      Bad{"disk = [0, 0, -1]", "bad.toml:14: [[region]] disk", "radius > 0"},
                      Bad{"disk = [0, 0, \"a\"]", "bad.toml:14: [[region]] disk", "finite"},
                      Bad{"polygon = [[0, 0], [1, 1]]", "bad.toml:14: [[region]] polygon", "three corners"},
                      Bad{"polygon = [[0, 0], [1, 1], [2]]", "bad.toml:14: [[region]] polygon", "[x, y]"},
                      Bad{"polygon = \"all\"", "bad.toml:14: [[region]] polygon", "[x, y]"},
                      Bad{"physical = 1.5", "bad.toml:14: [[region]] physical = 1.5", "the name or number"},
                      Bad{"physical = \"core\"", "bad.toml:14: [[region]] physical", "no physical surface"}));

TEST(RegionReader, AnUnknownSurfaceIsAnsweredWithTheKnownOnes) {
  EXPECT_THAT(error_of([] { parse(layers, region("physical = \"crst\"")); }),
              AllOf(StartsWith("bad.toml:14: [[region]] physical"), HasSubstr("did you mean \"crust\"?"),
                    HasSubstr("upper")));
  EXPECT_THAT(error_of([] { parse(layers, region("physical = 99")); }), HasSubstr("crust"));
}

TEST(RegionReader, NamesAreNotEmptyAndEachItsOwn) {
  const auto named = [](const std::string& name) {
    return region("name = \"" + name + "\"\nbox = [0, 0, 2, 2]\n");
  };
  for (const char* name : {"", "material"})
    EXPECT_THAT(error_of([&] { parse(square, named(name)); }), HasSubstr("a name of its own")) << name;
  EXPECT_THAT(error_of([&] { parse(square, named("core") + "\n" + named("core")); }),
              AllOf(HasSubstr("name = \"core\""), HasSubstr("a name of its own")));
  // The second's default name is the first's.
  EXPECT_THAT(error_of([&] { parse(square, named("region 2") + "\n" + region("box = [2, 2, 4, 4]\n")); }),
              HasSubstr("name = \"region 2\""));
}

TEST(RegionReader, TrianglesCanBeNamedByNumber) {
  const Scene scene = parse(square, region("triangles = [3, 0, 31]\n"));
  for (std::size_t t = 0; t < scene.region_of_triangle.size(); ++t)
    EXPECT_EQ(scene.region_of_triangle[t], t == 0 || t == 3 || t == 31 ? 1 : 0) << t;
  EXPECT_THAT(error_of([] { parse(square, region("triangles = [3, 32]\n")); }),
              AllOf(HasSubstr("triangles[1] = 32"), HasSubstr("from 0 to 31")));
  EXPECT_THAT(error_of([] { parse(square, region("triangles = []\n")); }),
              HasSubstr("a list of triangle numbers"));
}

TEST(RegionReader, ARegionOfWhichNothingIsLeftIsRefused) {
  EXPECT_THAT(error_of([] { parse(square, region("box = [0, 0, 1, 1]") + region("box = [0, 0, 2, 2]")); }),
              AllOf(StartsWith("bad.toml:13: [[region]]"), HasSubstr("later regions have taken all")));
}

TEST(RegionReader, AMaterialIsNeededAndIsRead) {
  EXPECT_THAT(error_of([] { parse(square, region("box = [0, 0, 1, 1]", "")); }),
              AllOf(StartsWith("bad.toml:13: [[region]]"), HasSubstr("material")));
  EXPECT_THAT(error_of([] { parse(square, region("box = [0, 0, 1, 1]\nmaterial = 3", "")); }),
              AllOf(StartsWith("bad.toml:15: [[region]] material = 3"), HasSubstr("[region.material]")));
  EXPECT_THAT(
      error_of([] { parse(square, region("box = [0, 0, 1, 1]", "[region.material]\nlambda_ela = -1\n")); }),
      StartsWith("bad.toml:16: [region.material] lambda_ela = -1"));
}

TEST(RegionReader, TheMassIsTheScenes) {
  EXPECT_THAT(error_of([] {
                parse(square, region("box = [0, 0, 1, 1]", std::string(own) + "mass = \"consistent\""));
              }),
              AllOf(HasSubstr("bad.toml:13: [[region]]"), HasSubstr("mass")));
}

class Layers : public ::testing::TestWithParam<const char*> {};

TEST_P(Layers, PhysicalSurfacesAreGroupsOfTriangles) {
  const Mesh mesh = read_msh(std::string(RHEO_TEST_DATA) + "/msh/" + GetParam());
  std::vector<std::string> names;
  for (const auto& [name, triangles] : mesh.triangle_groups) names.push_back(name);
  EXPECT_THAT(names, ::testing::ElementsAre("crust", "physical_32", "upper"));
  const auto in_group = [&](const char* name, std::size_t t) {
    const auto& group = mesh.triangle_groups.at(name);
    return std::count(group.begin(), group.end(), static_cast<std::int32_t>(t)) == 1;
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double y = centroid(mesh, t).y;
    EXPECT_EQ(in_group("crust", t), y < 0.01 || y > 0.03);
    EXPECT_EQ(in_group("physical_32", t), y > 0.01 && y < 0.03);
    EXPECT_EQ(in_group("upper", t), y > 0.01);
  }
  double area = 0.0;
  for (int t = 0; t < mesh.triangle_count(); ++t) area += std::abs(signed_area(mesh, t));
  EXPECT_NEAR(area, 0.04 * 0.04, 1e-15) << "each triangle is there once";
}

INSTANTIATE_TEST_SUITE_P(Gmsh, Layers,
                         ::testing::Values("layers22.msh", "layers22b.msh", "layers41.msh", "layers41b.msh"),
                         [](const auto& suite) {
                           const std::string name = suite.param;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace rheo
