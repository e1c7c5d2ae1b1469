// What the cursor does in Ui's picture: the hand, panning and zooming.
#include <imgui.h>

#include <cmath>
#include <utility>

#include "view/ui.hpp"

namespace app::view {

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
    if (inside && !panning_) {
      Reach reach = reach_at(*display_, pieces_, picture_.plane(), cursor,
                             static_cast<double>(brush_ * scale_), most_picked_edges);
      hovered_ = std::move(reach.edges);
      grip_ = reach.nearest;
    }
  }
  if (inside && io.MouseDoubleClicked[0] && hovered_.empty()) picture_.fit();
  if (inside && io.MouseClicked[0] && !hovered_.empty() && !dragging_) {
    dragging_ = true;
    usual_push_ = default_push(*display_->scene, pieces_, grip_.edge);
    drag_from_ = drag_to_ = {x, y};
    aimed_ = {};
    physics_.post(
        [hold = mode_, edges = hovered_, press = ++press_](Core& core) { core.begin(hold, edges, press); });
    physics_.aim({});
  }
  if (dragging_ && !io.MouseDown[0]) end_hand();
  if (dragging_ && std::isfinite(x) && std::isfinite(y)) {
    drag_to_ = {x, y};
    const double gain = mode_ == Hold::push ? push_gain() : 1.0;
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

}  // namespace app::view
