#include "view/ui.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "render/context.hpp"
#include "rheo/error.hpp"
#include "rheo/io/scene_text.hpp"
#include "state_hash.hpp"

namespace app::view {
namespace {

constexpr double toast_time = 8.0;                 // [s]
constexpr int settling_frames = 4;                 // after input, until the interface is still
constexpr std::size_t most_times = 240;            // frames that medians are of
constexpr double recorded_rate = 60.0;             // frames a second of the user's time
constexpr int panel_room = 760, strip_room = 520;  // windows below show no panels by themselves
constexpr float font_pixels = 15.0f;
constexpr float largest_scale = 4.0f, smallest_share = 0.75f;

void keep(std::deque<double>& values, double value, std::size_t most) {
  values.push_back(value);
  if (values.size() > most) values.pop_front();
}

}  // namespace

Percentiles percentiles_of(const std::deque<double>& values) {
  if (values.empty()) return {};
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double share) {
    return sorted[static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)))];
  };
  return {at(0.5), at(0.99)};
}

float interface_scale(float of_display, int width, int height) {
  const float room = std::min(static_cast<float>(width) / 1280.0f, static_cast<float>(height) / 720.0f);
  // Beside a small picture without panels smaller words do.
  const bool small = room < 0.5f * of_display;
  return std::clamp(std::floor(8.0f * room) / 8.0f, small ? smallest_share * of_display : of_display,
                    std::max(of_display, largest_scale));
}

Draft::Draft(const rheo::Scene& scene)
    : material(scene.material), acceleration(scene.body_acceleration), time(scene.time) {
  for (const rheo::Traction& traction : scene.tractions) tractions.push_back(traction.keys.front().p);
  for (const rheo::Region& region : scene.regions) regions.push_back(region.material);
}

rheo::Scene Draft::on(const rheo::Scene& scene) const {
  rheo::Scene edited = scene;
  edited.material = material;
  for (std::size_t i = 0; i < regions.size() && i < edited.regions.size(); ++i)
    edited.regions[i].material = regions[i];
  edited.body_acceleration = acceleration;
  if (static_cast<std::size_t>(edited.picture.branch) > rheo::most_branches(edited))
    edited.picture.branch = 0;
  edited.time = time;
  edited.time.where.clear();
  for (std::size_t i = 0; i < tractions.size() && i < edited.tractions.size(); ++i)
    if (edited.tractions[i].keys.size() == 1) edited.tractions[i].keys.front().p = tractions[i];
  return edited;
}

Ui::Ui(render::Context& context, Physics& physics, UiSettings settings)
    : physics_(physics),
      settings_(std::move(settings)),
      imgui_(ImGui::CreateContext()),
      screen_(context, 320, 200),
      picture_(context),
      recording_(settings_.folder),
      style_(settings_.style),
      scale_(settings_.scale) {
  ImGui::SetCurrentContext(imgui_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  static constexpr std::pair<ImGuiKey_, Key> keys[]{
      {ImGuiKey_Tab, Key::tab},     {ImGuiKey_LeftArrow, Key::left}, {ImGuiKey_RightArrow, Key::right},
      {ImGuiKey_UpArrow, Key::up},  {ImGuiKey_DownArrow, Key::down}, {ImGuiKey_Home, Key::home},
      {ImGuiKey_End, Key::end},     {ImGuiKey_Delete, Key::del},     {ImGuiKey_Backspace, Key::backspace},
      {ImGuiKey_Space, Key::space}, {ImGuiKey_Enter, Key::enter},    {ImGuiKey_Escape, Key::escape},
      {ImGuiKey_A, key_of('A')},    {ImGuiKey_C, key_of('C')},       {ImGuiKey_V, key_of('V')},
      {ImGuiKey_X, key_of('X')},    {ImGuiKey_Y, key_of('Y')},       {ImGuiKey_Z, key_of('Z')}};
  for (const auto& [theirs, ours] : keys) io.KeyMap[theirs] = static_cast<int>(ours);

  load_fonts();
  set_style_colors();
  display_ = &physics_.newest();

  std::error_code ignored;
  const std::filesystem::path folder =
      settings_.scene.has_parent_path() ? settings_.scene.parent_path() : std::filesystem::path(".");
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".toml") scenes_.push_back(entry.path());
  std::sort(scenes_.begin(), scenes_.end());
}

