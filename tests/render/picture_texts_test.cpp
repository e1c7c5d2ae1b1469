// What is written in pictures, over a grid of sizes down to the smallest that the program allows: in the
// picture, and no two texts on each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "mesh_pictures.hpp"
#include "render/plot.hpp"

namespace mesh_pictures {
namespace {

struct Size {
  int width, height;
};

std::string name_of(Size s) {
  return std::to_string(s.width) + "x" + std::to_string(s.height);
}

// The smallest, the longest at either smallest side, and all between.
constexpr Size sizes[] = {{240, 160}, {240, 400}, {240, 2000}, {300, 161}, {320, 180},  {400, 800},
                          {501, 377}, {640, 360}, {800, 600},  {997, 160}, {2000, 160}, {1280, 720}};

void expect_legible(const std::vector<render::TextBox>& texts, Size size, const std::string& what) {
  const auto describe = [&](const render::TextBox& t) {
    return what + " " + name_of(size) + ": '" + t.text + "' at " + std::to_string(t.x0) + ", " +
           std::to_string(t.y0) + " to " + std::to_string(t.x1) + ", " + std::to_string(t.y1);
  };
  EXPECT_GE(texts.size(), 3u) << what;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const render::TextBox& a = texts[i];
    EXPECT_TRUE(a.x0 >= 0 && a.y0 >= 0 && a.x1 <= static_cast<float>(size.width) &&
                a.y1 <= static_cast<float>(size.height))
        << describe(a) << " is cut";
    for (std::size_t j = 0; j < i; ++j) {
      const render::TextBox& b = texts[j];
      EXPECT_TRUE(a.x0 >= b.x1 || b.x0 >= a.x1 || a.y0 >= b.y1 || b.y0 >= a.y1)
          << describe(a) << " lies on " << describe(b);
    }
  }
}

std::size_t numbers_among(const std::vector<render::TextBox>& texts) {
  return static_cast<std::size_t>(std::ranges::count_if(texts, [](const render::TextBox& t) {
    return t.text.find_first_not_of("0123456789.") == std::string::npos || t.text.starts_with("−");
  }));
}

struct Scene {
  std::string name;
  Body body;
  std::array<double, 2> range;
  std::vector<double> times;
};

std::vector<double> evenly(double end, int count) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(end * i / (count - 1));
  return times;
}

// Arrows on the boundary edges whose middle at rest is within `box`.
void load(Body& body, std::array<double, 4> box, std::array<double, 2> vector) {
  for (std::size_t e = 0; e + 1 < body.boundary.size(); e += 2) {
    const auto a = 2 * static_cast<std::size_t>(body.boundary[e]),
               b = 2 * static_cast<std::size_t>(body.boundary[e + 1]);
    const double x = (body.rest[a] + body.rest[b]) / 2, y = (body.rest[a + 1] + body.rest[b + 1]) / 2;
    if (x < box[0] || y < box[1] || x > box[2] || y > box[3]) continue;
    body.arrows.push_back(
        {{(body.positions[a] + body.positions[b]) / 2, (body.positions[a + 1] + body.positions[b + 1]) / 2},
         vector});
  }
}

void hold(Body& body, double highest) {
  for (std::size_t i = 0; i < body.nodes(); ++i)
    if (body.rest[2 * i + 1] <= highest) body.hold(static_cast<int>(i));
}

// A tall block on a table, sheared by a traction along its top, which tilts.
Body sheared_block(double tilt) {
  Body body = bodies::rectangle(1, 2, 5, 9);
  for (std::size_t i = 0; i < body.nodes(); ++i) {
    const double x = body.rest[2 * i], y = body.rest[2 * i + 1];
    body.positions[2 * i] = x + 0.2 * y * y / 4;
    body.positions[2 * i + 1] = y + tilt * (x - 0.5) * y / 2;
  }
  hold(body, 0);
  load(body, {0, 1.99, 1, 2.01}, {12300, 0});
  return body;
}

