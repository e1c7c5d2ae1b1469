#include "render/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "render/context.hpp"
#include "support.hpp"

namespace {

using render::Image;
using support::at;
using support::Box;
using support::Pixel;

constexpr int width = 640, height = 360;
const double nan = std::numeric_limits<double>::quiet_NaN();

// The first series' blue, the second one's vermilion.
bool blue(const Pixel& p) {
  return p[2] > p[0] + 90;
}
bool vermilion(const Pixel& p) {
  return p[0] > p[2] + 120;
}

class Plots : public ::testing::Test {
 protected:
  void SetUp() override {
    context_ = support::open(render::Backend::automatic, width, height);
    if (!context_)
      GTEST_SKIP() << "no OpenGL for drawing without a window (libosmesa6, or libegl1 with libgl1-mesa-dri)";
    for (int i = 0; i <= 100; ++i) x_.push_back(i / 100.0);
  }

  render::Plot plot(std::vector<double> y) {
    y_ = std::move(y);
    render::Plot p;
    p.series = {{"", x_, y_}};
    return p;
  }

  Image draw(const render::Plot& p) { return render::draw_plot(*context_, p); }

  std::unique_ptr<render::Context> context_;
  std::vector<double> x_, y_;
};

TEST_F(Plots, ALineRunsFromCornerToCorner) {
  const Image image = draw(plot(x_));
  const Box line = support::find(image, [](int, int, const Pixel& p) { return blue(p); });
  EXPECT_GT(line.width(), 0.8 * width);
  EXPECT_GT(line.height(), 0.7 * height);
  const Box left =
      support::find(image, [&](int x, int, const Pixel& p) { return x < line.x0 + 10 && blue(p); });
  const Box right =
      support::find(image, [&](int x, int, const Pixel& p) { return x > line.x1 - 10 && blue(p); });
  EXPECT_GT(left.y0, right.y1) << "upwards";
  // Straight: the middle of the line is in the middle.
  const Box middle = support::find(
      image, [&](int x, int, const Pixel& p) { return x == (line.x0 + line.x1) / 2 && blue(p); });
  EXPECT_NEAR((middle.y0 + middle.y1) / 2.0, (line.y0 + line.y1) / 2.0, 2);
}

TEST_F(Plots, PointsAloneHaveNoLineBetweenThem) {
  render::Plot p;
  const std::vector<double> two{0.0, 1.0};
  p.series = {{.name = "", .x = two, .y = two, .markers = true, .line = false}};
  const Image image = draw(p);
  const Box marks = support::find(image, [](int, int, const Pixel& pixel) { return blue(pixel); });
  EXPECT_GT(marks.width(), 0.8 * width);
  const Box between = support::find(image, [&](int x, int, const Pixel& pixel) {
    return x > marks.x0 + 20 && x < marks.x1 - 20 && blue(pixel);
  });
  EXPECT_EQ(between.count, 0);
}

TEST_F(Plots, AConstantSeriesIsAFlatLine) {
  for (const double value : {0.0, 3.0, -1e-20, 1e300}) {
    const Image image = draw(plot(std::vector<double>(101, value)));
    const Box line = support::find(image, [](int, int, const Pixel& p) { return blue(p); });
    EXPECT_GT(line.width(), 0.8 * width) << value;
    EXPECT_LE(line.height(), 4) << value;
  }
}

TEST_F(Plots, EmptyAndUnusableSeriesStillGiveAxes) {
  render::Plot empty;
  empty.title = "Nothing";
  empty.x_label = "t [s]";
  empty.y_label = "|w_mu| [Pa m]";
  EXPECT_GT(support::find_difference(draw(empty), draw(render::Plot{})).count, 300) << "title and labels";
  const Image image = draw(plot(std::vector<double>(101, nan)));
  EXPECT_EQ(support::find(image, [](int, int, const Pixel& p) { return blue(p); }).count, 0);
  const Box axes = support::find(image, [](int, int, const Pixel& p) { return p[0] < 140; });
  EXPECT_GT(axes.width(), 0.8 * width);
  EXPECT_GT(axes.height(), 0.7 * height);
}

TEST_F(Plots, ValuesThatAreNotFiniteAreGaps) {
  std::vector<double> y(101, 1.0);
  for (std::size_t i = 40; i < 60; ++i) y[i] = i % 2 ? nan : std::numeric_limits<double>::infinity();
  const Image image = draw(plot(y));
  const Box line = support::find(image, [](int, int, const Pixel& p) { return blue(p); });
  const int quarter = line.width() / 20;
  const int middle = (line.x0 + line.x1) / 2;
  const Box gap = support::find(
      image, [&](int x, int, const Pixel& p) { return std::abs(x - middle) < quarter && blue(p); });
  EXPECT_EQ(gap.count, 0);
}

TEST_F(Plots, LogarithmicAxesMakePowersStraight) {
  std::vector<double> h, e;
  for (int k = 0; k <= 40; ++k) {
    h.push_back(std::pow(10, -4 + 0.1 * k));
    e.push_back(std::pow(h.back(), 4));
  }
  h.push_back(-1);  // no logarithm: left out
  e.push_back(1);
  h.push_back(1);
  e.push_back(0);
  render::Plot p;
  p.x_scale = p.y_scale = render::Scale::log;
  p.series = {{"", h, e}};
  const Image image = draw(p);
  const Box line = support::find(image, [](int, int, const Pixel& q) { return blue(q); });
  const Box middle = support::find(
      image, [&](int x, int, const Pixel& q) { return x == (line.x0 + line.x1) / 2 && blue(q); });
  EXPECT_NEAR((middle.y0 + middle.y1) / 2.0, (line.y0 + line.y1) / 2.0, 2);
}

TEST_F(Plots, SeriesDifferInColourAndTheLegendNamesThem) {
  render::Plot p = plot(x_);
  const std::vector<double> other(101, 0.5);
  p.series.push_back({"", x_, other});
  const Image image = draw(p);
  EXPECT_GT(support::find(image, [](int, int, const Pixel& q) { return vermilion(q); }).count, 300);
  p.series[0].name = "|w_lambda|";
  p.series[1].name = "|w_mu|";
  const Image named = draw(p);
  const Box legend =
      support::find(named, [](int, int y, const Pixel& q) { return y < 40 && (blue(q) || vermilion(q)); });
  EXPECT_GT(legend.count, 60);
}

TEST_F(Plots, EventsAreVerticalLinesInsideOfTheAxes) {
  const Image without = draw(plot(x_));
  render::Plot p = plot(x_);
  p.marks = {0.5, 7.0, nan, -3.0};
  const Box mark = support::find_difference(without, draw(p), 30);
  EXPECT_LE(mark.width(), 3);
  EXPECT_GT(mark.height(), 0.7 * height);
}

// Marks of a log-log picture lie where the logarithms of their values say, clear of the ends of both axes.
TEST_F(Plots, MarkersOnLogarithmicAxesLieAtTheirDecades) {
  const std::vector<double> x{1e-8, 1e-6, 1e-2}, y{1e1, 1e-1, 1e-2};
  render::Plot p;
  p.x_scale = p.y_scale = render::Scale::log;
  for (std::size_t k = 0; k < x.size(); ++k) {  // one point a series: no lines between
    p.series.push_back({"", std::span(x).subspan(k, 1), std::span(y).subspan(k, 1), true});
  }
  const Image image = draw(p);
  const auto green = [](const Pixel& q) { return q[1] > q[0] + 90 && q[1] > q[2] + 20; };
  const Box first =
      support::find(image, [](int, int, const Pixel& q) { return blue(q) && q[2] > q[1] + 30; });
  const Box second = support::find(image, [](int, int, const Pixel& q) { return vermilion(q); });
  const Box third = support::find(image, [&](int, int, const Pixel& q) { return green(q); });
  const auto middle_x = [](const Box& b) { return (b.x0 + b.x1) / 2.0; };
  const auto middle_y = [](const Box& b) { return (b.y0 + b.y1) / 2.0; };
  // Two decades of six to the right, two of three downwards.
  EXPECT_NEAR((middle_x(second) - middle_x(first)) / (middle_x(third) - middle_x(first)), 2.0 / 6, 0.01);
  EXPECT_NEAR((middle_y(second) - middle_y(first)) / (middle_y(third) - middle_y(first)), 2.0 / 3, 0.015);
  for (const Box& mark : {first, second, third}) {
    EXPECT_NEAR(mark.width(), mark.height(), 1) << "a whole disk";
    EXPECT_GE(mark.width(), 5);
  }
}

TEST_F(Plots, MarkersShowThePoints) {
  const std::vector<double> x{0, 1, 2}, y{0, 2, 1};
  render::Plot p;
  p.series = {{"", x, y}};
  const int line = support::find(draw(p), [](int, int, const Pixel& q) { return blue(q); }).count;
  p.series[0].markers = true;
  EXPECT_GT(support::find(draw(p), [](int, int, const Pixel& q) { return blue(q); }).count, line + 30);
}

TEST_F(Plots, ManyPointsAreThinnedWithoutLosingPeaks) {
  std::vector<double> x, y;
  for (int i = 0; i < 300000; ++i) {
    x.push_back(i);
    y.push_back(i == 123456 ? 1.0 : 0.0);
  }
  render::Plot p;
  p.series = {{"", x, y}};
  const Box line = support::find(draw(p), [](int, int, const Pixel& q) { return blue(q); });
  EXPECT_GT(line.height(), 0.7 * height) << "the single peak";
}

TEST_F(Plots, SmallPicturesWork) {
  for (const auto& [w, h] : {std::pair{1, 1}, {40, 30}, {30, 300}}) {
    const auto context = render::open_context(render::Backend::automatic, w, h);
    render::Plot p = plot(x_);
    p.title = std::string("T");
    p.x_label = p.y_label = std::string("t");
    EXPECT_NO_THROW(render::draw_plot(*context, p));
  }
}

}  // namespace
