// Meshes written by the real gmsh (tests/data/msh/make.sh), and the same files broken.
#include "rheo/io/mesh_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "io_error_of.hpp"

namespace rheo {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::error_of;
using ::testing::HasSubstr;
using testing::read_text;
using ::testing::StartsWith;

const fs::path folder = fs::path(RHEO_TEST_DATA) / "msh";

std::string bytes_of(const std::string& name) {
  return read_text(folder / name);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "nothing to replace: " << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string refusal(const std::string& bytes) {
  return error_of([&] { parse_msh(bytes, "m.msh"); });
}

double area_of(const Mesh& mesh) {
  double area = 0.0;
  for (int i = 0; i < mesh.triangle_count(); ++i) area += signed_area(mesh, i);
  return area;
}

class MshVariant : public ::testing::TestWithParam<const char*> {};

TEST_P(MshVariant, GivesTheSameMesh) {
  Mesh mesh = read_msh(folder / GetParam());
  ASSERT_EQ(mesh.node_count(), 16);
  ASSERT_EQ(mesh.triangle_count(), 20);
  EXPECT_EQ(prepare(mesh), 0);
  // Coordinates in a text file have 16 digits.
  const Mesh reference = read_msh(folder / "ascii22.msh");
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_NEAR(mesh.points[i].x, reference.points[i].x, 1e-16);
    EXPECT_NEAR(mesh.points[i].y, reference.points[i].y, 1e-16);
  }
  EXPECT_EQ(mesh.triangles, reference.triangles);
  // 6 cm x 4 cm less a corner of 2 cm x 2 cm, and the arc's two chords in it (an eighth of a circle each).
  EXPECT_NEAR(area_of(mesh), 0.06 * 0.04 - 0.02 * 0.02 + 0.02 * 0.02 * std::sin(0.25 * 3.14159265358979),
              1e-12);
}

TEST_P(MshVariant, NamesItsPhysicalLines) {
  Mesh mesh = read_msh(folder / GetParam());
  prepare(mesh);
  std::vector<std::string> names;
  for (const auto& [name, edges] : mesh.edge_groups) names.push_back(name);
  EXPECT_THAT(names, ::testing::ElementsAre("boundary", "physical_7", "pull", "wall side"));
  EXPECT_EQ(mesh.edge_groups["wall side"].size(), 2u);
  EXPECT_EQ(mesh.edge_groups["pull"].size(), 1u);
  EXPECT_EQ(mesh.edge_groups["physical_7"].size(), 4u);
  for (const Edge& edge : mesh.edge_groups["wall side"]) {
    EXPECT_EQ(mesh.points[static_cast<std::size_t>(edge[0])].x, 0.0);
    EXPECT_GT(mesh.points[static_cast<std::size_t>(edge[0])].y,
              mesh.points[static_cast<std::size_t>(edge[1])].y);
  }
}

INSTANTIATE_TEST_SUITE_P(Gmsh, MshVariant,
                         ::testing::Values("ascii22.msh", "binary22.msh", "ascii41.msh", "binary41.msh",
                                           "parametric41.msh", "parametric41b.msh"),
                         [](const auto& suite) {
                           const std::string name = suite.param;
                           return name.substr(0, name.find('.'));
                         });

TEST(Msh, LeavesOutTheMiddleOfAnArc) {
  for (const char* name : {"all22.msh", "all41.msh"}) {
    LeftOutNodes left_out;
    Mesh mesh = read_msh(folder / name, &left_out);
    EXPECT_EQ(mesh.node_count(), 16) << name;
    EXPECT_EQ(left_out.count, 1) << name;
    EXPECT_EQ(left_out.first_tag, 6) << name;
    EXPECT_NO_THROW(prepare(mesh)) << name;
    EXPECT_EQ(mesh.edge_groups.size(), 1u) << name << ": lines without a group make none";
  }
}

TEST(Msh, OfSeveralNodesLeftOutTheFirstIsNamed) {
  std::string text = bytes_of("all41.msh");
  text = replaced(text, "12 17 1 17\n", "13 19 1 19\n0 7 0 2\n18\n19\n1 1 0\n2 1 0\n");
  LeftOutNodes left_out;
  EXPECT_EQ(parse_msh(text, "m", &left_out).node_count(), 16);
  EXPECT_EQ(left_out.count, 3);
  EXPECT_EQ(left_out.first_tag, 18);
  parse_msh(bytes_of("ascii41.msh"), "m", &left_out);
  EXPECT_EQ(left_out.count, 0);
}

TEST(Msh, WindowsLineEndsMakeNoDifference) {
  for (const char* name : {"ascii22.msh", "ascii41.msh"}) {
    std::string text;
    for (const char c : bytes_of(name)) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    const Mesh mesh = parse_msh(text, name);
    EXPECT_EQ(mesh.triangles, read_msh(folder / name).triangles);
    EXPECT_EQ(mesh.edge_groups, read_msh(folder / name).edge_groups);
  }
}

// A 2.2 binary file with its numbers turned byte by byte, as a machine of the other order writes it.
std::string other_byte_order() {
  std::string bytes = bytes_of("binary22.msh");
  const auto turn = [&](std::size_t at, std::size_t size) {
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
  };
  turn(bytes.find("2.2 1 8\n") + 8, 4);
  std::size_t at = bytes.find("$Nodes\n16\n") + 10;
  for (int i = 0; i < 16; ++i, at += 28) {
    turn(at, 4);
    for (const std::size_t k : {4u, 12u, 20u}) turn(at + k, 8);
  }
  at = bytes.find("$Elements\n27\n") + 13;
  for (const std::size_t end = bytes.find("\n$EndElements"); at + 4 <= end; at += 4) turn(at, 4);
  return bytes;
}

TEST(Msh, BothByteOrdersAreRead) {
  const Mesh mesh = parse_msh(other_byte_order(), "turned.msh");
  const Mesh reference = read_msh(folder / "binary22.msh");
  EXPECT_EQ(mesh.points, reference.points);
  EXPECT_EQ(mesh.triangles, reference.triangles);
  EXPECT_EQ(mesh.edge_groups, reference.edge_groups);
}

TEST(Msh, TrianglesOfTwoPhysicalSurfacesAreReadOnce) {
  // Gmsh writes them once for each in version 2.2.
  std::string text = bytes_of("ascii22.msh");
  text = replaced(text, "$Elements\n27", "$Elements\n28");
  text = replaced(text, "8 2 2 20 1 1 6 14\n", "8 2 2 20 1 1 6 14\n28 2 2 21 1 1 6 14\n");
  EXPECT_EQ(parse_msh(text, "m").triangles, read_msh(folder / "ascii22.msh").triangles);
  // The same group again is a mistake, and prepare says so.
  Mesh mesh = parse_msh(replaced(text, "28 2 2 21", "28 2 2 20"), "m");
  EXPECT_THAT(error_of([&] { prepare(mesh); }), AllOf(HasSubstr("triangle 1 "), HasSubstr("triangle 0")));
}

TEST(Msh, OtherElementsAreNamedWithTheRemedy) {
  EXPECT_THAT(
      error_of([] { read_msh(folder / "quads.msh"); }),
      AllOf(HasSubstr("quads.msh:"), HasSubstr("quadrangle with 4 nodes"), HasSubstr("gmsh -2 -order 1")));
  EXPECT_THAT(error_of([] { read_msh(folder / "second_order.msh"); }),
              AllOf(HasSubstr("second-order"), HasSubstr("gmsh -2 -order 1")));
  EXPECT_THAT(refusal(replaced(bytes_of("ascii22.msh"), "8 2 2 20 1 1 6 14", "8 4 2 20 1 1 6 14 2")),
              HasSubstr("tetrahedron"));
  EXPECT_THAT(refusal(replaced(bytes_of("ascii22.msh"), "8 2 2 20 1 1 6 14", "8 99 2 20 1 1 6 14")),
              AllOf(HasSubstr("m.msh:38:"), HasSubstr("element type 99")));
}

TEST(Msh, OtherVersionsAndFormatsAreNamed) {
  const auto message = [](const char* name) { return error_of([&] { read_msh(folder / name); }); };
  EXPECT_THAT(message("version40.msh"),
              AllOf(HasSubstr("version \"4\""), HasSubstr("2.2 and 4.1"), HasSubstr("gmsh ")));
  EXPECT_THAT(message("version1.msh"), HasSubstr("version 1"));
  EXPECT_THAT(message("plate.stl"), AllOf(HasSubstr("plate.stl:1:"), HasSubstr("STL")));
  EXPECT_THAT(message("plate.vtk"), HasSubstr("VTK"));
  EXPECT_THAT(message("plate.mesh"), HasSubstr("Medit"));
  EXPECT_THAT(message("plate.geo"), HasSubstr("$MeshFormat"));
  if (fs::exists("/dev/zero")) {  // endless
    EXPECT_THAT(message("/dev/zero"), HasSubstr("$MeshFormat"));
  }
  EXPECT_THAT(refusal("v 0 0 0\nf 1 2 3\n"), HasSubstr("OBJ"));
  EXPECT_THAT(refusal(std::string("\x7f"
                                  "ELF\0\1\2\xff",
                                  8)),
              HasSubstr("$MeshFormat"));
  EXPECT_THAT(refusal(""), HasSubstr("empty"));
  EXPECT_THAT(refusal("$MeshFormat\n4.1 0 4\n$EndMeshFormat\n"), HasSubstr("8 (bytes a number)"));
  EXPECT_THAT(refusal(std::string("$MeshFormat\n4.1 1 8\n\7\0\0\0\n$EndMeshFormat\n", 40)),
              HasSubstr("byte order"));
}

TEST(Msh, FilesThatCannotBeReadAreAnotherKindOfError) {
  EXPECT_THAT(error_of([] { read_msh(folder / "none.msh"); }, Error::Kind::file),
              AllOf(HasSubstr("none.msh"), HasSubstr("No such file")));
  EXPECT_THAT(error_of([] { read_msh(folder); }, Error::Kind::file), HasSubstr("is a folder"));
}

TEST(Msh, HugeCountsAreRefusedBeforeTheMemoryIsAskedFor) {
  for (const char* count : {"2000000000", "100000"}) {
    EXPECT_THAT(refusal(replaced(bytes_of("ascii22.msh"), "$Nodes\n16", std::string("$Nodes\n") + count)),
                AllOf(HasSubstr("m.msh:11:"), HasSubstr(count), HasSubstr("cut short")));
    EXPECT_THAT(
        refusal(replaced(bytes_of("binary22.msh"), "$Elements\n27", std::string("$Elements\n") + count)),
        HasSubstr(count));
  }
  EXPECT_THAT(refusal(replaced(bytes_of("ascii41.msh"), "2 1 0 6", "2 1 0 9223372036854775807")),
              HasSubstr("cut short"));
  EXPECT_THAT(refusal(replaced(bytes_of("ascii41.msh"), "2 1 0 6", "2 1 0 -1")), HasSubstr("negative"));
  EXPECT_THAT(refusal(replaced(bytes_of("ascii41.msh"), "2 1 0 6", "2 1 0 99999999999999999999")),
              HasSubstr("whole number"));
}

TEST(Msh, TagsMustExistOnce) {
  const std::string text = bytes_of("ascii22.msh");
  EXPECT_THAT(refusal(replaced(text, "\n16 0.01", "\n15 0.01")), HasSubstr("node tag 15 is there twice"));
  EXPECT_THAT(refusal(replaced(text, "8 2 2 20 1 1 6 14", "8 2 2 20 1 1 6 77")),
              AllOf(HasSubstr("triangle with tag 8"), HasSubstr("no node with tag 77")));
  EXPECT_THAT(refusal(replaced(text, "1 1 2 12 2 2 3", "1 1 2 12 2 2 88")), HasSubstr("no node with tag 88"));
}

TEST(Msh, NodesWithoutATriangleAreNamedByTheirTag) {
  std::string text = replaced(bytes_of("ascii22.msh"), "$Nodes\n16", "$Nodes\n17");
  text = replaced(text, "$EndNodes", "40 0.5 0.25 0\n$EndNodes");
  EXPECT_THAT(refusal(text),
              AllOf(HasSubstr("node tag 40"), HasSubstr("(0.5, 0.25)"), HasSubstr("no triangle")));
  EXPECT_THAT(refusal(replaced(text, "1 1 2 12 2 2 3", "1 1 2 12 2 2 40")), HasSubstr("node tag 40"));
}

TEST(Msh, MeshesThatAreNotFlatAreRefused) {
  const std::string text = bytes_of("ascii22.msh");
  EXPECT_THAT(refusal(replaced(text, "3 0.06 0.02 0", "3 0.06 0.02 0.01")),
              AllOf(HasSubstr("not flat"), HasSubstr("node tag 3"), HasSubstr("z = 0.01")));
  EXPECT_NO_THROW(parse_msh(replaced(text, "3 0.06 0.02 0", "3 0.06 0.02 1e-13"), "m"));
  EXPECT_THAT(refusal(replaced(text, "3 0.06 0.02 0", "3 0.06 0.02 nan")), HasSubstr("finite"));
  EXPECT_THAT(refusal(replaced(text, "3 0.06 0.02 0", "3 0.06 up 0")),
              AllOf(HasSubstr("m.msh:14:"), HasSubstr("\"up\"")));
}

TEST(Msh, CountsThatDoNotFitTheContentsAreRefused) {
  EXPECT_THAT(refusal(replaced(bytes_of("ascii22.msh"), "$Nodes\n16", "$Nodes\n15")), HasSubstr("$EndNodes"));
  EXPECT_THAT(refusal("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"), HasSubstr("without $Nodes"));
  EXPECT_THAT(
      refusal("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n$Elements\n0\n$EndElements\n"),
      HasSubstr("no triangles"));
  EXPECT_THAT(refusal(bytes_of("ascii22.msh") + "junk"), HasSubstr("junk"));
}

TEST(Msh, PartitionsAreRefusedByName) {
  const std::string text = replaced(bytes_of("ascii41.msh"), "$Nodes",
                                    "$PartitionedEntities\n2\n0\n$EndPartitionedEntities\n$Nodes");
  EXPECT_THAT(refusal(text), HasSubstr("save it in one piece"));
}

TEST(Msh, UnknownSectionsArePassedOver) {
  const std::string section = "$Comments\nanything $ at all\n$EndComments\n";
  for (const char* name : {"ascii22.msh", "binary41.msh"}) {
    const std::string text = replaced(bytes_of(name), "$Nodes", section + "$Nodes");
    EXPECT_EQ(parse_msh(text, name).triangles, read_msh(folder / name).triangles);
  }
}

}  // namespace
}  // namespace rheo