Ui::~Ui() {
  if (recording_.is_on()) recording_.stop();
  ImGui::SetCurrentContext(imgui_);
  ImGui::DestroyContext(imgui_);
}

void Ui::load_fonts() {
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  ImFontGlyphRangesBuilder builder;
  builder.AddRanges(io.Fonts->GetGlyphRangesDefault());
  builder.AddText("\u03bb\u03bc\u03c9\u03c1\u2013\u2026\u2192\u2265\u2264");
  ImVector<ImWchar> ranges;
  builder.BuildRanges(&ranges);
  const auto font = render::embedded_font();
  io.Fonts->AddFontFromMemoryTTF(const_cast<unsigned char*>(font.data()), static_cast<int>(font.size()),
                                 std::round(font_pixels * scale_), &config, ranges.Data);
  io.Fonts->Build();
  screen_.upload_fonts(*io.Fonts);
}

void Ui::set_scale(float scale) {
  if (scale == scale_) return;
  scale_ = scale;
  load_fonts();
  set_style_colors();
}

void Ui::set_style_colors() {
  ImGuiStyle style;
  if (style_.dark)
    ImGui::StyleColorsDark(&style);
  else
    ImGui::StyleColorsLight(&style);
  style.WindowRounding = 0.0f;
  style.FrameRounding = 3.0f;
  style.GrabRounding = 3.0f;
  style.WindowBorderSize = 1.0f;
  style.FrameBorderSize = style_.dark ? 0.0f : 1.0f;
  style.WindowPadding = {10.0f, 8.0f};
  style.ItemSpacing = {6.0f, 5.0f};
  style.ScaleAllSizes(scale_);
  style.Colors[ImGuiCol_WindowBg] =
      style_.dark ? ImVec4(0.115f, 0.125f, 0.15f, 1.0f) : ImVec4(0.955f, 0.96f, 0.97f, 1.0f);
  ImGui::GetStyle() = style;
  dark_set_ = style_.dark;
}

void Ui::say(std::string text) {
  toast_ = std::move(text);
  toast_left_ = toast_time;
}

void Ui::take_input(const Input& input) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(input.width), static_cast<float>(input.height)};
  io.DeltaTime = static_cast<float>(std::clamp(input.seconds, 1e-4, 1.0));
  io.MousePos = {input.cursor[0], input.cursor[1]};
  for (std::size_t i = 0; i < 3; ++i) io.MouseDown[i] = input.buttons[i];
  io.MouseWheel = input.wheel;
  io.KeyCtrl = input.control;
  io.KeyShift = input.shift;
  std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
  for (const Key key : input.down) io.KeysDown[static_cast<int>(key)] = true;
  for (const unsigned character : input.text) io.AddInputCharacter(character);

  const Input& last = last_input_;
  const bool changed = input.cursor != last.cursor || input.buttons != last.buttons || input.wheel != 0.0f ||
                       input.down != last.down || !input.text.empty() || !input.dropped.empty() ||
                       input.width != last.width || input.height != last.height;
  frames_since_input_ = changed ? 0 : frames_since_input_ + 1;
  last_input_ = input;
}

// The picture keeps what panels leave; where they would leave too little they are not shown.
void Ui::lay_out(const Input& input) {
  const float s = scale_;
  const auto px = [s](double size) { return static_cast<int>(std::lround(size * static_cast<double>(s))); };
  window_ = {input.width, input.height};
  panel_width_ = panels_ && input.width >= px(panel_room) ? px(334) : 0;
  strip_height_ = plots_ && input.height >= px(strip_room) && input.width >= px(panel_room) ? px(196) : 0;
  area_ = {panel_width_, 0, std::max(input.width - panel_width_, rheo::min_picture_size[0]),
           std::max(input.height - strip_height_, rheo::min_picture_size[1])};
}

