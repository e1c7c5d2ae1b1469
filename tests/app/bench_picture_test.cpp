// bench.png: its marks are where the table's numbers are.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "render/decode.hpp"

namespace app_tests {
namespace {

struct Mark {
  std::string integrator;
  double error = 0.0, seconds = 0.0;
};

std::vector<Mark> marks_of(const fs::path& report) {
  std::vector<Mark> marks;
  const auto json = nlohmann::json::parse(read_text(report));
  for (const auto& run : json["runs"]) {
    std::vector<double> seconds = run["seconds"];
    std::sort(seconds.begin(), seconds.end());
    const std::size_t half = seconds.size() / 2;
    marks.push_back({run["integrator"], run["error"],
                     seconds.size() % 2 == 1 ? seconds[half] : 0.5 * (seconds[half - 1] + seconds[half])});
  }
  return marks;
}

class BenchPicture : public ProgramTest {};

TEST_F(BenchPicture, HasTheMarksWhereTheDataIs) {
  write("beam.toml", small_beam());
  const Finished finished = rheo({"bench", "beam.toml", "-o", "b", "--budget", "5", "--size", "1280x720"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const render::Image image = read_png(folder() / "b/bench.png");
  ASSERT_EQ(image.width, 1280);
  ASSERT_EQ(image.height, 720);
  // Colours of the first three curves: blue, vermilion, green.
  const auto coloured = [&](int x, int y) {
    const auto i = 4 * static_cast<std::size_t>(y * image.width + x);
    const int r = image.rgba[i], g = image.rgba[i + 1], b = image.rgba[i + 2];
    return b > r + 90 || r > b + 120 || (g > r + 90 && g > b + 20);
  };
  // Below the legend: the curves, which reach from the first to the last mark in both directions.
  constexpr int top = 82;
  int x0 = image.width, x1 = -1, y0 = image.height, y1 = -1;
  for (int y = top; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (coloured(x, y)) {
        x0 = std::min(x0, x), x1 = std::max(x1, x);
        y0 = std::min(y0, y), y1 = std::max(y1, y);
      }
  const std::vector<Mark> marks = marks_of(folder() / "b/run.json");
  ASSERT_GE(marks.size(), 10u);
  double least_error = INFINITY, most_error = 0.0, least_seconds = INFINITY, most_seconds = 0.0;
  for (const Mark& mark : marks) {
    least_error = std::min(least_error, mark.error), most_error = std::max(most_error, mark.error);
    least_seconds = std::min(least_seconds, mark.seconds),
    most_seconds = std::max(most_seconds, mark.seconds);
  }
  constexpr double radius = 4.2;
  EXPECT_GT(x1 - x0, 900);
  EXPECT_GT(y1 - y0, 350);
  for (const Mark& mark : marks) {
    const double fx = std::log(mark.error / least_error) / std::log(most_error / least_error);
    const double fy = std::log(mark.seconds / least_seconds) / std::log(most_seconds / least_seconds);
    const int x = static_cast<int>(std::lround(x0 + radius + fx * (x1 - x0 - 2 * radius)));
    const int y = static_cast<int>(std::lround(y1 - radius - fy * (y1 - y0 - 2 * radius)));
    // A whole disk: a line alone is three pixels wide.
    for (const auto& [dx, dy] : {std::pair{0, 0}, {2, 0}, {-2, 0}, {0, 2}, {0, -2}})
      EXPECT_TRUE(coloured(x + dx, y + dy))
          << mark.integrator << " " << mark.error << " at " << x << ", " << y;
  }
}

TEST_F(BenchPicture, AMachineThatCannotDrawStillMakesTheTable) {
  write("beam.toml", small_beam());
  // No driver is found there.
  const Finished finished =
      rheo({"bench", "beam.toml", "-o", "b", "--budget", "2", "--backend", "egl"},
           {{"__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere.json"}, {"LIBGL_DRIVERS_PATH", "/nowhere"}});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, testing::HasSubstr("note: no picture: "));
  EXPECT_THAT(files(), testing::ElementsAre("b", "b/bench.csv", "b/run.json", "beam.toml"));
}

}  // namespace
}  // namespace app_tests
