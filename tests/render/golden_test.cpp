// A few whole pictures against stored ones. Exact on one driver version; elsewhere rims of lines may move by
// a little. With RHEO_UPDATE_GOLDEN set in the environment, the stored pictures are written anew.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "bodies.hpp"
#include "decode.hpp"
#include "render/context.hpp"
#include "render/mesh_picture.hpp"
#include "render/plot.hpp"
#include "render/png.hpp"
#include "support.hpp"

namespace {

using render::Image;

Image difference_picture(const Image& a, const Image& b) {
  Image d = a;
  for (std::size_t i = 0; i < d.rgba.size(); ++i) {
    d.rgba[i] =
        i % 4 == 3 ? 255 : static_cast<std::uint8_t>(std::min(255, 4 * std::abs(a.rgba[i] - b.rgba[i])));
  }
  return d;
}

void expect_golden(const std::string& name, const Image& actual) {
  const std::filesystem::path golden = std::filesystem::path(RHEO_TEST_DATA) / "golden" / (name + ".png");
  if (std::getenv("RHEO_UPDATE_GOLDEN")) {
    std::filesystem::create_directories(golden.parent_path());
    render::write_png(golden, actual);
    return;
  }
  const Image expected = read_png(golden);
  const support::Difference d = support::compare(actual, expected);
  // A mean of 0.3 levels is some hundred pixels of rims; a part that is missing or moved gives far more than
  // both.
  EXPECT_LE(d.mean, 0.3) << name;
  EXPECT_LE(d.largest, 128) << name;
  if (!::testing::Test::HasFailure()) return;
  const std::filesystem::path folder = support::output_folder();
  render::write_png(folder / (name + "_actual.png"), actual);
  if (d.largest < 256)
    render::write_png(folder / (name + "_difference.png"), difference_picture(actual, expected));
  ADD_FAILURE() << "see " << folder / (name + "_actual.png") << " beside " << golden;
}

render::MeshLayout layout_of(const bodies::Body& body) {
  render::MeshLayout layout = body.layout();
  layout.title = "Rheological beam";
  layout.scalar_name = "|w_lambda|";
  layout.scalar_unit = "Pa m";
  layout.arrow_scale = 10;
  return layout;
}

TEST(Golden, PulledBeam) {
  RHEO_OPEN_OR_SKIP(context, render::Backend::automatic, 480, 270);
  const bodies::Body beam = bodies::pulled_beam(5, 2, 3);
  render::MeshPicture picture(*context, layout_of(beam));
  Image image;
  picture.draw(beam.frame(1), image);
  expect_golden("beam", image);
}

TEST(Golden, SheetOfShapes) {
  RHEO_OPEN_OR_SKIP(context, render::Backend::automatic, 480, 270);
  const bodies::Body last = bodies::pulled_beam(9, 3, 2);
  render::MeshPicture picture(*context, layout_of(last));
  std::vector<bodies::Body> shapes;
  for (int k = 0; k < 6; ++k) shapes.push_back(bodies::pulled_beam(9, 3, 1 + 0.2 * k, 2.0 * k));
  std::vector<render::MeshFrame> frames;
  for (std::size_t k = 0; k < shapes.size(); ++k)
    frames.push_back(shapes[k].frame(0.2 * static_cast<double>(k)));
  expect_golden("sheet", picture.sheet(frames));
}

TEST(Golden, PlotOfTwoCurves) {
  RHEO_OPEN_OR_SKIP(context, render::Backend::automatic, 480, 270);
  std::vector<double> t, a, b;
  for (int i = 0; i <= 200; ++i) {
    t.push_back(i / 40.0);
    a.push_back(t.back() < 1 ? 3 * t.back() : 3 * std::exp(1 - t.back()));
    b.push_back(0.5 * a.back() * a.back() / 3);
  }
  render::Plot plot;
  plot.title = "Residual forces";
  plot.x_label = "t [s]";
  plot.y_label = "|w| [Pa m]";
  plot.series = {{"|w_lambda|", t, a}, {"|w_mu|", t, b}};
  plot.marks = {1.0};
  expect_golden("plot", render::draw_plot(*context, plot));
}

}  // namespace
