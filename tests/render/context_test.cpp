#include "render/context.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "bodies.hpp"
#include "canvas.hpp"
#include "context_backends.hpp"
#include "gl_program.hpp"
#include "render/mesh_picture.hpp"
#include "support.hpp"
#include "target.hpp"

namespace {

using render::Backend;
using ::testing::HasSubstr;

render::Image picture(render::Context& context) {
  const bodies::Body beam = bodies::pulled_beam(9, 4, 2.0);
  render::MeshLayout layout = beam.layout();
  layout.title = "Beam";
  layout.scalar_name = "|w_lambda|";
  layout.scalar_unit = "Pa m";
  layout.arrow_scale = 10;
  render::MeshPicture drawing(context, layout);
  render::Image image;
  drawing.draw(beam.frame(0.5), image);
  return image;
}

class EachBackend : public ::testing::TestWithParam<Backend> {};

TEST_P(EachBackend, OpensAndSaysWhatItIs) {
  RHEO_OPEN_OR_SKIP(context, GetParam(), 64, 48);
  EXPECT_EQ(context->width(), 64);
  EXPECT_EQ(context->height(), 48);
  EXPECT_THAT(context->description(), HasSubstr(GetParam() == Backend::egl ? "EGL" : "OSMesa"));
  EXPECT_THAT(context->description(), HasSubstr("OpenGL"));
}

TEST_P(EachBackend, NamesTheLimitOfATooLargePicture) {
  RHEO_OPEN_OR_SKIP(context, GetParam(), 64, 48);
  try {
    const auto huge = render::open_context(GetParam(), 100000, 100000);
    FAIL() << "a picture of 100000 x 100000 was accepted";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("100000 x 100000"));
    EXPECT_THAT(e.what(), HasSubstr("limit"));
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
  }
}

TEST_P(EachBackend, SizesBelowOneAreRefused) {
  EXPECT_THROW(render::open_context(GetParam(), 0, 10), std::runtime_error);
  EXPECT_THROW(render::open_context(GetParam(), 10, -1), std::runtime_error);
}

TEST_P(EachBackend, DrawsTheSameAgain) {
  RHEO_OPEN_OR_SKIP(context, GetParam(), 320, 240);
  EXPECT_EQ(picture(*context).rgba, picture(*context).rgba);
}

TEST_P(EachBackend, MayBeOpenedAgainAfterItWasClosed) {
  RHEO_OPEN_OR_SKIP(context, GetParam(), 160, 120);
  const render::Image first = picture(*context);
  for (int i = 0; i < 3; ++i) {
    const auto other = render::open_context(GetParam(), 160, 120);
    EXPECT_EQ(picture(*other).rgba, first.rgba);
  }
  EXPECT_EQ(picture(*context).rgba, first.rgba);
}

INSTANTIATE_TEST_SUITE_P(Context, EachBackend, ::testing::Values(Backend::osmesa, Backend::egl),
                         [](const auto& each) { return each.param == Backend::egl ? "Egl" : "Osmesa"; });

// A context that does nothing.
class NoContext final : public render::Context {
 public:
  const render::Gl& gl() const override { throw std::logic_error("no functions here"); }
  int width() const override { return 1; }
  int height() const override { return 1; }
  std::string description() const override { return "none"; }
  void make_current() override {}
};

