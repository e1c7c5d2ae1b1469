// A frame that differs from the last one by its time only is taken from there: the same pixels, less work.
#include <gtest/gtest.h>

#include "mesh_pictures.hpp"

namespace mesh_pictures {
namespace {

Body held_and_pulled_beam() {
  Body body = bodies::pulled_beam(9, 4, 2);
  for (const int node : {0, 9, 18, 27}) body.hold(node);
  body.arrows = {{.at = {body.positions[16], body.positions[17]}, .vector = {3.0, 1.0}}};
  return body;
}

class RepeatedFrames : public MeshPictures {
 protected:
  // Draws with one picture in a row and each with one of its own: no pixel may differ.
  render::PictureCounters draw_in_a_row(const render::MeshLayout& layout,
                                        const std::vector<render::MeshFrame>& frames) {
    render::MeshPicture picture(*context_, layout);
    Image image;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      picture.draw(frames[k], image);
      EXPECT_EQ(image.rgba, draw(layout, frames[k]).rgba) << "frame " << k;
    }
    return picture.counters();
  }

  static render::MeshLayout layout_of(const Body& body) {
    render::MeshLayout layout = coloured(body);
    layout.title =
        "A beam with a title so long that it has to be cut to leave room for the time in the heading";
    layout.arrow_scale = 4.0;
    return layout;
  }
};

TEST_F(RepeatedFrames, AreTakenFromTheLastOneToThePixel) {
  const Body body = held_and_pulled_beam();
  Body other = body;
  other.positions[20] += 0.05;
  std::vector<render::MeshFrame> frames;
  for (const double t : {0.0, 0.1, 0.2, 0.3, 1e-3}) frames.push_back(body.frame(t));
  frames.push_back(other.frame(0.4));
  for (const double t : {0.5, 0.6, 0.7}) frames.push_back(body.frame(t));
  const render::PictureCounters counters = draw_in_a_row(layout_of(body), frames);
  // The first of a kind and its first repetition, which is kept, are drawn; the others are taken from that.
  // 1 ms is a longer text than 0.3 s: the title is cut elsewhere.
  EXPECT_EQ(counters.frames_drawn + counters.frames_repeated, 9);
  EXPECT_EQ(counters.frames_repeated, 3) << "0.2, 0.3 and 0.7 s";
  EXPECT_EQ(counters.mesh_uploads, 3) << "the body, the other one, the body again";
}

TEST_F(RepeatedFrames, EveryKindOfChangeIsDrawn) {
  const Body body = held_and_pulled_beam();
  Body colour = body, held = body, arrow = body;
  colour.scalar[5] += 0.25;
  held.held.pop_back();
  arrow.arrows[0].vector[1] = -1.0;
  const render::MeshFrame same = body.frame(0.0);
  for (const Body* changed : {&colour, &held, &arrow}) {
    const render::PictureCounters counters =
        draw_in_a_row(layout_of(body), {same, same, same, changed->frame(0.0), same});
    EXPECT_EQ(counters.frames_drawn, 4);
    EXPECT_EQ(counters.frames_repeated, 1);
  }
}

TEST_F(RepeatedFrames, ASheetBetweenThemChangesNothing) {
  const Body body = held_and_pulled_beam();
  Body other = body;
  other.positions[20] += 0.05;
  const render::MeshLayout layout = layout_of(body);
  render::MeshPicture picture(*context_, layout);
  Image image;
  for (int k = 0; k < 3; ++k) picture.draw(body.frame(0.25), image);
  const Image before = image;
  const std::vector<render::MeshFrame> shapes{other.frame(0.0), body.frame(1.0)};
  picture.sheet(shapes);
  picture.draw(body.frame(0.25), image);
  EXPECT_EQ(image.rgba, before.rgba);
}

}  // namespace
}  // namespace mesh_pictures
