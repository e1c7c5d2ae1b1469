// Result files read back: state.csv to the last bit, .vtu by meshio.
#include "rheo/io/results.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "io_error_of.hpp"
#include "rheo/deformation.hpp"
#include "rheo/shapes.hpp"

namespace rheo {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using testing::fresh_folder;
using ::testing::HasSubstr;
using testing::read_text;
using ::testing::StartsWith;

struct Sample {
  Mesh mesh = disk(0.03, 3);
  std::vector<double> u, v, w_lambda, w_mu;

  Sample() {
    const auto fill = [&](std::vector<double>& block, double phase, double size) {
      for (std::size_t i = 0; i < 2 * mesh.points.size(); ++i) {
        block.push_back(size * std::sin(phase + 0.7 * static_cast<double>(i)));
      }
    };
    fill(u, 0.1, 1e-3);
    fill(v, 0.2, 0.3);
    fill(w_lambda, 0.3, 1234.5);
    fill(w_mu, 0.4, 1e-300);
  }
  StateView view() const { return {u, v, w_lambda, w_mu}; }
};

TEST(StateCsv, HoldsEveryNumberToTheLastBit) {
  const Sample sample;
  const fs::path file = fresh_folder("state") / "state.csv";
  write_state_csv(file, sample.mesh, sample.view());
  std::istringstream lines(read_text(file));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(line, "node,x,y,ux,uy,vx,vy,w_lambda_x,w_lambda_y,w_mu_x,w_mu_y");
  for (std::size_t i = 0; i < sample.mesh.points.size(); ++i) {
    ASSERT_TRUE(std::getline(lines, line));
    std::istringstream fields(line);
    std::string field;
    std::vector<double> numbers;
    while (std::getline(fields, field, ',')) numbers.push_back(std::strtod(field.c_str(), nullptr));
    EXPECT_THAT(numbers, ::testing::ElementsAre(static_cast<double>(i), sample.mesh.points[i].x,
                                                sample.mesh.points[i].y, sample.u[2 * i], sample.u[2 * i + 1],
                                                sample.v[2 * i], sample.v[2 * i + 1], sample.w_lambda[2 * i],
                                                sample.w_lambda[2 * i + 1], sample.w_mu[2 * i],
                                                sample.w_mu[2 * i + 1]));
  }
  EXPECT_FALSE(std::getline(lines, line));
}

TEST(StateCsv, EndsWithTheBodysNumberWhereThereAreSeveral) {
  const Sample sample;
  const auto nodes = static_cast<std::int32_t>(sample.mesh.points.size());
  const std::vector<BodyPart> bodies{{"a", 0, 7, 0, 6}, {"b", 7, nodes - 7, 6, 1}};
  const fs::path file = fresh_folder("state_bodies") / "state.csv";
  write_state_csv(file, sample.mesh, sample.view(), {bodies, {}});
  std::istringstream lines(read_text(file));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(line, "node,x,y,ux,uy,vx,vy,w_lambda_x,w_lambda_y,w_mu_x,w_mu_y,body");
  for (std::int32_t i = 0; i < nodes; ++i) {
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(line.substr(line.rfind(',')), i < 7 ? ",1" : ",2") << "node " << i;
  }
}

TEST(Results, NameThePathThatCannotBeWritten) {
  const Sample sample;
  const fs::path file = fresh_folder("results_bad") / "none" / "x";
  const auto message = [&](auto write) { return error_of(write, Error::Kind::file); };
  EXPECT_THAT(message([&] { write_state_csv(file, sample.mesh, sample.view()); }), StartsWith(file.string()));
  EXPECT_THAT(message([&] { write_vtu(file, sample.mesh, sample.view()); }), StartsWith(file.string()));
  EXPECT_THAT(message([&] { write_pvd(file, {}); }), StartsWith(file.string()));
}

TEST(Pvd, ListsTimesAndEscapedNames) {
  const fs::path file = fresh_folder("pvd") / "series.pvd";
  write_pvd(file, {{0.0, "vtu/a.vtu"}, {0.1, "vtu/b&c<\">.vtu"}});
  const std::string text = read_text(file);
  EXPECT_THAT(text, HasSubstr("timestep=\"0\" part=\"0\" file=\"vtu/a.vtu\""));
  EXPECT_THAT(
      text, HasSubstr("timestep=\"0.10000000000000001\" part=\"0\" file=\"vtu/b&amp;c&lt;&quot;&gt;.vtu\""));
}

// Another program's reader finds the numbers that were written.
TEST(Vtu, IsReadByMeshio) {
  const std::string python = "/usr/bin/python3";
  if (std::system((python + " -c 'import meshio, xml.dom.minidom' 2>/dev/null").c_str()) != 0) {
    GTEST_SKIP() << "python3-meshio is not installed";
  }
  const Sample sample;
  const fs::path folder = fresh_folder("vtu");
  const auto nodes = static_cast<std::int32_t>(sample.mesh.points.size());
  const auto triangles = static_cast<std::int32_t>(sample.mesh.triangles.size());
  const std::vector<BodyPart> bodies{{"a", 0, 7, 0, 6}, {"b", 7, nodes - 7, 6, triangles - 6}};
  std::vector<std::int32_t> regions(sample.mesh.triangles.size(), 0);
  regions[2] = 1;
  write_vtu(folder / "a.vtu", sample.mesh, sample.view(), {bodies, regions});
  testing::write_text(folder / "read.py", R"(
import sys, xml.dom.minidom, meshio
xml.dom.minidom.parse(sys.argv[1])
m = meshio.read(sys.argv[1])
assert len(m.cells) == 1 and m.cells[0].type == "triangle"
assert sorted(m.point_data) == ["u", "v", "w_lambda", "w_mu"]
assert sorted(m.cell_data) == ["body", "region", "strain", "stress"]
def show(rows):
    for row in rows: print(" ".join(repr(float(x)) for x in row))
show(m.points); show(m.cells[0].data)
for name in ["u", "v", "w_lambda", "w_mu"]: show(m.point_data[name])
for name in ["strain", "stress"]: show(m.cell_data[name][0])
for name in ["body", "region"]: show([[x] for x in m.cell_data[name][0]])
)");
  const std::string command = fmt::format("{} '{}' '{}' > '{}' 2>&1", python, (folder / "read.py").string(),
                                          (folder / "a.vtu").string(), (folder / "out.txt").string());
  ASSERT_EQ(std::system(command.c_str()), 0) << read_text(folder / "out.txt");

  std::vector<double> expected;
  for (const Vec2 p : sample.mesh.points) expected.insert(expected.end(), {p.x, p.y, 0.0});
  for (const Triangle& t : sample.mesh.triangles) expected.insert(expected.end(), t.begin(), t.end());
  for (const auto* block : {&sample.u, &sample.v, &sample.w_lambda, &sample.w_mu}) {
    for (std::size_t i = 0; i < block->size(); i += 2)
      expected.insert(expected.end(), {(*block)[i], (*block)[i + 1], 0.0});
  }
  std::vector<double> tensor(3 * sample.mesh.triangles.size());
  strain(sample.mesh, sample.u, tensor);
  expected.insert(expected.end(), tensor.begin(), tensor.end());
  stress(sample.mesh, sample.w_lambda, sample.w_mu, tensor);
  expected.insert(expected.end(), tensor.begin(), tensor.end());

  for (std::int32_t t = 0; t < triangles; ++t) expected.push_back(t < 6 ? 1.0 : 2.0);
  expected.insert(expected.end(), regions.begin(), regions.end());

  std::istringstream words(read_text(folder / "out.txt"));
  std::vector<double> found;
  for (std::string word; words >> word;) found.push_back(std::strtod(word.c_str(), nullptr));
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace rheo
