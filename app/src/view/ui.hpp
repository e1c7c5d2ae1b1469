// All of the window's content, drawn by one call from input: the picture, the hand over it, panels, plots.
//
// Needs no window: whoever has a context, positions of a cursor and keys can draw it and press its buttons.
//
// Units    pixels from the top left
// Errors   std::runtime_error of the renderer; all else are messages in the window
// Not here windows and their events (glfw_window.cpp)
#pragma once

#include <array>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/screen.hpp"
#include "view/hand.hpp"
#include "view/history.hpp"
#include "view/keys.hpp"
#include "view/physics.hpp"
#include "view/picture.hpp"
#include "view/recording.hpp"
#include "view/slow_motion.hpp"

struct ImGuiContext;
struct ImVec2;

namespace app::view {

// What has happened since the last frame. One change of a button or key a frame: Dear ImGui 1.86 keeps no
// queue.
struct Input {
  int width = 1280, height = 720;
  double seconds = 1.0 / 60.0;  // since the last frame
  std::array<float, 2> cursor{-1e6f, -1e6f};
  std::array<bool, 3> buttons{};  // left, right, middle
  float wheel = 0.0f;
  bool control = false, shift = false;
  std::vector<Key> down;       // all keys that are down
  std::vector<unsigned> text;  // characters typed
  std::vector<std::filesystem::path> dropped;
};

struct UiSettings {
  std::filesystem::path scene;   // for the list of its folder
  std::filesystem::path folder;  // of pictures, frames, sessions
  float scale = 1.0f;            // of texts and widgets
  PictureStyle style;
  // Reads a scene file; rheo::Error otherwise.
  std::function<rheo::Scene(const std::filesystem::path&)> read;
};

struct Percentiles {
  double median = 0.0, high = 0.0;  // the 99th
};
Percentiles percentiles_of(const std::deque<double>& values);

// The few parameters that the panels change; applied to the scene between steps.
struct Draft {
  rheo::Material material;
  std::vector<rheo::Material> regions;  // of the others in the mesh
  rheo::Vec2 acceleration;
  rheo::TimeSettings time;
  std::vector<rheo::Vec2> tractions;  // of those with one value; others stay

  explicit Draft(const rheo::Scene& scene);
  rheo::Scene on(const rheo::Scene& scene) const;
};

class Ui {
 public:
  // Both must outlive this.
  Ui(render::Context& context, Physics& physics, UiSettings settings);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  // Draws all into screen().
  void frame(const Input& input);
  render::Screen& screen() { return screen_; }
  // Whether the next frame will differ though nothing is pressed.
  bool is_lively() const { return lively_; }
  bool wants_to_quit() const { return quit_; }

  const Display& shown() const { return *display_; }
  Picture& picture() { return picture_; }
  // Where the picture lies: x, y, width, height.
  const std::array<int, 4>& picture_area() const { return area_; }
  const std::deque<double>& frame_seconds() const { return frame_seconds_; }
  // What was written in the last frame by the panels, line by line, and where widgets lie: for tests.
  struct Widget {
    std::string name;
    float x0, y0, x1, y1;
  };
  const std::vector<Widget>& widgets() const { return widgets_; }
  const std::vector<std::string>& labels() const { return labels_; }
  const History& history() const { return history_; }
  const PictureStyle& style() const { return style_; }

 private:
  void take_input(const Input& input);
  void lay_out(const Input& input);
  void take_keys(const Input& input);
  void use_hand();
  void end_hand();
  void note_times(const Input& input);
  void record();

  // panels.cpp
  void draw_overlay();
  void draw_controls();
  void draw_hand_section();
  void draw_colour_section();
  void draw_material_section();
  void draw_material(rheo::Material& m, const rheo::Material& base);
  void draw_load_section();
  void draw_time_section();
  void draw_scene_section();
  void draw_truth_and_plots();
  void draw_truth();
  void draw_plots(float width, float height);
  void draw_help();
  bool button(const char* name);
  bool checkbox(const char* name, bool* value);
  bool slider(const char* name, double* value, double low, double high, const char* format);
  void modulus(const char* name, double* value, double base, const char* unit);
  void label(const std::string& text);
  void mark(const char* name);

  void set_style_colors();
  void say(std::string text);
  void edit() { physics_.edit(draft_->on(*display_->scene)); }
  void load(const std::filesystem::path& file);
  void save_session();
  void save_picture(bool whole);
  void toggle_run();
  void set_speed(double speed);

  Physics& physics_;
  UiSettings settings_;
  ImGuiContext* imgui_;
  render::Screen screen_;
  Picture picture_;
  Recording recording_;
  History history_;
  SlowMotion slow_motion_;
  const Display* display_ = nullptr;
  PictureStyle style_;
  bool dark_set_ = false;

  std::array<int, 4> area_{0, 0, 240, 160};
  std::array<int, 2> window_{0, 0};
  int panel_width_ = 0, strip_height_ = 0;
  bool panels_ = true, plots_ = true, help_ = false;
  bool lively_ = true, quit_ = false;
  int frames_since_input_ = 0;
  Input last_input_;
  std::vector<char> was_down_ = std::vector<char>(key_count, 0);

  Hold mode_ = Hold::push;
  float brush_ = 26.0f;        // pixels
  double push_gain_ = 1.0;     // Pa a metre
  std::int64_t gain_of_ = -1;  // body
  std::vector<rheo::Edge> hovered_;
  bool dragging_ = false;
  rheo::Vec2 drag_from_, drag_to_;
  rheo::Vec2 aimed_;
  bool panning_ = false;
  double speed_ = 1.0;

  std::unique_ptr<Draft> draft_;
  std::shared_ptr<const rheo::Scene> draft_of_, base_;
  std::int64_t message_seen_ = 0, base_body_ = -1;

  std::string toast_;
  double toast_left_ = 0.0;  // [s]

  std::deque<double> intervals_, draw_seconds_, physics_seconds_, steps_, frame_seconds_;
  double busy_before_ = 0.0;
  std::int64_t steps_before_ = 0;

  bool run_after_recording_ = false;
  double wanted_ticks_ = 0.0;
  std::int64_t recorded_ticks_ = -1;
  std::array<int, 2> recorded_size_{};

  std::vector<std::filesystem::path> scenes_;
  std::vector<Widget> widgets_;
  std::vector<std::string> labels_;
};

}  // namespace app::view
