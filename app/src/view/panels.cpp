// The panels of Ui: all texts and widgets.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "view/live_plot.hpp"
#include "view/ui.hpp"

namespace app::view {
namespace {

constexpr const char* color_names[]{"|w_lambda|", "|w_mu|", "|w| (both)", "speed", "none"};
constexpr const char* integrator_names[]{"rk4", "euler", "exponential", "implicit"};

// Okabe and Ito's, as in the plots of a run.
constexpr ImU32 blue = IM_COL32(0, 114, 178, 255), orange = IM_COL32(213, 94, 0, 255),
                green = IM_COL32(0, 158, 115, 255), purple = IM_COL32(204, 121, 167, 255),
                sky = IM_COL32(86, 180, 233, 255);

std::string with_unit(double value, const char* unit) {
  std::string text = short_number(value);
  const bool prefixed = !text.empty() && !(text.back() >= '0' && text.back() <= '9');
  if (!prefixed) return fmt::format("{} {}", text, unit);
  // The prefix goes to the unit; it may take two bytes.
  const std::size_t at = text.find_first_not_of("0123456789.-+e");
  return fmt::format("{} {}{}", text.substr(0, at), text.substr(at), unit);
}

// What a linear model no longer means here; empty: nothing.
std::string beyond_linear(const rheo::LinearityReport& report) {
  constexpr double degree = 0.017453292519943295;
  if (report.inverted > 0)
    return fmt::format("{} {} inside out: beyond what a linear model means", report.inverted,
                       report.inverted == 1 ? "triangle" : "triangles");
  if (report.strain > rheo::strain_limit)
    return fmt::format("strain {:.0f} %: beyond {:.0f} % a linear model loses its meaning",
                       100.0 * report.strain, 100.0 * rheo::strain_limit);
  if (report.rotation > rheo::rotation_limit)
    return fmt::format("rotation {:.0f} degrees: beyond {:.0f} a linear model swells",
                       report.rotation / degree, rheo::rotation_limit / degree);
  return {};
}

constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

}  // namespace

void Ui::mark(const char* name) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  widgets_.push_back({name, low.x, low.y, high.x, high.y});
}

bool Ui::button(const char* name) {
  const bool pressed = ImGui::Button(name);
  mark(name);
  return pressed;
}

bool Ui::checkbox(const char* name, bool* value) {
  const bool changed = ImGui::Checkbox(name, value);
  mark(name);
  return changed;
}

bool Ui::slider(const char* name, double* value, double low, double high, const char* format) {
  const bool changed = ImGui::SliderScalar(name, ImGuiDataType_Double, value, &low, &high, format,
                                           ImGuiSliderFlags_Logarithmic);
  mark(name);
  return changed;
}

void Ui::label(const std::string& text) {
  ImGui::TextUnformatted(text.c_str());
  labels_.push_back(text);
}

// Three decades to either side of the scene's own value.
void Ui::modulus(const char* name, double* value, double base, const char* unit) {
  const std::string format = fmt::format("%.6g {}", unit);
  if (std::isinf(*value)) {
    ImGui::BeginDisabled();
    double shown = 0.0;
    slider(name, &shown, 0.0, 1.0, "never relaxes");
    ImGui::EndDisabled();
    return;
  }
  const bool usable = base > 0.0 && std::isfinite(base);
  if (slider(name, value, usable ? base * 1e-3 : 0.0, usable ? base * 1e3 : 1e6, format.c_str())) edit();
}

