// The frames of the picture benchmarks: a beam that is pulled, or a disk that is squeezed and fills the
// picture with colour; another position in every frame, or one that stands still.
#pragma once

#include <cmath>
#include <memory>

#include "render/bodies.hpp"
#include "render/context.hpp"
#include "render/mesh_picture.hpp"

namespace bench {

enum class Colour { shown, none };
enum class Subject { beam, disk };

class Frames {
 public:
  // About `triangles` of them, with colour, lines, hatches, arrows, bar and text.
  Frames(int triangles, int width, int height, Colour colour = Colour::shown, Subject subject = Subject::beam)
      : context_(render::open_context(render::Backend::automatic, width, height)) {
    if (subject == Subject::beam) {
      const int ny = std::max(2, static_cast<int>(std::sqrt(triangles / 8.0)) + 1), nx = 4 * (ny - 1) + 1;
      rest_ = bodies::pulled_beam(nx, ny, 1.0);
      full_ = bodies::pulled_beam(nx, ny, 2.2);
    } else {
      rest_ = bodies::disk(1.0, std::max(1, static_cast<int>(std::sqrt(triangles / 6.0))));
      full_ = rest_;
      for (std::size_t i = 0; i < full_.nodes(); ++i) {
        double &x = full_.positions[2 * i], &y = full_.positions[2 * i + 1];
        full_.scalar[i] = 0.8 * (0.5 + 0.3 * std::sin(5 * x) * std::cos(4 * y) + 0.2 * x * y);
        y *= 0.8;
        x *= 1.15;
      }
    }
    if (colour == Colour::none) full_.scalar.clear();
    body_ = full_;
    render::MeshLayout layout = full_.layout();
    layout.title = "Rheological beam";
    if (colour == Colour::shown) {
      layout.scalar_name = "|w_lambda|";
      layout.scalar_unit = "Pa m";
    }
    layout.range = {0, 0.8};
    layout.arrow_scale = 10;
    picture_ = std::make_unique<render::MeshPicture>(*context_, layout);
    render::Image first;  // shaders are compiled at the first draw
    draw(first);
  }

  void draw(render::Image& out) {
    const double part = 0.5 + 0.5 * std::sin(0.1 * number_);
    for (std::size_t i = 0; i < body_.positions.size(); ++i) {
      body_.positions[i] = rest_.positions[i] + part * (full_.positions[i] - rest_.positions[i]);
    }
    for (std::size_t i = 0; i < body_.scalar.size(); ++i) body_.scalar[i] = part * full_.scalar[i];
    draw_again(out);
  }

  // The shape that was drawn last, at the time that comes next.
  void draw_again(render::Image& out) {
    picture_->draw(body_.frame(number_ / 60.0), out);
    ++number_;
  }

 private:
  std::unique_ptr<render::Context> context_;
  bodies::Body rest_, full_, body_;
  std::unique_ptr<render::MeshPicture> picture_;
  int number_ = 0;
};

}  // namespace bench
