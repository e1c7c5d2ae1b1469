#include "view/ui.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "render/context.hpp"

namespace app::view {
namespace {

constexpr double toast_time = 8.0;                 // [s]
constexpr int settling_frames = 4;                 // after input, until the interface is still
constexpr std::size_t most_times = 100000;         // frames that the summary is of
constexpr int panel_room = 760, strip_room = 520;  // windows below show no panels by themselves

}  // namespace

Ui::Ui(render::Context& context, Physics& physics, UiSettings settings)
    : physics_(physics),
      settings_(std::move(settings)),
      imgui_(ImGui::CreateContext()),
      screen_(context, 320, 200),
      picture_(context),
      recording_(settings_.folder),
      style_(settings_.style),
      typed_{settings_.style.typed[0], settings_.style.typed[1]},
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
  finish_files();
  ImGui::SetCurrentContext(imgui_);
  ImGui::DestroyContext(imgui_);
}

void Ui::finish_files() {
  if (recording_.is_on()) recording_.stop();
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

// Of frames in a row: one that was waited for tells nothing of how quick they are.
void Ui::note_times(const Input& input) {
  const FrameCost cost{frame_seconds_.empty() ? 0.0 : frame_seconds_.back(),
                       display_->busy_seconds - busy_before_,
                       static_cast<double>(display_->steps - steps_before_)};
  if (!lively_) frame_times_.begin_again();
  frame_times_.add(input.seconds, cost);
  busy_before_ = display_->busy_seconds;
  steps_before_ = display_->steps;
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
  if (base_body_ != d.body) {
    base_ = d.scene;
    pieces_ = rheo::pieces_of(base_->mesh);
    chosen_push_.reset();
    usual_push_ = default_push(*base_, pieces_, base_->mesh.edge_groups.at("boundary").front());
    if (base_body_ >= 0) take_colours_of(*d.scene);
    frame_times_.begin_again();  // another scene's times are its own
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
  lively_ = (d.running && !d.resting) || (recording_.is_on() && recording_runs_) ||
            frames_since_input_ < settling_frames || (dragging_ && d.running);
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  frame_seconds_.push_back(took);
  ++frame_count_;
  if (frame_seconds_.size() > most_times) frame_seconds_.pop_front();
}

}  // namespace app::view