void Ui::draw_overlay() {
  const Display& d = *display_;
  const float s = settings_.scale, text = ImGui::GetFontSize();
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto x0 = static_cast<float>(area_[0]), y0 = static_cast<float>(area_[1]);
  const float x1 = x0 + static_cast<float>(area_[2]), y1 = y0 + static_cast<float>(area_[3]);
  list.PushClipRect({x0, y0}, {x1, y1});
  const auto pixel = [&](double x, double y) {
    const auto [px, py] = picture_.plane().pixel(x, y);
    return ImVec2(x0 + static_cast<float>(px), y0 + static_cast<float>(py));
  };
  const auto plate = [&](ImVec2 at, const std::string& words, ImU32 ink, ImU32 paper) {
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    const float bar = style_.color == rheo::ColorBy::none ? 0.4f : 6.5f;  // clear of the colour bar's numbers
    at.x = std::clamp(at.x, x0 + 0.4f * text, std::max(x0 + 0.4f * text, x1 - size.x - bar * text));
    at.y = std::clamp(at.y, y0 + 0.3f * text, std::max(y0 + 0.3f * text, y1 - size.y - 0.3f * text));
    list.AddRectFilled({at.x - 0.4f * text, at.y - 0.2f * text},
                       {at.x + size.x + 0.4f * text, at.y + size.y + 0.2f * text}, paper, 4.0f * s);
    list.AddText(at, ink, words.c_str());
    labels_.push_back(words);
  };
  const ImU32 paper = style_.dark ? IM_COL32(24, 27, 33, 225) : IM_COL32(252, 252, 253, 225);
  const ImU32 ink = style_.dark ? IM_COL32(226, 230, 238, 255) : IM_COL32(31, 36, 48, 255);
  const ImU32 lit = style_.dark ? IM_COL32(255, 196, 64, 255) : IM_COL32(235, 140, 0, 255);
  const ImU32 force = style_.dark ? IM_COL32(255, 122, 92, 255) : IM_COL32(200, 62, 38, 255);

  const bool held = d.hand.hold != Hold::nothing;
  for (const rheo::Edge& edge : dragging_ || held ? (held ? d.hand.edges : hovered_) : hovered_) {
    const auto i = 2 * static_cast<std::size_t>(edge[0]), j = 2 * static_cast<std::size_t>(edge[1]);
    if (std::max(i, j) + 1 >= d.positions.size()) continue;
    list.AddLine(pixel(d.positions[i], d.positions[i + 1]), pixel(d.positions[j], d.positions[j + 1]), lit,
                 5.0f * s);
  }
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool in_picture = mouse.x > x0 && mouse.x < x1 && mouse.y > y0 && mouse.y < y1;
  if (!hovered_.empty() && !dragging_ && in_picture) list.AddCircle(mouse, brush_ * s, lit, 0, 1.2f * s);
  if (dragging_) {
    const rheo::Vec2 from = d.hand.edges.empty() || !held ? drag_from_ : middle_of(d.hand.edges, d.positions);
    // A push is shown as what it is, at the scale of the hand's strength; a grab by where the hand is.
    rheo::Vec2 to = drag_to_;
    if (held && mode_ == Hold::push && push_gain_ > 0.0)
      to = {from.x + d.hand.traction.x / push_gain_, from.y + d.hand.traction.y / push_gain_};
    const ImVec2 a = pixel(from.x, from.y), b = pixel(to.x, to.y);
    const float dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    if (length > 6.0f * s && std::isfinite(length)) {
      const float head = std::min(12.0f * s, 0.5f * length), ux = dx / length, uy = dy / length;
      list.AddLine(a, {b.x - ux * head * 0.8f, b.y - uy * head * 0.8f}, force, 3.0f * s);
      list.AddTriangleFilled(b, {b.x - ux * head - uy * head * 0.45f, b.y - uy * head + ux * head * 0.45f},
                             {b.x - ux * head + uy * head * 0.45f, b.y - uy * head - ux * head * 0.45f},
                             force);
    }
    const double newton = std::hypot(d.hand.force.x, d.hand.force.y);
    const ImVec2 at{mouse.x + 0.9f * text, mouse.y + 0.9f * text};
    if (mode_ == Hold::push)
      plate(at,
            fmt::format("push {} ({})", with_unit(std::hypot(d.hand.traction.x, d.hand.traction.y), "Pa"),
                        with_unit(newton, "N")),
            force, paper);
    else
      plate(at, fmt::format("reaction {}", with_unit(newton, "N")), force, paper);
  }

  if (const std::string beyond = beyond_linear(d.linearity); !beyond.empty())
    plate({x0 + 0.8f * text, y1 - 3.4f * text}, beyond, ink, paper);
  // In plain sight whether the clock on the picture is the user's.
  std::string clock = fmt::format("real time x{:.2f}", d.real_time_factor);
  bool slow = false;
  if (recording_.is_on()) {
    clock = fmt::format("recording, frame {}", recording_.frames());
    slow = true;
  } else if (!d.running) {
    clock = "paused  (Space runs)";
  } else if (d.resting) {
    clock = "at rest";
  } else {
    slow = d.real_time_factor < 0.9 * d.speed_wanted;
  }
  if (slow && !recording_.is_on()) clock += ": the machine cannot keep up";
  plate({x0 + 0.8f * text, y1 - 1.7f * text}, clock, slow ? IM_COL32(255, 255, 255, 255) : ink,
        slow ? IM_COL32(200, 62, 38, 235) : paper);
  if (toast_left_ > 0.0 && !toast_.empty()) {
    const float width = std::max(120.0f, x1 - x0 - 3.0f * text);
    const ImVec2 size = ImGui::CalcTextSize(toast_.c_str(), nullptr, false, width);
    const ImVec2 at{x0 + std::max(1.2f * text, (x1 - x0 - size.x) / 2), y1 - size.y - 3.2f * text};
    list.AddRectFilled({at.x - 0.6f * text, at.y - 0.4f * text},
                       {at.x + size.x + 0.6f * text, at.y + size.y + 0.4f * text}, IM_COL32(31, 36, 48, 235),
                       5.0f * s);
    list.AddText(nullptr, 0.0f, at, IM_COL32(250, 250, 250, 255), toast_.c_str(), nullptr, width);
    labels_.push_back(toast_);
  }
  list.PopClipRect();
}

