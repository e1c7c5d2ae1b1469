// Scenes from a stranger: too much is refused with an estimate and the limit, other people's files are not
// read. All of it within 4 GB of address space, where the system would end what it cannot give.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <fstream>

#include "program.hpp"

namespace app_tests {
namespace {

using testing::HasSubstr;
using testing::Not;

class Hostile : public ProgramTest {
 protected:
  // Runs in the test's folder, with `ulimit -v` where no sanitizer reserves more than any limit.
  Finished confined(const std::string& arguments) const {
#if defined(RHEO_SANITIZE_ADDRESS)
    const std::string limit;
#else
    const std::string limit = "ulimit -v 4000000 && ";
#endif
    const std::string command = "cd '" + folder().string() + "' && " + limit + "'" RHEO_PROGRAM "' " +
                                arguments + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    Finished finished{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder() / "out.txt"),
                      read_text(folder() / "err.txt")};
    fs::remove(folder() / "out.txt");
    fs::remove(folder() / "err.txt");
    return finished;
  }
  // By check and render alike; nothing is made.
  void expect_refused(const std::string& scene, const std::vector<std::string>& parts,
                      const std::string& options = {}) const {
    write("scene.toml", scene);
    for (const char* command : {"check", "render"}) {
      const Finished finished = confined(fmt::format("{} scene.toml {}", command, options));
      expect_failure(finished, 2, parts);
      EXPECT_FALSE(fs::exists(folder() / "out"));
    }
  }
};

TEST_F(Hostile, MeshOfTooManyNodes) {
  expect_refused(small_beam_with("nodes = [5, 2]", "nodes = [1000000, 1000000]"),
                 {"scene.toml:6: [mesh] nodes", "1e+12 nodes need about 1.4e+05 GB", "--memory-limit"});
  const std::string many = small_beam_with("nodes = [5, 2]", "nodes = [1000, 1000]");
  expect_refused(many, {"1e+06 nodes need about 140 MB of memory, the limit is 100 MB", "--memory-limit"},
                 "--memory-limit 0.1");
  expect_refused(many, {"1000000 nodes need about ", "the limit is 500 MB", "--memory-limit"},
                 "--memory-limit 0.5");
}

TEST_F(Hostile, TooManyOutputs) {
  expect_refused(
      small_beam_with("frame_rate = 20", "frame_rate = 2e9"),
      {"[time] frame_rate", "1e+09 outputs in 0.5 s, 300 GB of memory", "1e+07", "--output-limit"});
  write("scene.toml", small_beam());
  expect_failure(confined("run scene.toml --frame-rate 2e9"), 2,
                 {"--frame-rate '2e9': 1e+09 outputs", "300 GB", "1e+07", "--output-limit"});
  expect_failure(confined("render scene.toml --frame-rate 2e9 --output-limit 2e9 --memory-limit 3"), 2,
                 {"GB of memory, the limit is 3 GB", "--frame-rate", "--memory-limit"});
  EXPECT_EQ(confined("run scene.toml --output-limit 9 -o r").exit_code, 2);
  EXPECT_EQ(confined("run scene.toml --output-limit 10 -o r").exit_code, 0);
}

TEST_F(Hostile, TooLargePictures) {
  expect_refused(small_beam_with("size = [320, 180]", "size = [100000, 100000]"),
                 {"[render] size = [100000, 100000]: about 480 GB", "16384"});
  write("scene.toml", small_beam());
  expect_failure(confined("render scene.toml --size 100000x100000"), 2,
                 {"--size '100000x100000'", "240x160 to 16384x16384", "480 GB"});
  expect_failure(confined("render scene.toml --size 16384x16384 --memory-limit 2"), 2,
                 {"need about 1", "the limit is 2 GB", "--size", "--memory-limit"});
}

TEST_F(Hostile, MeshFilesThatPromiseTooMuch) {
  const std::string scene =
      small_beam_with("shape = \"rectangle\"\nsize = [1.0, 0.25]\nnodes = [5, 2]", "file = \"bomb.msh\"");
  write(
      "bomb.msh",
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1152921504606846976 1 1152921504606846976\n2 1 0 1\n");
  expect_refused(scene, {"bomb.msh:5:", "1152921504606846976", "cannot hold so many"});
  write("bomb.msh", "$MeshFormat\n");
  fs::resize_file(folder() / "bomb.msh", std::uintmax_t{1} << 32);  // a hole: no disk is used
  expect_refused(scene, {"bomb.msh", "bytes need about 4.29 GB", "--memory-limit"}, "--memory-limit 2");
}

TEST_F(Hostile, DeepNesting) {
  for (const std::string& deep :
       {std::string(1'000'000, '['), std::string(1'000'000, '{'), std::string(2'000'000, '.')}) {
    expect_refused("a = " + deep, {"scene.toml:1: ", "more than 32"});
  }
}

TEST_F(Hostile, AMillionConstraints) {
  std::string constraints;
  for (int i = 0; i < 1'000'000; ++i) constraints += "[[constraint]]\nterms=[[0,\"x\",1]]\n";
  expect_refused(small_beam() + constraints, {"values need about 2.", "the limit is 1 GB", "--memory-limit"},
                 "--memory-limit 1");
}

TEST_F(Hostile, ConstraintsThatAllMeet) {
  std::string constraints;
  for (int i = 0; i < 20'000; ++i)
    constraints += fmt::format("[[constraint]]\nterms=[[0,\"x\",1],[{},\"y\",{}]]\n", i % 8, i + 1);
  expect_refused(small_beam() + constraints,
                 {"20000 general constraints need about", "take fewer", "--memory-limit"},
                 "--memory-limit 2");
}

TEST_F(Hostile, TooManyKeysAndShapes) {
  std::string keys;
  for (int i = 0; i < 300'000; ++i) keys += fmt::format("[{},0,0],\n", i);
  write("scene.toml", small_beam() + "[[move]]\nedges = \"left\"\nkeys = [" + keys + "]\n");
  expect_failure(confined("check scene.toml --memory-limit 0.2"), 2,
                 {"values need about", "the limit is 200 MB", "--memory-limit"});
  std::ofstream table(folder() / "keys.csv");
  for (int i = 0; i < 1'000'000; ++i) table << i << ",0,0\n";
  table.close();
  write("scene.toml", small_beam() + "[[move]]\nedges = \"left\"\nkeys = \"keys.csv\"\n");
  expect_failure(confined("check scene.toml --memory-limit 0.1"), 2,
                 {"[[move]] keys", "rows need about", "the limit is 100 MB", "--memory-limit"});
}

TEST_F(Hostile, FilesOutside) {
  fs::create_directories(folder() / "scenes");
  const std::string scene =
      small_beam_with("shape = \"rectangle\"\nsize = [1.0, 0.25]\nnodes = [5, 2]", "file = \"../m.msh\"");
  fs::copy_file(fs::path(RHEO_SOURCE_DIR) / "tests" / "data" / "msh" / "ascii22.msh", folder() / "m.msh");
  write("scenes/scene.toml", scene);
  for (const char* command : {"check", "run", "render", "bench", "view"}) {
    expect_failure(confined(fmt::format("{} scenes/scene.toml", command)), 2,
                   {"scenes/scene.toml:", "[mesh] file = \"../m.msh\"", "leads to", "--allow-outside"});
  }
  // Gets as far as the mesh itself.
  EXPECT_THAT(confined("check scenes/scene.toml --allow-outside").err, Not(HasSubstr("leads to")));
  ASSERT_EQ(mkfifo((folder() / "scenes" / "m.msh").c_str(), 0600), 0);
  write("scenes/scene.toml",
        small_beam_with("shape = \"rectangle\"\nsize = [1.0, 0.25]\nnodes = [5, 2]", "file = \"m.msh\""));
  expect_failure(confined("check scenes/scene.toml --allow-outside"), 2,
                 {"[mesh] file = \"m.msh\"", "a device or a pipe"});
}

TEST_F(Hostile, LimitsAreNumbers) {
  write("scene.toml", small_beam());
  expect_failure(confined("check scene.toml --memory-limit much"), 2, {"--memory-limit 'much'", "GB"});
  expect_failure(confined("check scene.toml --output-limit 0"), 2, {"--output-limit '0'"});
}

}  // namespace
}  // namespace app_tests
