// Line plots with axes, ticks, units and a legend.
//
// Errors   std::runtime_error as in context.hpp
#pragma once

#include <span>
#include <string>
#include <vector>

#include "render/image.hpp"
#include "render/text_box.hpp"

namespace render {

class Context;

enum class Scale { linear, log };

struct Series {
  std::string name;
  std::span<const double> x;
  std::span<const double> y;
  bool markers = false;  // points
  bool line = true;
};

struct Plot {
  std::string title;
  std::string x_label;  // with its unit: "t [s]"
  std::string y_label;
  Scale x_scale = Scale::linear;
  Scale y_scale = Scale::linear;
  std::vector<Series> series;
  std::vector<double> marks;  // vertical faint lines (events)
};

// The picture has the context's size. `texts`: receives what is written in it, unless null.
Image draw_plot(Context& context, const Plot& plot, std::vector<TextBox>* texts = nullptr);

}  // namespace render
