#include "view/widgets.hpp"

#include <imgui.h>

namespace app::view {

void Widgets::begin_frame() {
  seen_.clear();
  path_.clear();
  path_ends_.clear();
}

// The item that was drawn last.
void Widgets::note(const std::string& name) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  seen_.push_back({path_ + name, low.x, low.y, high.x, high.y, ImGui::IsItemActive()});
}

bool Widgets::button(const char* name) {
  const bool pressed = ImGui::Button(name);
  note(name);
  return pressed;
}

bool Widgets::checkbox(const char* name, bool* value) {
  const bool changed = ImGui::Checkbox(name, value);
  note(name);
  return changed;
}

bool Widgets::radio(const char* name, bool chosen) {
  const bool pressed = ImGui::RadioButton(name, chosen);
  note(name);
  return pressed;
}

bool Widgets::slider(const char* name, double* value, double low, double high, const char* format) {
  const bool changed = ImGui::SliderScalar(name, ImGuiDataType_Double, value, &low, &high, format,
                                           ImGuiSliderFlags_Logarithmic);
  note(name);
  return changed;
}

bool Widgets::slider(const char* name, float* value, float low, float high, const char* format) {
  const bool changed = ImGui::SliderFloat(name, value, low, high, format, ImGuiSliderFlags_Logarithmic);
  note(name);
  return changed;
}

void Widgets::idle_slider(const char* name, const char* text) {
  ImGui::BeginDisabled();
  float shown = 0.0f;
  ImGui::SliderFloat(name, &shown, 0.0f, 1.0f, text);
  ImGui::EndDisabled();
}

bool Widgets::field(const std::string& name, double* value, float width, const char* format) {
  ImGui::SetNextItemWidth(width);
  ImGui::InputDouble(("##" + name).c_str(), value, 0.0, 0.0, format, ImGuiInputTextFlags_CharsScientific);
  note(name);
  return ImGui::IsItemDeactivatedAfterEdit();
}

bool Widgets::number(const char* name, double* value, const char* format) {
  const bool changed = field(name, value, ImGui::CalcItemWidth(), format);
  ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
  ImGui::TextUnformatted(name);
  return changed;
}

bool Widgets::pair(const char* name, rheo::Vec2* value, const char* format) {
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x, half = (ImGui::CalcItemWidth() - gap) / 2;
  const bool first = field(std::string(name) + " x", &value->x, half, format);
  ImGui::SameLine(0.0f, gap);
  const bool second = field(std::string(name) + " y", &value->y, half, format);
  ImGui::SameLine(0.0f, gap);
  ImGui::TextUnformatted(name);
  return first || second;
}

bool Widgets::choice(const char* name, int* value, std::span<const char* const> items) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float width = ImGui::CalcItemWidth(), height = ImGui::GetFrameHeight();
  if (!ImGui::BeginCombo(name, items[static_cast<std::size_t>(*value)])) {
    note(name);
    return false;
  }
  // Open, what was drawn last is its list.
  seen_.push_back({path_ + name, corner.x, corner.y, corner.x + width, corner.y + height, true});
  bool changed = false;
  for (int i = 0; i < static_cast<int>(items.size()); ++i) {
    const char* item = items[static_cast<std::size_t>(i)];
    if (ImGui::Selectable(item, i == *value)) {
      changed = changed || i != *value;
      *value = i;
    }
    note(std::string(name) + ": " + item);
  }
  ImGui::EndCombo();
  return changed;
}

bool Widgets::area(const char* name, const ImVec2& size) {
  ImGui::InvisibleButton(name, size);
  note(name);
  return ImGui::IsItemHovered();
}

bool Widgets::begin_section(const char* name, At first) {
  const bool open =
      ImGui::CollapsingHeader(name, first == At::first_open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  note(name);
  if (open) ImGui::PushID(name);
  return open;
}

void Widgets::end_section() {
  ImGui::PopID();
}

bool Widgets::begin_tree(const char* name, At first) {
  const bool open = ImGui::TreeNodeEx(name, first == At::first_open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  note(name);
  if (open) {
    path_ends_.push_back(path_.size());
    path_ += std::string(name) + "/";
  }
  return open;
}

void Widgets::end_tree() {
  ImGui::TreePop();
  path_.resize(path_ends_.back());
  path_ends_.pop_back();
}

}  // namespace app::view
