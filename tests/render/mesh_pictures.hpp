// A context and what pictures of a mesh are judged by, for the tests of MeshPicture.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "bodies.hpp"
#include "colormap.hpp"
#include "render/context.hpp"
#include "render/mesh_picture.hpp"
#include "support.hpp"

namespace mesh_pictures {

using bodies::Body;
using render::Image;
using support::at;
using support::Box;
using support::Pixel;

inline constexpr int width = 640, height = 360;
inline constexpr int heading = 48;  // rows that title and time take at this size
inline const double nan = std::numeric_limits<double>::quiet_NaN();

class MeshPictures : public ::testing::Test {
 protected:
  void SetUp() override {
    context_ = support::open(render::Backend::automatic, width, height);
    if (!context_)
      GTEST_SKIP() << "no OpenGL for drawing without a window (libosmesa6, or libegl1 with libgl1-mesa-dri)";
  }

  Image draw(const render::MeshLayout& layout, const render::MeshFrame& frame) {
    render::MeshPicture picture(*context_, layout);
    Image image;
    picture.draw(frame, image);
    return image;
  }

  // Everything below the heading that is not paper.
  static Box drawn(const Image& image) {
    return support::find(image, [](int, int y, const Pixel& p) {
      return y > heading && support::distance(p, support::paper) > 60;
    });
  }

  std::unique_ptr<render::Context> context_;
};

inline Pixel map_colour(double t) {
  const render::Rgb c = render::make_colormap()[static_cast<std::size_t>(std::lround(255 * t))];
  return {c[0], c[1], c[2]};
}

inline render::MeshLayout coloured(const Body& body) {
  render::MeshLayout layout = body.layout();
  layout.scalar_name = "|w|";
  layout.scalar_unit = "Pa m";
  return layout;
}

// Of an arrow.
inline bool is_red(const Pixel& p) {
  return p[0] > p[2] + 80;
}

}  // namespace mesh_pictures
