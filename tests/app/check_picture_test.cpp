// The pictures of check --plot: their curves are where the tables' numbers are.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "program.hpp"
#include "render/decode.hpp"

namespace app_tests {
namespace {

using testing::HasSubstr;

// The first series' blue, the second one's vermilion.
using Colour = std::function<bool(int r, int g, int b)>;
bool blue(int r, int g, int b) {
  return b > r + 90 && b > g + 30;  // the third one's green has the first of it too
}
bool vermilion(int r, int, int b) {
  return r > b + 120;
}

class CheckPicture : public ProgramTest {
 protected:
  void draw(const std::string& text) {
    write("scene.toml", text);
    finished_ = rheo({"check", "scene.toml", "--plot", "-o", "m", "--size", "960x540"});
    ASSERT_EQ(finished_.exit_code, 0) << finished_.err;
  }

  void open(const std::string& name) {
    image_ = read_png(folder() / "m" / name);
    ASSERT_EQ(image_.width, 960) << name;
    ASSERT_EQ(image_.height, 540);
  }

  bool is(const Colour& colour, int x, int y) const {
    const auto i = 4 * static_cast<std::size_t>(y * image_.width + x);
    return colour(image_.rgba[i], image_.rgba[i + 1], image_.rgba[i + 2]);
  }

  // The middle of a column's pixels of that colour below the legend; -1: none.
  double height_at(const Colour& colour, int x) const {
    constexpr int below_legend = 75;
    int first = -1, last = -1;
    for (int y = below_legend; y < image_.height; ++y) {
      if (!is(colour, x, y)) continue;
      if (first < 0) first = y;
      last = y;
    }
    return first < 0 ? -1.0 : 0.5 * (first + last);
  }

  // A solid curve over a logarithmic axis that it fills: every tenth column's height is that of the value.
  void expect_curve(const Colour& colour, const std::vector<double>& x, const std::vector<double>& y) const {
    int x0 = -1, x1 = -1;
    for (int column = 0; column < image_.width; ++column) {
      if (height_at(colour, column) < 0.0) continue;
      if (x0 < 0) x0 = column;
      x1 = column;
    }
    ASSERT_GT(x1 - x0, 700);
    const double y0 = height_at(colour, x0 + 1), y1 = height_at(colour, x1 - 1);
    ASSERT_GT(std::abs(y1 - y0), 100.0);
    for (int column = x0 + 10; column < x1 - 10; column += 10) {
      const double at = std::log(x.front()) + (column - x0) * std::log(x.back() / x.front()) / (x1 - x0);
      std::size_t i = 1;
      while (i + 1 < x.size() && std::log(x[i]) < at) ++i;
      const double share = (at - std::log(x[i - 1])) / std::log(x[i] / x[i - 1]);
      const double value = std::log(y[i - 1]) + share * std::log(y[i] / y[i - 1]);
      const double expected = y0 + (y1 - y0) * (value - std::log(y.front())) / std::log(y.back() / y.front());
      EXPECT_NEAR(height_at(colour, column), expected, 2.5)
          << "column " << column;  // a line is 3 pixels wide
    }
  }

  Finished finished_;
  render::Image image_;
};

TEST_F(CheckPicture, RelaxationIsTheTablesCurve) {
  draw(small_beam_with("density = 0.2", "density = 0.2\n[material.elastic]\nlambda = 0.3\nmu = 0.25"));
  open("relaxation.png");
  auto table = read_table(folder() / "m/relaxation.csv");
  for (auto& [name, column] : table) column.erase(column.begin());  // t = 0 is on no logarithmic axis
  expect_curve(blue, table["t"], table["r_lambda"]);
}

TEST_F(CheckPicture, ModuliAreTheTablesCurves) {
  draw(small_beam_with("density = 0.2", "density = 0.2\n[material.elastic]\nlambda = 0.3\nmu = 0.25"));
  open("moduli.png");
  auto table = read_table(folder() / "m/moduli.csv");
  expect_curve(blue, table["frequency"], table["lambda_storage"]);
}

TEST_F(CheckPicture, FitHasADiskForEveryPointOnTheFittedCurve) {
  std::string csv;
  for (int i = 0; i < 12; ++i) {
    const double t = 0.1 * std::pow(10.0, i / 4.0);
    csv += fmt::format("{:.17g},{:.17g}\n", t, 100.0 * std::exp(-t / 2.0) + 20.0);
  }
  write("gel.csv", csv);
  draw(small_beam_with("lambda_ela = 7.0\nmu_ela = 5.0\nlambda_vis = 4.0\nmu_vis = 2.0",
                       "relaxation = \"gel.csv\"\npoisson = 0.25"));
  open("fit.png");
  // Disks are connected columns of vermilion, with the blue curve in between.
  int disks = 0, blue_between = 0;
  bool inside = false;
  for (int x = 0; x < image_.width; ++x) {
    const bool disk = height_at(vermilion, x) >= 0.0;
    if (disk && !inside) ++disks;
    if (!disk && height_at(blue, x) >= 0.0) ++blue_between;
    inside = disk;
  }
  EXPECT_EQ(disks, 12);
  EXPECT_GT(blue_between, 500);
}

TEST_F(CheckPicture, OfNothingIsLeftOut) {
  draw(small_beam_with("lambda_ela = 7.0\nmu_ela = 5.0\nlambda_vis = 4.0\nmu_vis = 2.0",
                       "preset = \"plastic\"\nlambda_viscous = 4\nmu_viscous = 2"));
  EXPECT_THAT(finished_.out, HasSubstr("note: no relaxation.png: "));
  EXPECT_FALSE(fs::exists(folder() / "m/relaxation.png"));
  EXPECT_TRUE(fs::exists(folder() / "m/moduli.png"));
  EXPECT_FALSE(fs::exists(folder() / "m/fit.png"));
}

}  // namespace
}  // namespace app_tests