void Ui::draw_controls() {
  const Display& d = *display_;
  ImGui::SetNextWindowPos({0.0f, 0.0f});
  ImGui::SetNextWindowSize(
      {static_cast<float>(panel_width_), static_cast<float>(window_[1] - strip_height_)});
  ImGui::Begin("controls", nullptr, fixed);
  ImGui::PushItemWidth(-0.36f * static_cast<float>(panel_width_));
  if (button(d.running ? "Pause" : "Run")) toggle_run();
  ImGui::SameLine();
  if (button("Step")) physics_.step(1);
  ImGui::SameLine();
  if (button("Reset")) {
    end_hand();
    physics_.pause();
    physics_.post([](Core& core) { core.reset(); });
  }
  ImGui::SameLine();
  if (button("Restart")) {
    end_hand();
    physics_.post([](Core& core) { core.reset(); });
    physics_.run();
  }
  ImGui::SameLine();
  if (button("Help")) help_ = !help_;
  if (slider("speed", &speed_, slowest, fastest, "x%.3g of real time")) physics_.set_speed(speed_);
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
  if (!ImGui::CollapsingHeader("Hand", ImGuiTreeNodeFlags_DefaultOpen)) return;
  if (ImGui::RadioButton("push", mode_ == Hold::push) && !dragging_) mode_ = Hold::push;
  mark("push");
  ImGui::SameLine();
  if (ImGui::RadioButton("grab", mode_ == Hold::grab) && !dragging_) mode_ = Hold::grab;
  mark("grab");
  ImGui::SliderFloat("brush", &brush_, 6.0f, 300.0f, "%.0f pixels", ImGuiSliderFlags_Logarithmic);
  mark("brush");
  const double usual = default_push(*display_->scene);
  slider("strength", &push_gain_, usual * 1e-3, usual * 1e3, "%.6g Pa/m");
}