// The kinds of the shipped scenes, and what strains a layout more: long numbers, negative ones, arrows all
// along a side.
std::vector<Scene> scenes() {
  std::vector<Scene> all;
  all.push_back({"beam", bodies::pulled_beam(5, 2, 3), {0, 8.7}, evenly(5, 11)});
  all.push_back({"fine beam", bodies::pulled_beam(41, 11, 1.9, 5), {-0.0034, 0.0021}, evenly(0.0123, 12)});
  Body slab = bodies::rectangle(0.1, 0.03, 41, 13);
  hold(slab, 0);
  load(slab, {0.04, 0.0299, 0.06, 0.031}, {0, -1000});
  all.push_back({"slab", slab, {0, 4.4}, evenly(3, 12)});
  Body pressed = bodies::rectangle(0.1, 0.03, 41, 13);
  load(pressed, {0, 0.0299, 0.1, 0.031}, {300, -1.2e6});
  all.push_back({"pressed slab", pressed, {0, 1}, evenly(2777.7, 8)});
  Body disk = bodies::disk(0.03, 8);
  for (const int node : {169, 170, 171, 192, 193, 194}) disk.hold(node);
  all.push_back({"disk", disk, {0, 123456}, evenly(4, 9)});
  Body fish = bodies::disk(0.1, 8);
  for (std::size_t i = 0; i < fish.nodes(); ++i) fish.rest[2 * i] *= 0.25;
  fish.positions = fish.rest;
  load(fish, {-1, -0.2, 1, -0.05}, {8, 0});
  all.push_back({"fish", fish, {0, 230}, evenly(3, 12)});
  all.push_back({"block", sheared_block(0.4), {0, 9999}, evenly(1e-4, 8)});
  return all;
}

render::MeshLayout layout_of(const Scene& scene) {
  render::MeshLayout layout = scene.body.layout();
  layout.title = "A scene whose title is long enough for a line of its own";
  layout.scalar_name = "|w_lambda|";
  layout.scalar_unit = "Pa m";
  layout.range = scene.range;
  for (const render::TractionArrow& arrow : scene.body.arrows)
    layout.arrow_scale = std::max(layout.arrow_scale, std::hypot(arrow.vector[0], arrow.vector[1]));
  return layout;
}

class PictureTexts : public ::testing::TestWithParam<Size> {
 protected:
  void SetUp() override {
    context_ = support::open(render::Backend::automatic, GetParam().width, GetParam().height);
    if (!context_)
      GTEST_SKIP() << "no OpenGL for drawing without a window (libosmesa6, or libegl1 with libgl1-mesa-dri)";
  }
  std::unique_ptr<render::Context> context_;
};

INSTANTIATE_TEST_SUITE_P(Sizes, PictureTexts, ::testing::ValuesIn(sizes),
                         [](const auto& instance) { return name_of(instance.param); });

TEST_P(PictureTexts, OfFramesAndSheetsAreWholeAndApart) {
  for (const Scene& scene : scenes()) {
    render::MeshPicture picture(*context_, layout_of(scene));
    Image image;
    for (const double time : {0.0, scene.times.back()}) {
      picture.draw(scene.body.frame(time), image);
      expect_legible(picture.texts(), GetParam(), scene.name);
      EXPECT_GE(numbers_among(picture.texts()), 2u) << scene.name << ": one number is no scale";
    }
    const int room = render::sheet_room(GetParam().width, GetParam().height);
    // As many as have room, all of them, and far too many.
    for (const int count : {std::min(room, static_cast<int>(scene.times.size())), 12, 64}) {
      std::vector<render::MeshFrame> frames;
      for (const double time : evenly(scene.times.back(), std::max(count, 2)))
        frames.push_back(scene.body.frame(time));
      picture.sheet(frames);
      expect_legible(picture.texts(), GetParam(), scene.name + ", sheet of " + std::to_string(count));
      if (count > std::min(room, 12)) continue;
      const auto named = std::ranges::count_if(
          picture.texts(), [](const render::TextBox& t) { return t.text.ends_with("s"); });
      EXPECT_GE(named, static_cast<std::ptrdiff_t>(frames.size()))
          << scene.name << ": a time for every shape";
    }
  }
}

// A frame alike but for its time says the same, and its own time.
TEST_P(PictureTexts, OfARepeatedFrameAreThoseOfADrawnOne) {
  const Scene scene = scenes().front();
  render::MeshPicture picture(*context_, layout_of(scene)), fresh(*context_, layout_of(scene));
  Image image;
  for (const double time : {0.1, 0.2, 0.3, 0.4}) picture.draw(scene.body.frame(time), image);
  EXPECT_GT(picture.counters().frames_repeated, 0);
  fresh.draw(scene.body.frame(0.4), image);
  ASSERT_EQ(picture.texts().size(), fresh.texts().size());
  for (std::size_t i = 0; i < fresh.texts().size(); ++i)
    EXPECT_EQ(picture.texts()[i].text, fresh.texts()[i].text);
}