void Ui::toggle_run() {
  if (!recording_.is_on()) physics_.run_or_pause();
}

void Ui::set_speed(double speed) {
  speed_ = std::clamp(speed, slowest, fastest);
  physics_.set_speed(speed_);
}

void Ui::load(const std::filesystem::path& file) {
  end_hand();
  say(fmt::format("loading {}", file.string()));
  physics_.post([read = settings_.read, file](Core& core) {
    try {
      core.say({});
      if (core.load(read(file)) && core.message().empty())
        core.say(fmt::format("loaded {}", file.filename().string()));
    } catch (const std::exception& error) {
      core.say(error.what());
    }
  });
}

void Ui::save_session() {
  // As it is seen now, so that rheo render shows the same.
  rheo::PictureSettings seen = display_->scene->picture;
  seen.color = style_.color;
  seen.size = {area_[2], area_[3]};
  seen.bounds = picture_.bounds();
  seen.arrow_scale = picture_.arrow_scale();
  seen.range_auto = !(picture_.range()[0] < picture_.range()[1]);
  if (!seen.range_auto) seen.range = picture_.range();
  physics_.post([folder = settings_.folder, seen](Core& core) {
    if (auto scene = core.session()) {
      scene->picture.color = seen.color;
      scene->picture.size = seen.size;
      scene->picture.bounds = seen.bounds;
      scene->picture.arrow_scale = seen.arrow_scale;
      scene->picture.range_auto = seen.range_auto;
      scene->picture.range = seen.range;
      const std::string hash = state_hash(core.live().simulation());
      try {
        core.say(Recording(folder).text_file(
            "session", ".toml",
            "# state at its end, as state_hash in run.json: " + hash + "\n" + rheo::scene_text(*scene)));
      } catch (const std::exception& error) {
        core.say(error.what());
      }
    }
  });
}

void Ui::save_picture(bool whole) {
  render::Image image;
  if (whole)
    screen_.read(image);
  else
    picture_.read(image);
  say(recording_.picture(image));
}

void Ui::take_keys(const Input& input) {
  std::vector<char> down(key_count, 0);
  for (const Key key : input.down) down[static_cast<std::size_t>(key)] = 1;
  const With held = input.control ? With::control : input.shift ? With::shift : With::nothing;
  for (const Key key : input.down) {
    if (was_down_[static_cast<std::size_t>(key)] != 0 || ImGui::GetIO().WantTextInput) continue;
    if (const auto action = action_of(key, held)) act(*action);
  }
  was_down_ = std::move(down);
}

void Ui::act(Action action) {
  switch (action) {
    case Action::run_or_pause:
      return toggle_run();
    case Action::one_tick:
      return physics_.step(1);
    case Action::reset:
      reset();
      return physics_.pause();
    case Action::restart:
      reset();
      return physics_.run();
    case Action::fit:
      return picture_.fit();
    case Action::push_or_grab:
      if (!dragging_) mode_ = mode_ == Hold::push ? Hold::grab : Hold::push;
      return;
    case Action::mesh_lines:
      style_.mesh_lines = !style_.mesh_lines;
      return;
    case Action::rest_shape:
      style_.rest_shape = !style_.rest_shape;
      return;
    case Action::node_numbers:
      style_.node_numbers = !style_.node_numbers;
      return;
    case Action::dark:
      style_.dark = !style_.dark;
      return;
    case Action::next_colour:
      style_.color = static_cast<rheo::ColorBy>((static_cast<int>(style_.color) + 1) % 5);
      return;
    case Action::plots:
      plots_ = !plots_;
      return;
    case Action::panels:
      panels_ = plots_ = !(panels_ || plots_);
      return;
    case Action::help:
      help_ = !help_;
      return;
    case Action::close_help:
      help_ = false;
      return;
    case Action::faster:
      return set_speed(speed_ * 2.0);
    case Action::slower:
      return set_speed(speed_ / 2.0);
    case Action::real_time:
      return set_speed(1.0);
    case Action::smaller_brush:
      brush_ = std::max(smallest_brush, brush_ / 1.3f);
      return;
    case Action::larger_brush:
      brush_ = std::min(largest_brush, brush_ * 1.3f);
      return;
    case Action::save_picture:
      return save_picture(false);
    case Action::save_window:
      return save_picture(true);
    case Action::record:
      return toggle_recording();
    case Action::save_session:
      return save_session();
    case Action::quit:
      quit_ = true;
      return;
  }
}

