// A scene from a stranger reads what lies beside or below itself, and nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "io_error_of.hpp"
#include "rheo/io/scene_file.hpp"

namespace rheo {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::error_of;
using testing::fresh_folder;
using ::testing::HasSubstr;
using testing::read_text;
using ::testing::StartsWith;
using testing::write_text;

constexpr const char* material =
    "[material]\nlambda_ela = 7\nmu_ela = 5\nlambda_vis = 4\nmu_vis = 2\ndensity = 0.2\n";
constexpr const char* rectangle = "[mesh]\nshape = \"rectangle\"\nsize = [1, 1]\nnodes = [2, 2]\n";
constexpr const char* duration = "[time]\nduration = 1\n";
constexpr const char* in_quotes = "\"";

std::string data(const std::string& file) {
  return "[material]\nrelaxation = " + (in_quotes + file + in_quotes) + "\npoisson = 0.3\ndensity = 1\n";
}

// One scene for each key that names a file.
struct Way {
  const char* name;
  const char* file;  // of the right kind
  std::string (*scene)(const std::string& file);
};

void PrintTo(const Way& way, std::ostream* out) {
  *out << way.name;
}

const Way ways[] = {
    {"Mesh", "m.msh",
     [](const std::string& file) {
       return "[mesh]\nfile = " + (in_quotes + file + in_quotes) + "\n" + material + duration;
     }},
    {"Keys", "k.csv",
     [](const std::string& file) {
       return std::string(rectangle) + material +
              "[[move]]\nedges = \"left\"\nkeys = " + (in_quotes + file + in_quotes) + "\n" + duration;
     }},
    {"Loads", "k.csv",
     [](const std::string& file) {
       return std::string(rectangle) + material +
              "[[traction]]\nedges = \"left\"\nkeys = " + (in_quotes + file + in_quotes) + "\n" + duration;
     }},
    {"Data", "d.csv", [](const std::string& file) { return rectangle + data(file) + duration; }},
    {"Sweep", "s.csv",
     [](const std::string& file) {
       return std::string(rectangle) + "[material]\nfrequency = " + (in_quotes + file + in_quotes) +
              "\npoisson = 0.3\ndensity = 1\n" + duration;
     }},
    {"Region", "d.csv",
     [](const std::string& file) {
       return std::string(rectangle) + material + "[[region]]\ndisk = [0.3, 0.3, 0.1]\n[region.material]\n" +
              "relaxation = " + (in_quotes + file + in_quotes) + "\npoisson = 0.3\ndensity = 1\n" + duration;
     }},
    {"Body", "m.msh", [](const std::string& file) {
       return "[[body]]\nmesh = {file = " + (in_quotes + file + in_quotes) +
              "}\nmaterial = {lambda_ela = 7, mu_ela = 5, lambda_vis = 4, mu_vis = 2, density = 1}\n" +
              duration;
     }}};

// top/secret holds the files; top/scene/below too. The scene lies in top/scene.
class FilesOfAScene : public ::testing::TestWithParam<Way> {
 protected:
  void SetUp() override {
    top_ = fresh_folder(std::string("files_") + GetParam().name);
    for (const char* folder : {"secret", "scene/below", "scenery"}) {
      fs::create_directories(top_ / folder);
      write_text(top_ / folder / "m.msh", read_text(fs::path(RHEO_TEST_DATA) / "msh" / "ascii22.msh"));
      write_text(top_ / folder / "k.csv", "0,0,0\n1,0.1,0\n");
      write_text(top_ / folder / "d.csv", "0,10\n1,8\n2,7\n5,6\n");
      write_text(top_ / folder / "s.csv", "0.1,10,1\n1,18,3\n10,27,1\n");
    }
  }

