// The interface's widgets, each under a name of its own, and what was seen of them in a frame.
//
// All that can be pressed in the window goes through here: what is not noted cannot be, and a test reaches
// every one of them.
//
// Units    pixels from the top left
// Errors   none
// Not here what the widgets mean (panels.cpp, material_panel.cpp)
#pragma once

#include <span>
#include <string>
#include <vector>

#include "rheo/mesh.hpp"

struct ImVec2;

namespace app::view {

class Widgets {
 public:
  struct Seen {
    std::string name;  // the label, after the trees that it lies in: "branch 2/mu_ela"
    float x0, y0, x1, y1;
    bool active;  // it has the mouse or the keys
  };
  void begin_frame();
  // In the order in which they were drawn.
  const std::vector<Seen>& seen() const { return seen_; }

  // Each returns whether it was used.
  bool button(const char* name);
  bool checkbox(const char* name, bool* value);
  bool radio(const char* name, bool chosen);
  // Logarithmic. A click with Ctrl makes it a field.
  bool slider(const char* name, double* value, double low, double high, const char* format);
  bool slider(const char* name, float* value, float low, float high, const char* format);
  // One that cannot be moved now.
  static void idle_slider(const char* name, const char* text);
  // Fields: when the typing has ended.
  bool number(const char* name, double* value, const char* format);
  bool pair(const char* name, rheo::Vec2* value, const char* format);
  bool choice(const char* name, int* value, std::span<const char* const> items);
  // A room that answers to the cursor.
  bool area(const char* name, const ImVec2& size);

  // What can be folded: whether it is open; an open one is ended by its end_...().
  enum class At { first_open, first_closed };
  bool begin_section(const char* name, At first);
  void end_section();
  bool begin_tree(const char* name, At first = At::first_closed);
  void end_tree();

 private:
  void note(const std::string& name);
  bool field(const std::string& name, double* value, float width, const char* format);

  std::vector<Seen> seen_;
  std::string path_;  // of trees
  std::vector<std::size_t> path_ends_;
};

}  // namespace app::view