void Ui::reset() {
  end_hand();
  physics_.post([](Core& core) { core.reset(); });
}

void Ui::toggle_recording() {
  if (recording_.is_on()) {
    say(recording_.stop());
    if (run_after_recording_) physics_.run();
    return;
  }
  say(recording_.start());
  run_after_recording_ = display_->running;
  physics_.pause();
  recorded_ticks_ = -1;
}

void Ui::end_hand() {
  if (dragging_) physics_.post([](Core& core) { core.let_go(); });
  dragging_ = false;
}

// What the cursor does in the picture. Its plane is that of the last frame, which the user sees.
void Ui::use_hand() {
  const ImGuiIO& io = ImGui::GetIO();
  const std::array<double, 2> cursor{io.MousePos.x - area_[0], io.MousePos.y - area_[1]};
  const bool inside = cursor[0] >= 0 && cursor[1] >= 0 && cursor[0] < area_[2] && cursor[1] < area_[3] &&
                      !io.WantCaptureMouse;
  const auto [x, y] = picture_.plane().plane(cursor[0], cursor[1]);
  if (!dragging_) {
    hovered_.clear();
    if (inside && !panning_)
      hovered_ = edges_at(*display_, picture_.plane(), cursor, static_cast<double>(brush_ * scale_),
                          most_picked_edges);
  }
  if (inside && io.MouseDoubleClicked[0] && hovered_.empty()) picture_.fit();
  if (inside && io.MouseClicked[0] && !hovered_.empty() && !dragging_) {
    dragging_ = true;
    drag_from_ = drag_to_ = {x, y};
    aimed_ = {};
    physics_.post([hold = mode_, edges = hovered_](Core& core) { core.begin(hold, edges); });
    physics_.aim({});
  }
  if (dragging_ && !io.MouseDown[0]) end_hand();
  if (dragging_ && std::isfinite(x) && std::isfinite(y)) {
    drag_to_ = {x, y};
    const double gain = mode_ == Hold::push ? push_gain_ : 1.0;
    const rheo::Vec2 aim{gain * (x - drag_from_.x), gain * (y - drag_from_.y)};
    if (!(aim == aimed_)) physics_.aim(aim);
    aimed_ = aim;
  }
  const bool pan_down = io.MouseDown[1] || io.MouseDown[2];
  if (inside && (io.MouseClicked[1] || io.MouseClicked[2])) panning_ = true;
  if (!pan_down) panning_ = false;
  if (panning_) picture_.pan(static_cast<double>(io.MouseDelta.x), static_cast<double>(io.MouseDelta.y));
  if (inside && io.MouseWheel != 0.0f && !dragging_)
    picture_.zoom(std::pow(1.15, static_cast<double>(io.MouseWheel)), cursor[0], cursor[1]);
}

void Ui::note_times(const Input& input) {
  keep(intervals_, input.seconds, most_times);
  keep(physics_seconds_, display_->busy_seconds - busy_before_, most_times);
  keep(steps_, static_cast<double>(display_->steps - steps_before_), most_times);
  busy_before_ = display_->busy_seconds;
  steps_before_ = display_->steps;
}