std::string reason_of(const render::Opener& first, const render::Opener& second) {
  try {
    render::open_either(first, second);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "opened";
}

TEST(Contexts, TheSecondBackendServesWhereTheFirstGivesNoContext) {
  const auto works = [] { return std::make_unique<NoContext>(); };
  const auto fails = [](const char* why) {
    return [why]() -> std::unique_ptr<render::Context> { throw std::runtime_error(why); };
  };
  const auto too_large = []() -> std::unique_ptr<render::Context> {
    throw render::PictureTooLarge("beyond the limit");
  };
  EXPECT_EQ(reason_of(works, fails("not asked")), "opened");
  EXPECT_EQ(reason_of(fails("the first gives no context"), works), "opened");
  EXPECT_EQ(reason_of(too_large, works), "opened");
  EXPECT_EQ(reason_of(fails("the first is absent"), fails("the second gives no context")),
            "no OpenGL for drawing without a window: the first is absent; the second gives no context");
  EXPECT_EQ(reason_of(too_large, fails("the second is absent")), "beyond the limit");
}

TEST(Contexts, OsmesaAndEglGiveTheSamePicture) {
  RHEO_OPEN_OR_SKIP(osmesa, Backend::osmesa, 480, 270);
  RHEO_OPEN_OR_SKIP(egl, Backend::egl, 480, 270);
  const render::Image a = picture(*osmesa), b = picture(*egl);
  const support::Difference d = support::compare(a, b);
  // One Mesa with the same software renderer rounds alike; another driver may move the rim of a line by a
  // pixel.
  const auto driver = [](const std::string& text) { return text.substr(text.find(':')); };
  if (driver(osmesa->description()) == driver(egl->description())) {
    EXPECT_EQ(d.largest, 0) << osmesa->description() << " and " << egl->description();
  }
  EXPECT_LT(d.mean, 0.5) << osmesa->description() << " and " << egl->description();
}

TEST(Contexts, SeveralLiveInOneProcess) {
  RHEO_OPEN_OR_SKIP(first, Backend::automatic, 320, 240);
  RHEO_OPEN_OR_SKIP(second, Backend::automatic, 200, 150);
  const bodies::Body disk = bodies::disk(1, 4);
  render::MeshPicture a(*first, disk.layout()), b(*second, disk.layout());
  render::Image image_a, image_b, again;
  a.draw(disk.frame(), image_a);
  b.draw(disk.frame(), image_b);
  a.draw(disk.frame(), again);
  EXPECT_EQ(image_a.width, 320);
  EXPECT_EQ(image_b.width, 200);
  EXPECT_EQ(image_a.rgba, again.rgba);
}

TEST(Contexts, BackendsTakeTurnsInOneThread) {
  RHEO_OPEN_OR_SKIP(osmesa, Backend::osmesa, 320, 240);
  RHEO_OPEN_OR_SKIP(egl, Backend::egl, 320, 240);
  const bodies::Body disk = bodies::disk(1, 4), beam = bodies::pulled_beam(9, 4, 2);
  render::Image disk_first, beam_first, disk_again, beam_again;
  render::MeshPicture a(*osmesa, disk.layout());
  a.draw(disk.frame(), disk_first);
  render::MeshPicture b(*egl, beam.layout());
  b.draw(beam.frame(), beam_first);
  for (int i = 0; i < 3; ++i) {
    a.draw(disk.frame(), disk_again);
    b.draw(beam.frame(), beam_again);
    EXPECT_EQ(disk_first.rgba, disk_again.rgba);
    EXPECT_EQ(beam_first.rgba, beam_again.rgba);
  }
}

// OSMesa and EGL share Mesa's dispatch without knowing of each other: a context that only believes to be
// current would draw into the other one, with the other one's objects.
TEST(Contexts, EachIsTrulyCurrentAfterMakeCurrent) {
  RHEO_OPEN_OR_SKIP(osmesa, Backend::osmesa, 32, 32);
  RHEO_OPEN_OR_SKIP(egl, Backend::egl, 32, 32);
  RHEO_OPEN_OR_SKIP(second, Backend::osmesa, 32, 32);
  const std::array<render::Context*, 3> contexts{osmesa.get(), egl.get(), second.get()};
  const auto bound = [](const render::Context& context) {
    GLint id = 0;
    context.gl().GetIntegerv(GL_TEXTURE_BINDING_2D, &id);
    return id;
  };
  std::array<GLint, 3> own{};
  for (std::size_t i = 0; i < 3; ++i) {
    contexts[i]->make_current();
    EXPECT_EQ(bound(*contexts[i]), 0) << "fresh";
    std::array<GLuint, 3> names{};
    contexts[i]->gl().GenTextures(static_cast<GLsizei>(i + 1), names.data());
    own[i] = static_cast<GLint>(names[i]);
    contexts[i]->gl().BindTexture(GL_TEXTURE_2D, names[i]);
  }
  for (const std::size_t i : {0u, 1u, 2u, 1u, 0u, 2u, 0u}) {
    contexts[i]->make_current();
    EXPECT_EQ(bound(*contexts[i]), own[i]) << "context " << i;
  }
}

TEST(Contexts, AThreadMayHaveItsOwn) {
  RHEO_OPEN_OR_SKIP(here, Backend::automatic, 160, 120);
  const render::Image expected = picture(*here);
  render::Image there;
  std::thread([&there] {
    const auto context = render::open_context(Backend::automatic, 160, 120);
    there = picture(*context);
  }).join();
  EXPECT_EQ(there.rgba, expected.rgba);
}

TEST(Canvas, DrawsBeyondSixteenBitIndices) {
  RHEO_OPEN_OR_SKIP(context, Backend::automatic, 200, 100);
  context->make_current();
  const render::Target target(context->gl(), 200, 100);
  render::Canvas canvas(context->gl(), 200, 100, "");
  target.bind();
  context->gl().ClearColor(1, 1, 1, 1);
  context->gl().Clear(GL_COLOR_BUFFER_BIT);
  const render::Color red{255, 0, 0}, blue{0, 0, 255};
  for (int i = 0; i < 40000; ++i) canvas.rect({10, 10, 40, 40}, red);  // 160000 vertices
  std::vector<render::Point> zigzag;
  for (int i = 0; i < 70000; ++i)
    zigzag.push_back({static_cast<float>(60 + i % 2), 10.0f + static_cast<float>(i) * 0.001f});
  canvas.polyline(zigzag, red, 2);
  canvas.rect({150, 50, 180, 80}, blue);
  canvas.flush();
  render::Image image;
  target.read(image);
  EXPECT_EQ(support::at(image, 25, 25), (support::Pixel{255, 0, 0}));
  EXPECT_EQ(support::at(image, 165, 65), (support::Pixel{0, 0, 255}));
  EXPECT_EQ(support::at(image, 60, 75)[1], 0) << "the end of the long line";
  EXPECT_EQ(support::at(image, 100, 50), (support::Pixel{255, 255, 255}));
}

TEST(Canvas, TitlesAreShortenedToWholeCharacters) {
  RHEO_OPEN_OR_SKIP(context, Backend::automatic, 200, 100);
  context->make_current();
  const render::Canvas canvas(context->gl(), 200, 100, "äöüß");
  const std::string s = canvas.fit(render::TextSize::normal, "äöüßäöüßäöüßäöüß", 60);
  EXPECT_LT(s.size(), 32u);
  EXPECT_THAT(s, ::testing::EndsWith("…"));
  EXPECT_EQ((s.size() - 3) % 2, 0u) << "half a character is left";
  EXPECT_LE(canvas.text_width(render::TextSize::normal, s), 60);
}

TEST(Canvas, AnyTextStaysInOneLine) {
  RHEO_OPEN_OR_SKIP(context, Backend::automatic, 300, 100);
  context->make_current();
  const render::Target target(context->gl(), 300, 100);
  const std::string odd = "a\nb\tc\r\x01 \xFF\xC3 d 漢字 😀 e";
  render::Canvas canvas(context->gl(), 300, 100, odd);
  target.bind();
  context->gl().ClearColor(1, 1, 1, 1);
  context->gl().Clear(GL_COLOR_BUFFER_BIT);
  canvas.text({10, 50}, render::Align::left, render::TextSize::normal, {0, 0, 0}, odd);
  canvas.label({10, 50}, render::Align::left, render::TextSize::normal, {0, 0, 0}, odd);
  canvas.flush();
  render::Image image;
  target.read(image);
  const support::Box ink = support::find(image, [](int, int, const support::Pixel& p) { return p[0] < 128; });
  EXPECT_GT(ink.count, 20);
  EXPECT_LT(ink.height(), 20);
}

TEST(Shaders, ADirectoryOfTheDeveloperReplacesThem) {
  RHEO_OPEN_OR_SKIP(context, Backend::automatic, 32, 32);
  context->make_current();
  const std::filesystem::path folder = support::output_folder() / "shaders";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "mesh.frag") << "this is no shader";
  setenv("RHEO_SHADER_DIR", folder.c_str(), 1);
  try {
    const render::GlProgram program(context->gl(), "mesh", {"corner"});
    ADD_FAILURE() << "the directory was not looked at";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("mesh.frag"));
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
  }
  unsetenv("RHEO_SHADER_DIR");
  EXPECT_NO_THROW(render::GlProgram(context->gl(), "mesh", {"corner"}));
}

}  // namespace