void Ui::draw_colour_section() {
  if (!ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen)) return;
  int color = static_cast<int>(style_.color);
  if (ImGui::Combo("colour", &color, color_names, 5)) style_.color = static_cast<rheo::ColorBy>(color);
  mark("colour");
  int mode = static_cast<int>(style_.range_mode);
  ImGui::RadioButton("auto", &mode, 0);
  mark("auto");
  ImGui::SameLine();
  ImGui::RadioButton("held", &mode, 1);
  mark("held");
  ImGui::SameLine();
  ImGui::RadioButton("typed", &mode, 2);
  mark("typed");
  ImGui::SameLine();
  label("range");
  if (mode == 2 && style_.range_mode != RangeMode::typed)
    style_.typed = {static_cast<float>(picture_.range()[0]), static_cast<float>(picture_.range()[1])};
  style_.range_mode = static_cast<RangeMode>(mode);
  if (style_.range_mode == RangeMode::typed) {
    ImGui::InputFloat2("low, high", style_.typed.data(), "%.4g", ImGuiInputTextFlags_CharsScientific);
    mark("low, high");
    if (ImGui::IsItemDeactivatedAfterEdit() && style_.typed[0] > style_.typed[1])
      std::swap(style_.typed[0], style_.typed[1]);
  }
  checkbox("mesh", &style_.mesh_lines);
  ImGui::SameLine();
  checkbox("rest shape", &style_.rest_shape);
  ImGui::SameLine();
  checkbox("nodes", &style_.node_numbers);
  ImGui::SameLine();
  checkbox("dark", &style_.dark);
}

void Ui::draw_material_section() {
  if (!ImGui::CollapsingHeader("Material", ImGuiTreeNodeFlags_DefaultOpen)) return;
  draw_material(draft_->material, base_->material);
  for (std::size_t i = 0; i < draft_->regions.size() && i < base_->regions.size(); ++i) {
    if (!ImGui::TreeNode(base_->regions[i].name.c_str())) continue;
    draw_material(draft_->regions[i], base_->regions[i].material);
    ImGui::TreePop();
  }
}

void Ui::draw_material(rheo::Material& m, const rheo::Material& base) {
  modulus("lambda_ela", &m.lambda_ela, base.lambda_ela, "Pa");
  modulus("mu_ela", &m.mu_ela, base.mu_ela, "Pa");
  modulus("lambda_vis", &m.lambda_vis, base.lambda_vis, "Pa s");
  modulus("mu_vis", &m.mu_vis, base.mu_vis, "Pa s");
  modulus("density", &m.density, base.density, "kg/m³");
  for (std::size_t k = 0; k < m.more_branches.size() && k < base.more_branches.size(); ++k) {
    const std::string name = fmt::format("branch {}", k + 2);
    if (!ImGui::TreeNode(name.c_str())) continue;
    rheo::MaxwellBranch& b = m.more_branches[k];
    const rheo::MaxwellBranch& from = base.more_branches[k];
    modulus("lambda_ela", &b.lambda_ela, from.lambda_ela, "Pa");
    modulus("mu_ela", &b.mu_ela, from.mu_ela, "Pa");
    modulus("lambda_vis", &b.lambda_vis, from.lambda_vis, "Pa s");
    modulus("mu_vis", &b.mu_vis, from.mu_vis, "Pa s");
    ImGui::TreePop();
  }
  if (base.elastic.lambda != 0.0 || base.elastic.mu != 0.0) {
    modulus("elastic lambda", &m.elastic.lambda, base.elastic.lambda, "Pa");
    modulus("elastic mu", &m.elastic.mu, base.elastic.mu, "Pa");
  }
  if (base.viscous.lambda != 0.0 || base.viscous.mu != 0.0) {
    modulus("viscous lambda", &m.viscous.lambda, base.viscous.lambda, "Pa s");
    modulus("viscous mu", &m.viscous.mu, base.viscous.mu, "Pa s");
  }
}

