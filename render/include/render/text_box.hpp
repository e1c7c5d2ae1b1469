// What is written in a picture and where its ink lies: for tests, and for whoever describes a picture.
//
// Units    pixels from the top left
// Errors   none
#pragma once

#include <string>

namespace render {

struct TextBox {
  std::string text;
  float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

}  // namespace render
