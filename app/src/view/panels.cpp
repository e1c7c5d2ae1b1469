// The panels of Ui: all texts and widgets.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "view/key_bindings.hpp"
#include "view/live_plot.hpp"
#include "view/ui.hpp"

namespace app::view {
namespace {

constexpr const char* integrator_names[]{"rk4", "euler", "exponential", "implicit"};

// Okabe and Ito's, as in the plots of a run.
constexpr ImU32 blue = IM_COL32(0, 114, 178, 255), orange = IM_COL32(213, 94, 0, 255),
                green = IM_COL32(0, 158, 115, 255), purple = IM_COL32(204, 121, 167, 255),
                sky = IM_COL32(86, 180, 233, 255);

constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

// Always there: what came and went would move the slider that is being dragged.
const char* session_line(SessionState state) {
  switch (state) {
    case SessionState::nothing_yet:
      return "session: nothing has happened yet";
    case SessionState::whole:
      return "session: whole, Ctrl+S saves it";
    case SessionState::parameters_changed:
      return "no session: changed at t > 0, R begins one";
    case SessionState::too_long:
      return "no session: too long to save, R begins one";
  }
  return "";
}

}  // namespace

void Ui::label(const std::string& text) {
  ImGui::TextUnformatted(text.c_str(), text.c_str() + text.size());
  labels_.push_back(text);
}

void Ui::draw_panels() {
  if (panel_width_ > 0) draw_controls();
  if (strip_height_ > 0) draw_truth_and_plots();
  if (help_) draw_help();
}

void Ui::draw_controls() {
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  ImGui::SetNextWindowSize(
      {static_cast<float>(panel_width_), static_cast<float>(window_[1] - strip_height_)});
  ImGui::Begin("controls", nullptr, fixed);
  ImGui::PushItemWidth(-0.36f * static_cast<float>(panel_width_));
  if (widgets_.button(is_running() ? "Pause" : "Run")) act(Action::run_or_pause);
  ImGui::SameLine();
  if (widgets_.button("Step")) act(Action::one_tick);
  ImGui::SameLine();
  if (widgets_.button("Reset")) act(Action::reset);
  ImGui::SameLine();
  if (widgets_.button("Restart")) act(Action::restart);
  ImGui::SameLine();
  if (widgets_.button("Help")) act(Action::help);
  if (widgets_.slider("speed", &speed_, slowest, fastest, "x%.3g of real time")) physics_.set_speed(speed_);
  label(session_line(display_->session));
  draw_hand_section();
  draw_colour_section();
  draw_material_section();
  draw_load_section();
  draw_time_section();
  draw_scene_section();
  ImGui::PopItemWidth();
  ImGui::End();
}

void Ui::draw_hand_section() {
  if (!widgets_.begin_section("Hand", Widgets::At::first_open)) return;
  if (widgets_.radio("push", mode_ == Hold::push) && !dragging_) mode_ = Hold::push;
  ImGui::SameLine();
  if (widgets_.radio("grab", mode_ == Hold::grab) && !dragging_) mode_ = Hold::grab;
  widgets_.slider("brush", &brush_, smallest_brush, largest_brush, "%.0f pixels");
  double strength = push_gain();
  if (widgets_.slider("strength", &strength, usual_push_ * 1e-3, usual_push_ * 1e3, "%.6g Pa/m"))
    chosen_push_ = strength;
  widgets_.end_section();
}

void Ui::draw_load_section() {
  if (!widgets_.begin_section("Loads", Widgets::At::first_closed)) return;
  if (widgets_.pair("m/s²", &draft_->acceleration, "%.4g")) edit();
  for (std::size_t i = 0; i < draft_->tractions.size() && i < display_->scene->tractions.size(); ++i) {
    const auto keys = display_->scene->tractions[i].keys.size();
    if (keys > 1)
      label(fmt::format("load {}: {} keys, as the scene says", i + 1, keys));
    else if (widgets_.pair(fmt::format("Pa, load {}", i + 1).c_str(), &draft_->tractions[i], "%.4g"))
      edit();
  }
  widgets_.end_section();
}

void Ui::draw_time_section() {
  if (!widgets_.begin_section("Integration", Widgets::At::first_closed)) return;
  rheo::TimeSettings& time = draft_->time;
  int kind = std::min(static_cast<int>(time.integrator), 3);
  if (widgets_.choice("integrator", &kind, integrator_names)) {
    time.integrator = static_cast<rheo::IntegratorKind>(kind);
    time.step = 0.0;
    edit();
  }
  bool automatic = time.step == 0.0;
  if (widgets_.checkbox("automatic step", &automatic)) {
    // Where any step is stable, a tick to begin with.
    const double longest = std::isfinite(display_->step_bound) ? display_->step_bound : 1.0 / physics_.rate();
    time.step = automatic ? 0.0 : longest;
    edit();
  }
  if (time.step > 0.0 && widgets_.number("step", &time.step, "%.4g s")) edit();
  label(fmt::format("stable up to {}", std::isfinite(display_->stable_step)
                                           ? with_unit(display_->stable_step, "s")
                                           : std::string("any step")));
  if (widgets_.number("omega", &time.baumgarte, "%.4g 1/s")) edit();
  widgets_.end_section();
}

void Ui::draw_scene_section() {
  if (!widgets_.begin_section("Scenes and files", Widgets::At::first_closed)) return;
  for (const std::filesystem::path& file : scenes_)
    if (widgets_.button(file.filename().string().c_str())) load(file);
  ImGui::TextDisabled("or drop a scene file on the window");
  if (widgets_.button("Save session")) act(Action::save_session);
  ImGui::SameLine();
  if (widgets_.button("Save picture")) act(Action::save_picture);
  widgets_.end_section();
}

void Ui::draw_truth_and_plots() {
  const auto top = static_cast<float>(window_[1] - strip_height_);
  ImGui::SetNextWindowPos({0.0f, top});
  ImGui::SetNextWindowSize({static_cast<float>(window_[0]), static_cast<float>(strip_height_)});
  ImGui::Begin("truth and plots", nullptr,
               fixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  const float width = 272.0f * scale_;
  ImGui::BeginGroup();
  draw_truth();
  ImGui::EndGroup();
  ImGui::SameLine(width);
  const ImVec2 room = ImGui::GetContentRegionAvail();
  draw_plots(room.x, room.y);
  ImGui::End();
}

void Ui::draw_truth() {
  const Display& d = *display_;
  const bool still = !is_running() || d.resting;
  const double rate = frame_times_.frames_per_second();
  const std::string frames =
      rate > 0.0 ? fmt::format("{:.{}f}", rate, rate < 9.95 ? 1 : 0) : std::string("-");
  if (still)
    label(d.resting ? "at rest: no steps, no frames" : "paused: no steps, frames on input");
  else
    label(fmt::format("{} frames/s, real time x{:.2f}", frames, d.real_time_factor));
  // What frames on input alone take tells nothing of those in a row.
  const auto cost = [&](const char* what, const Percentiles& p) {
    label(still ? fmt::format("{} -", what)
                : fmt::format("{} {:.2f}, {:.2f} ms", what, 1e3 * p.median, 1e3 * p.high));
  };
  ImGui::TextDisabled("a frame: median, 99th percentile");
  cost("physics", frame_times_.physics());
  cost("drawing", frame_times_.drawing());
  const std::string length =
      d.largest_step > 0.0 ? fmt::format(" of {}", with_unit(d.largest_step, "s")) : std::string();
  label(fmt::format("{:.0f} steps a frame{}", still ? 0.0 : frame_times_.steps().median, length));
  label(fmt::format("stable step {}",
                    std::isfinite(d.stable_step) ? with_unit(d.stable_step, "s") : std::string("any")));
  label(fmt::format("kernel {}, {} {}, {} triangles", d.kernel, d.threads,
                    d.threads == 1 ? "thread" : "threads", d.scene->mesh.triangles.size()));
  const double drift = drift_of(d);
  label(std::isfinite(drift) ? fmt::format("energy drift {}", with_unit(drift, "J"))
                             : std::string("energy drift unknown: long steps"));
}

void Ui::draw_plots(float width, float height) {
  const float least = 215.0f * scale_;
  const int count = std::clamp(static_cast<int>(width / least), 1, 4);
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 size{(width - gap * static_cast<float>(count - 1)) / static_cast<float>(count), height};
  const History& h = display_->history;
  const auto plot = [&](const char* title, const char* unit, std::span<const Curve> curves) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const bool hovered = widgets_.area(title, size);
    labels_.push_back(live_plot({title, unit, corner, size, hovered}, h.t, curves));
  };
  const Curve residual[]{{"λ", h.w_lambda, blue}, {"μ", h.w_mu, orange}};
  plot("|w|", "Pa m", residual);
  if (count < 2) return;
  ImGui::SameLine();
  const Curve energy[]{{"kinetic", h.kinetic, blue},
                       {"stored", h.stored, green},
                       {"lost", h.dissipated, orange},
                       {"work", h.work, purple},
                       {"drift", h.drift, sky}};
  plot("E", "J", energy);
  if (count < 3) return;
  ImGui::SameLine();
  const Curve moved[]{{"picked edges", h.moved, blue}};
  plot("u", "m", moved);
  if (count < 4) return;
  ImGui::SameLine();
  const Curve force[]{{"hand", h.force, orange}};
  plot("F", "N", force);
}

void Ui::draw_help() {
  const float text = ImGui::GetFontSize();
  // From the top: its title can always be reached. Where the window is small it scrolls.
  const auto width = static_cast<float>(window_[0]), height = static_cast<float>(window_[1]);
  ImGui::SetNextWindowPos({0.5f * width, std::min(2.0f * text, 0.05f * height)}, ImGuiCond_Always,
                          {0.5f, 0.0f});
  ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, {width, 0.95f * height});
  ImGui::Begin("Keys", nullptr,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove);
  if (widgets_.button("Close")) help_ = false;
  const ImGuiStyle& style = ImGui::GetStyle();
  ImGui::PushTextWrapPos(width - style.ScrollbarSize - 2.0f * style.WindowPadding.x);
  for (const auto& [key, meaning] : help_lines()) {
    label(key);
    ImGui::SameLine(10.5f * text);
    label(meaning);
  }
  ImGui::PopTextWrapPos();
  ImGui::End();
}

}  // namespace app::view