void Ui::draw_load_section() {
  if (!ImGui::CollapsingHeader("Loads")) return;
  const auto pair = [&](const char* name, rheo::Vec2& value, const char* format) {
    double both[2]{value.x, value.y};
    const bool entered =
        ImGui::InputScalarN(name, ImGuiDataType_Double, both, 2, nullptr, nullptr, format,
                            ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CharsScientific);
    mark(name);
    value = {both[0], both[1]};
    if (entered || ImGui::IsItemDeactivatedAfterEdit()) edit();
  };
  pair("m/s²", draft_->acceleration, "%.4g");
  for (std::size_t i = 0; i < draft_->tractions.size() && i < display_->scene->tractions.size(); ++i) {
    const auto keys = display_->scene->tractions[i].keys.size();
    const std::string name = fmt::format("Pa, load {}", i + 1);
    if (keys == 1)
      pair(name.c_str(), draft_->tractions[i], "%.4g");
    else
      label(fmt::format("load {}: {} keys, as the scene says", i + 1, keys));
  }
}

void Ui::draw_time_section() {
  if (!ImGui::CollapsingHeader("Integration")) return;
  rheo::TimeSettings& time = draft_->time;
  int kind = std::min(static_cast<int>(time.integrator), 3);
  if (ImGui::Combo("integrator", &kind, integrator_names, 4)) {
    time.integrator = static_cast<rheo::IntegratorKind>(kind);
    time.step = 0.0;
    edit();
  }
  mark("integrator");
  bool automatic = time.step == 0.0;
  if (checkbox("automatic step", &automatic)) {
    time.step = automatic || !std::isfinite(display_->step_bound) ? 0.0 : display_->step_bound;
    edit();
  }
  if (time.step > 0.0) {
    ImGui::InputDouble("step", &time.step, 0.0, 0.0, "%.4g s", ImGuiInputTextFlags_CharsScientific);
    mark("step");
    if (ImGui::IsItemDeactivatedAfterEdit()) edit();
  }
  label(fmt::format("stable up to {}", std::isfinite(display_->stable_step)
                                           ? with_unit(display_->stable_step, "s")
                                           : std::string("any step")));
  ImGui::InputDouble("omega", &time.baumgarte, 0.0, 0.0, "%.4g 1/s", ImGuiInputTextFlags_CharsScientific);
  mark("omega");
  if (ImGui::IsItemDeactivatedAfterEdit()) edit();
}

void Ui::draw_scene_section() {
  if (!ImGui::CollapsingHeader("Scenes and files")) return;
  for (const std::filesystem::path& file : scenes_)
    if (button(file.filename().string().c_str())) load(file);
  ImGui::TextDisabled("or drop a scene file on the window");
  if (button("Save session")) save_session();
  ImGui::SameLine();
  if (button("Picture")) save_picture(false);
}