TEST_P(PictureTexts, OfPlotsAreWholeAndApart) {
  std::vector<double> x, small, large, errors, costs;
  for (int i = 0; i <= 50; ++i) {
    x.push_back(0.1 * i);
    small.push_back(1e-4 * i);
    large.push_back(3e3 * i);
    errors.push_back(std::pow(10, -12 + 0.2 * i));
    costs.push_back(std::pow(10, 1 - 0.08 * i));
  }
  std::vector<std::pair<std::string, render::Plot>> plots;
  for (const auto* times : {&x, &small, &large}) {
    for (const auto* norms : {&x, &small, &large}) {
      render::Plot p;
      p.title = "Liver-like slab, pressed and released: residual forces";
      p.x_label = "t [s]";
      p.y_label = "|w| [Pa m]";
      p.series = {{"|w_lambda|", *times, *norms}, {"|w_mu|", *times, *norms}};
      p.marks = {1, 2.5};
      plots.emplace_back("residual", p);
    }
  }
  render::Plot bench;
  bench.title = "Rheological beam, Figure 2: run time against error";
  bench.x_label = "error, relative [1]";
  bench.y_label = "run time [s]";
  bench.x_scale = bench.y_scale = render::Scale::log;
  for (const char* name : {"rk4", "euler", "exponential", "implicit"})
    bench.series.push_back({name, errors, costs, true});
  plots.emplace_back("bench", bench);
  for (const auto& [what, plot] : plots) {
    std::vector<render::TextBox> texts;
    render::draw_plot(*context_, plot, &texts);
    expect_legible(texts, GetParam(), what);
    for (const std::string& name : {plot.x_label, plot.y_label})
      EXPECT_TRUE(std::ranges::any_of(texts, [&](const auto& t) { return t.text.starts_with(name); }))
          << name;
    for (const render::Series& s : plot.series)
      EXPECT_TRUE(std::ranges::any_of(texts, [&](const auto& t) { return t.text == s.name; })) << s.name;
    const auto numbers = std::ranges::count_if(texts, [](const render::TextBox& t) {
      return t.text.find_first_not_of("0123456789.^{}-−×") == std::string::npos && !t.text.starts_with("×");
    });
    EXPECT_GE(numbers, 4) << what << ": two on each axis at least";
  }
}

// The value of the largest traction stands on paper. The rest shape, a faint line, is put under the outline.
TEST_P(PictureTexts, OfATractionHideNothingOfTheBody) {
  for (Scene& scene : scenes()) {
    if (scene.body.arrows.empty()) continue;
    scene.body.rest = scene.body.positions;
    const render::MeshLayout layout = layout_of(scene);
    render::MeshPicture picture(*context_, layout);
    Image image, without;
    picture.draw(scene.body.frame(), image);
    const auto value =
        std::ranges::find_if(picture.texts(), [](const auto& t) { return t.text.ends_with("Pa"); });
    ASSERT_NE(value, picture.texts().end()) << scene.name;
    const render::TextBox box = *value;
    Body bare = scene.body;
    bare.arrows.clear();
    picture.draw(bare.frame(), without);
    int hidden = 0;
    for (int y = static_cast<int>(box.y0); y < static_cast<int>(std::ceil(box.y1)); ++y)
      for (int x = static_cast<int>(box.x0); x < static_cast<int>(std::ceil(box.x1)); ++x)
        hidden += support::distance(at(without, x, y), support::paper) > 20;
    EXPECT_EQ(hidden, 0) << scene.name << " " << name_of(GetParam());
  }
}

// As support::find_difference(), quickly where most of two pictures is the same.
Box difference(const Image& a, const Image& b, int level) {
  Box box;
  const auto row = 4 * static_cast<std::size_t>(a.width);
  for (int y = 0; y < a.height; ++y) {
    const auto begin = static_cast<std::ptrdiff_t>(row) * y, end = begin + static_cast<std::ptrdiff_t>(row);
    if (std::equal(a.rgba.begin() + begin, a.rgba.begin() + end, b.rgba.begin() + begin)) continue;
    for (int x = 0; x < a.width; ++x) {
      if (support::distance(at(a, x, y), at(b, x, y)) <= level) continue;
      box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x), std::max(box.y1, y),
             box.count + 1};
    }
  }
  return box;
}

