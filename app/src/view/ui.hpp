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
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/screen.hpp"
#include "view/draft.hpp"
#include "view/frame_times.hpp"
#include "view/hand.hpp"
#include "view/input.hpp"
#include "view/key_bindings.hpp"
#include "view/notes.hpp"
#include "view/physics.hpp"
#include "view/picture.hpp"
#include "view/recording.hpp"
#include "view/slow_motion.hpp"
#include "view/widgets.hpp"

struct ImGuiContext;

namespace app::view {

struct UiSettings {
  std::filesystem::path scene;   // for the list of its folder
  std::filesystem::path folder;  // of pictures, frames, sessions
  float scale = 1.0f;            // of texts and widgets in a small window: the display's
  PictureStyle style;
  // Reads a scene file; rheo::Error otherwise.
  std::function<rheo::Scene(const std::filesystem::path&)> read;
};

inline constexpr float smallest_brush = 6.0f, largest_brush = 300.0f;  // pixels

// Of texts and widgets, in steps: they grow with the window as the picture's do, from the display's own scale
// on.
float interface_scale(float of_display, int width, int height);

class Ui {
 public:
  // Both must outlive this.
  Ui(render::Context& context, Physics& physics, UiSettings settings);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  // Takes the inputs in their order, then draws all into screen().
  void frame(std::span<const Input> inputs);
  void frame(const Input& input) { frame({&input, 1}); }
  render::Screen& screen() { return screen_; }
  // Whether the next frame will differ though nothing is pressed.
  bool is_lively() const { return lively_; }
  // [s] Until a frame is due though nothing is pressed and nothing moves: a message has been read.
  double next_change() const { return toast_left_ > 0.0 ? toast_left_ : rheo::forever; }
  bool wants_to_quit() const { return quit_; }
  // A recording ends with the frames it has.
  void finish_files();

  const Display& shown() const { return *display_; }
  Picture& picture() { return picture_; }
  // Where the picture lies: x, y, width, height.
  const std::array<int, 4>& picture_area() const { return area_; }
  const std::deque<double>& frame_seconds() const { return frame_seconds_; }  // of the last ones
  std::int64_t frame_count() const { return frame_count_; }
  // What was written in the last frame by the panels, line by line, and where widgets lie: for tests.
  const std::vector<Widgets::Seen>& widgets() const { return widgets_.seen(); }
  const std::vector<std::string>& labels() const { return labels_; }
  const std::vector<Area>& plates() const { return plates_; }  // of notes over the picture
  const History& history() const { return display_->history; }
  const PictureStyle& style() const { return style_; }
  Hold mode() const { return mode_; }
  float brush() const { return brush_; }
  float scale() const { return scale_; }

 private:
  void take_display();
  void take_input(const Input& input);
  void take_draft();
  void take_keys(const Input& input);
  void lay_out(const Input& input);
  void note_times(const Input& input);
  void say(std::string text);
  void edit() { physics_.edit(draft_->on(*display_->scene)); }

  // ui_hand.cpp
  void use_hand();
  void end_hand();
  double push_gain() const { return chosen_push_.value_or(usual_push_); }
  // ui_recording.cpp
  void toggle_recording();
  void end_recording(std::string why);
  void record();
  bool record_frame();
  // ui_actions.cpp
  enum class Saved { picture, window };
  void act(Action action);
  void run();
  void pause();
  void run_or_pause();
  bool is_running() const;
  void step();
  void reset();
  void set_speed(double speed);
  void load(const std::filesystem::path& file);
  void save_session();
  void save_picture(Saved what);
  // ui_style.cpp
  void set_style_colors();
  void set_scale(float scale);
  void load_fonts();
  // overlay.cpp
  struct Clock {
    std::string full, brief;
    enum class Kind { plain, alarm } kind;
  };
  Clock clock() const;
  void draw_overlay();
  // material_panel.cpp
  struct BranchValues {
    double *lambda_ela, *mu_ela, *lambda_vis, *mu_vis;
  };
  void draw_material_section();
  void draw_material(rheo::Material& m, const rheo::Material& base);
  void draw_branch(BranchValues b, const rheo::MaxwellBranch& base);
  void modulus(const char* name, double* value, double base, double usual, const char* unit);
  void viscosity(const char* name, double* value, double base, double ela);
  // ui_colour.cpp
  void choose_colour(rheo::ColorBy color);
  void take_colours_of(const rheo::Scene& scene);
  void type_range(const std::array<double, 2>& range);
  void take_typed_range();
  void draw_colour_section();
  // panels.cpp
  void draw_panels();
  void draw_controls();
  void draw_hand_section();
  void draw_load_section();
  void draw_time_section();
  void draw_scene_section();
  void draw_truth_and_plots();
  void draw_truth();
  void draw_plots(float width, float height);
  void draw_help();
  void label(const std::string& text);

  Physics& physics_;
  UiSettings settings_;
  ImGuiContext* imgui_;
  render::Screen screen_;
  Picture picture_;
  Recording recording_;
  SlowMotion slow_motion_;
  const Display* display_ = nullptr;
  PictureStyle style_;
  rheo::Vec2 typed_;  // low, high in their fields
  bool dark_set_ = false;
  float scale_ = 1.0f;  // of texts and widgets

  std::array<int, 4> area_{0, 0, 240, 160};
  std::array<int, 2> window_{0, 0};
  int panel_width_ = 0, strip_height_ = 0;
  bool panels_ = true, plots_ = true, help_ = false;
  bool lively_ = true, quit_ = false;
  int frames_since_input_ = 0;
  Input last_input_;
  std::vector<char> was_down_ = std::vector<char>(key_count, 0);

  Hold mode_ = Hold::push;
  float brush_ = 26.0f;      // pixels
  double usual_push_ = 1.0;  // Pa a metre, of the material pressed last
  std::optional<double> chosen_push_;
  std::vector<int> pieces_;  // of the body's nodes
  std::vector<rheo::Edge> hovered_;
  Grip grip_;
  bool dragging_ = false;
  std::int64_t press_ = 0;  // counts them
  rheo::Vec2 drag_from_, drag_to_;
  rheo::Vec2 aimed_;
  bool panning_ = false;
  double speed_ = 1.0;

  std::unique_ptr<Draft> draft_;
  std::shared_ptr<const rheo::Scene> draft_of_, base_;
  std::int64_t message_seen_ = 0, base_body_ = -1;

  std::string toast_;
  double toast_left_ = 0.0;  // [s]

  FrameTimes frame_times_;
  std::deque<double> frame_seconds_;
  std::int64_t frame_count_ = 0;
  double busy_before_ = 0.0;
  std::int64_t steps_before_ = 0;

  bool recording_runs_ = false;  // else it waits
  double wanted_ticks_ = 0.0;
  std::int64_t recorded_ticks_ = -1, asked_ticks_ = 0;
  std::array<int, 2> recorded_size_{};

  std::vector<std::filesystem::path> scenes_;
  Widgets widgets_;
  std::vector<std::string> labels_;
  std::vector<Area> plates_;
};

}  // namespace app::view