  Scene read(const std::string& file, OutsideFiles outside = OutsideFiles::refused) const {
    write_text(top_ / "scene" / "s.toml", GetParam().scene(file));
    return read_scene(top_ / "scene" / "s.toml", {.outside = outside});
  }
  void expect_refused(const std::string& file) const {
    EXPECT_THAT(error_of([&] { read(file); }),
                AllOf(HasSubstr(file), HasSubstr("leads to "), HasSubstr("out of the scene's folder"),
                      HasSubstr("--allow-outside")));
    EXPECT_EQ(read(file, OutsideFiles::allowed).files.size(), 1u);
  }

  const std::string file_ = GetParam().file;
  fs::path top_;
};

TEST_P(FilesOfAScene, LieBesideOrBelowIt) {
  EXPECT_EQ(read("below/" + file_).files.size(), 1u);
  EXPECT_EQ(read("./below/../below/" + file_).files.size(), 1u);
  EXPECT_EQ(read((top_ / "scene" / "below" / file_).string()).files.size(), 1u);
  EXPECT_EQ(read("../scene/below/" + file_).files.size(), 1u);
}

TEST_P(FilesOfAScene, AreRefusedOutside) {
  expect_refused("../secret/" + file_);
  expect_refused("below/../../secret/" + file_);
  expect_refused((top_ / "secret" / file_).string());
  expect_refused("../scenery/" + file_);  // begins with the folder's name
}

TEST_P(FilesOfAScene, AreRefusedWhereALinkLeadsOut) {
  fs::create_symlink(top_ / "secret" / file_, top_ / "scene" / "link");
  fs::create_directory_symlink("../secret", top_ / "scene" / "folder");
  fs::create_symlink("below/" + file_, top_ / "scene" / "inner");
  expect_refused("link");
  expect_refused("folder/" + file_);
  EXPECT_EQ(read("inner").files.size(), 1u);
}

TEST_P(FilesOfAScene, AreNoDevicesAndNoPipes) {
  ASSERT_EQ(mkfifo((top_ / "scene" / "pipe").c_str(), 0600), 0);
  for (const OutsideFiles outside : {OutsideFiles::refused, OutsideFiles::allowed}) {
    // Opening it would wait for ever.
    EXPECT_THAT(error_of([&] { read("pipe", outside); }),
                AllOf(HasSubstr("pipe"), HasSubstr("a regular file is needed")));
  }
  EXPECT_THAT(error_of([&] { read("/dev/zero", OutsideFiles::allowed); }), HasSubstr("device"));
  EXPECT_THAT(error_of([&] { read("/dev/zero"); }), HasSubstr("--allow-outside"));
}

INSTANTIATE_TEST_SUITE_P(By, FilesOfAScene, ::testing::ValuesIn(ways),
                         [](const auto& suite) { return std::string(suite.param.name); });

TEST(FilesOfASceneText, StartAtItsFolder) {
  const fs::path top = fresh_folder("files_text");
  write_text(top / "k.csv", "0,0,0\n1,0.1,0\n");
  const auto read = [&](const std::string& file, const fs::path& folder) {
    return parse_scene(ways[1].scene(file), "s.toml", folder);
  };
  EXPECT_EQ(read("k.csv", top).files.size(), 1u);
  EXPECT_EQ(read("k.csv", top.string() + "/").files.size(), 1u);
  EXPECT_EQ(read("k.csv", top / "." / ".." / top.filename()).files.size(), 1u);
  EXPECT_THAT(error_of([&] { read("none.csv", top); }, Error::Kind::file), HasSubstr("No such file"));
  EXPECT_THAT(error_of([&] { read(std::string(5000, 'x'), top); }, Error::Kind::file),
              StartsWith("s.toml:13: [[move]] keys"));
  EXPECT_THAT(error_of([&] { read("k.csv\\u0000", top); }), HasSubstr("control character"));
  EXPECT_THAT(error_of([&] { read("k\\n.csv", top); }), HasSubstr("control character"));
  EXPECT_THAT(error_of([&] { read("/etc/passwd", {}); }), HasSubstr("--allow-outside"));
}

}  // namespace
}  // namespace rheo