// What one frame's arrows change in a sheet, and where the shapes are, both by comparing sheets.
TEST_P(PictureTexts, AndNeighboursAreClearOfTheArrowsOfASheet) {
  for (Scene& scene : scenes()) {
    if (scene.body.arrows.empty()) continue;
    render::MeshPicture picture(*context_, layout_of(scene));
    Body bare = scene.body, bright = scene.body;
    bare.arrows.clear();
    scene.body.scalar.assign(scene.body.nodes(), scene.range[0]);
    bare.scalar = scene.body.scalar;
    bright.scalar.assign(scene.body.nodes(), scene.range[1]);
    const int count = std::clamp(render::sheet_room(GetParam().width, GetParam().height), 2, 8);
    const std::vector<double> times = evenly(scene.times.back(), count);
    const auto frames_with = [&](int k, const Body& other) {
      std::vector<render::MeshFrame> frames;
      for (int i = 0; i < count; ++i)
        frames.push_back((i == k ? other : scene.body).frame(times[static_cast<std::size_t>(i)]));
      return frames;
    };
    const Image all = picture.sheet(frames_with(-1, bare));
    const std::vector<render::TextBox> texts = picture.texts();
    std::vector<Box> shapes;
    for (int k = 0; k < count; ++k)
      shapes.push_back(difference(all, picture.sheet(frames_with(k, bright)), 8));
    const auto meet = [](const Box& a, double x0, double y0, double x1, double y1) {
      return a.x0 < x1 && x0 < a.x1 + 1 && a.y0 < y1 && y0 < a.y1 + 1;
    };
    for (int k = 0; k < count; k += 2) {
      const std::string where = scene.name + " " + std::to_string(k) + " of " + std::to_string(count);
      const Box arrows = difference(all, picture.sheet(frames_with(k, bare)), 30);
      EXPECT_GT(arrows.count, 10) << where;
      EXPECT_TRUE(arrows.x0 > 1 && arrows.y0 > 1 && arrows.x1 < GetParam().width - 2 &&
                  arrows.y1 < GetParam().height - 2)
          << where << " leave the picture";
      for (const render::TextBox& t : texts)
        EXPECT_FALSE(meet(arrows, t.x0, t.y0, t.x1, t.y1)) << where << " cross " << t.text;
      for (int j = 0; j < count; ++j) {
        const Box& s = shapes[static_cast<std::size_t>(j)];
        if (j == k) continue;
        EXPECT_FALSE(meet(arrows, s.x0, s.y0, s.x1 + 1, s.y1 + 1)) << where << " cross shape " << j;
      }
    }
  }
}

// On meshes from coarse to dense the numbers that are shown stand clear of each other.
TEST_F(MeshPictures, NodeNumbersThatHaveRoomAreShown) {
  for (const int nodes : {3, 9, 33, 101}) {
    const Body body = bodies::rectangle(1.0, 0.5, nodes, nodes);
    render::MeshPicture picture(*context_, body.layout());
    render::MeshView view = picture.view();
    view.node_numbers = render::Show::yes;
    picture.set_view(view);
    picture.draw(body.frame());
    std::vector<render::TextBox> numbers;
    for (const render::TextBox& t : picture.texts())
      if (t.text.find_first_not_of("0123456789") == std::string::npos) numbers.push_back(t);
    EXPECT_GE(numbers.size(), std::min<std::size_t>(body.nodes(), 50)) << nodes;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const render::TextBox &a = numbers[i], &b = numbers[j];
        ASSERT_TRUE(a.x0 >= b.x1 || b.x0 >= a.x1 || a.y0 >= b.y1 || b.y0 >= a.y1)
            << nodes << ": " << a.text << " lies on " << b.text;
      }
    }
  }
}

// Whatever the numbers of a range from 0 are, the body stays where it is.
TEST_F(MeshPictures, AreNotMovedByTheColourBarsNumbers) {
  const Body body = bodies::rectangle(1.0, 0.5, 5, 3);
  for (const Size size : {Size{240, 160}, Size{640, 360}, Size{1280, 720}}) {
    render::MeshLayout layout = coloured(body);
    layout.bar_room = render::BarRoom::fixed;
    render::MeshPicture picture(*context_, layout, size.width, size.height);
    const render::PlaneInPicture first = picture.plane();
    for (int power = -15; power <= 15; ++power) {
      for (const double digit : {1.0, 1.5, 2.0, 2.37, 3.0, 4.0, 5.0, 6.0, 8.0, 9.99}) {
        render::MeshView view = picture.view();
        view.range = {0.0, digit * std::pow(10.0, power)};
        picture.set_view(view);
        const render::PlaneInPicture now = picture.plane();
        ASSERT_EQ(now.scale, first.scale) << name_of(size) << " up to " << view.range[1];
        ASSERT_EQ(now.at_x, first.at_x) << name_of(size) << " up to " << view.range[1];
      }
    }
  }
}

}  // namespace
}  // namespace mesh_pictures