void Ui::draw_truth_and_plots() {
  const auto top = static_cast<float>(window_[1] - strip_height_);
  ImGui::SetNextWindowPos({0.0f, top});
  ImGui::SetNextWindowSize({static_cast<float>(window_[0]), static_cast<float>(strip_height_)});
  ImGui::Begin("truth and plots", nullptr,
               fixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  const float width = 272.0f * settings_.scale;
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
  const Percentiles draw = percentiles_of(draw_seconds_), physics = percentiles_of(physics_seconds_);
  const double interval = percentiles_of(intervals_).median;
  if (!d.running || d.resting)
    label(d.resting ? "at rest: no steps, no frames" : "paused");
  else
    label(fmt::format("{:.0f} frames/s, real time x{:.2f}", interval > 0.0 ? 1.0 / interval : 0.0,
                      d.real_time_factor));
  ImGui::TextDisabled("a frame: median, 99th percentile");
  label(fmt::format("physics {:.2f}, {:.2f} ms", 1e3 * physics.median, 1e3 * physics.high));
  label(fmt::format("drawing {:.2f}, {:.2f} ms", 1e3 * draw.median, 1e3 * draw.high));
  label(fmt::format("{:.0f} steps a frame of {}", percentiles_of(steps_).median,
                    d.largest_step > 0.0 ? with_unit(d.largest_step, "s") : std::string("-")));
  label(fmt::format("stable step {}",
                    std::isfinite(d.stable_step) ? with_unit(d.stable_step, "s") : std::string("any")));
  label(fmt::format("kernel {}, {} {}, {} triangles", d.kernel, d.threads,
                    d.threads == 1 ? "thread" : "threads", d.scene->mesh.triangles.size()));
  const double drift = drift_of(d);
  label(std::isfinite(drift) ? fmt::format("energy drift {}", with_unit(drift, "J"))
                             : std::string("energy drift unknown: long steps"));
}

void Ui::draw_plots(float width, float height) {
  const float least = 215.0f * settings_.scale;
  const int count = std::clamp(static_cast<int>(width / least), 1, 4);
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const ImVec2 size{(width - gap * static_cast<float>(count - 1)) / static_cast<float>(count), height};
  const History& h = history_;
  const Curve residual[]{{"λ", h.w_lambda, blue}, {"μ", h.w_mu, orange}};
  live_plot("|w|", "Pa m", h.t, residual, size);
  mark("|w|");
  labels_.push_back("|w| [Pa m]");
  if (count < 2) return;
  ImGui::SameLine();
  const Curve energy[]{{"kinetic", h.kinetic, blue},
                       {"stored", h.stored, green},
                       {"lost", h.dissipated, orange},
                       {"work", h.work, purple},
                       {"drift", h.drift, sky}};
  live_plot("E", "J", h.t, energy, size);
  mark("E");
  labels_.push_back("E [J]");
  if (count < 3) return;
  ImGui::SameLine();
  const Curve moved[]{{"picked edges", h.moved, blue}};
  live_plot("u", "m", h.t, moved, size);
  mark("u");
  labels_.push_back("u [m]");
  if (count < 4) return;
  ImGui::SameLine();
  const Curve force[]{{"hand", h.force, orange}};
  live_plot("F", "N", h.t, force, size);
  mark("F");
  labels_.push_back("F [N]");
}

void Ui::draw_help() {
  static constexpr std::pair<const char*, const char*> lines[]{
      {"left drag", "push or grab the lit edges; release lets go"},
      {"right or middle drag", "pan"},
      {"wheel", "zoom to the cursor"},
      {"F, Home", "fit; or a double click beside the body"},
      {"Space", "run or pause"},
      {".", "one tick"},
      {"R, Shift+R", "reset, restart"},
      {"G", "push or grab"},
      {"[ ]", "smaller, larger brush"},
      {"- + 1", "slower, faster, real time"},
      {"C", "next colour"},
      {"W B N D", "mesh, rest shape, node numbers, dark"},
      {"Tab, P", "panels, plots"},
      {"F9", "start or stop a sequence of pictures"},
      {"F12, Shift+F12", "the picture, the whole window to a file"},
      {"Ctrl+S", "save what was done as a scene"},
      {"Ctrl+Q", "quit"},
      {"H, F1", "this list; Esc closes it"}};
  const float text = ImGui::GetFontSize();
  // From the top: its title can always be reached. Where the window is small it scrolls.
  const auto width = static_cast<float>(window_[0]), height = static_cast<float>(window_[1]);
  ImGui::SetNextWindowPos({0.5f * width, std::min(2.0f * text, 0.05f * height)}, ImGuiCond_Always,
                          {0.5f, 0.0f});
  ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, {width, 0.95f * height});
  ImGui::Begin("Keys", &help_,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove);
  for (const auto& [key, meaning] : lines) {
    label(key);
    ImGui::SameLine(10.5f * text);
    label(meaning);
  }
  ImGui::End();
}

}  // namespace app::view