// A frame when the physics has come to its time, then the next is asked for.
void Ui::record() {
  if (!recording_.is_on()) return;
  const double ticks = physics_.rate() * speed_ / recorded_rate;
  if (recorded_ticks_ < 0 || display_->ticks < recorded_ticks_) {  // begun, or set back
    recorded_ticks_ = display_->ticks;
    wanted_ticks_ = static_cast<double>(display_->ticks);
  }
  if (static_cast<double>(display_->ticks) < std::floor(wanted_ticks_)) return;
  render::Image image = recording_.image();
  picture_.read(image);
  const std::array<int, 2> size{image.width, image.height};
  if (recording_.frames() == 0) recorded_size_ = size;
  if (size != recorded_size_) {  // frames of two sizes are no film
    say(fmt::format("the picture's size has changed: {}", recording_.stop()));
    if (run_after_recording_) physics_.run();
    return;
  }
  if (std::string trouble = recording_.add(std::move(image)); !trouble.empty()) {
    say(std::move(trouble));
    return;
  }
  wanted_ticks_ = std::max(wanted_ticks_ + ticks, static_cast<double>(display_->ticks) + 1.0);
  physics_.step(static_cast<int>(std::floor(wanted_ticks_) - static_cast<double>(display_->ticks)));
  recorded_ticks_ = display_->ticks;
}

// The newest state, and what follows from another body's.
void Ui::take_display() {
  const Display& newest = physics_.newest();
  const double now =
      std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  // A recording is of ticks.
  display_ = recording_.is_on() ? &newest : &slow_motion_.shown(newest, physics_.rate(), now);
  const Display& d = *display_;
  if (d.message_number != message_seen_) say(d.message);
  if (d.body != gain_of_) push_gain_ = default_push(*d.scene);
  gain_of_ = d.body;
  if (base_body_ != d.body) {
    base_ = d.scene;
    if (base_body_ >= 0) style_.color = d.scene->picture.color;
    // Another scene's times are its own.
    for (std::deque<double>* times : {&intervals_, &draw_seconds_, &physics_seconds_, &steps_})
      times->clear();
  }
  base_body_ = d.body;
}

// Other values than the panels' may be in force: a refused one, another scene.
void Ui::take_draft() {
  const Display& d = *display_;
  const bool other = draft_of_ != d.scene || message_seen_ != d.message_number;
  if (draft_ && (!other || ImGui::IsAnyItemActive())) return;
  draft_ = std::make_unique<Draft>(*d.scene);
  draft_of_ = d.scene;
  message_seen_ = d.message_number;
}

void Ui::frame(std::span<const Input> inputs) {
  const auto begin = std::chrono::steady_clock::now();
  ImGui::SetCurrentContext(imgui_);
  const Input& last = inputs.back();
  screen_.resize(std::max(last.width, 1), std::max(last.height, 1));
  if (style_.dark != dark_set_) set_style_colors();
  set_scale(interface_scale(settings_.scale, last.width, last.height));
  take_display();
  const Display& d = *display_;
  toast_left_ -= last.seconds;
  note_times(last);
  for (const Input& input : inputs) {
    widgets_.begin_frame();
    labels_.clear();
    take_input(input);
    ImGui::NewFrame();
    take_keys(input);
    if (!input.dropped.empty()) load(input.dropped.back());
    lay_out(input);
    take_draft();
    use_hand();
    if (&input == &last) {
      picture_.draw(d, style_, area_[2], area_[3]);
      record();
      draw_overlay();
    }
    draw_panels();
    ImGui::Render();
  }
  screen_.clear(style_.dark ? std::array<std::uint8_t, 3>{24, 27, 33}
                            : std::array<std::uint8_t, 3>{252, 252, 253});
  screen_.place(picture_.mesh_picture(), area_[0], area_[1]);
  screen_.draw(*ImGui::GetDrawData());
  screen_.wait();
  lively_ = (d.running && !d.resting) || recording_.is_on() || frames_since_input_ < settling_frames ||
            (dragging_ && d.running);
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  keep(draw_seconds_, took, most_times);
  keep(frame_seconds_, took, 100000);
}

}  // namespace app::view
