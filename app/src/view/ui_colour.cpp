// Ui's section of the picture: what is coloured over which range of values, what is drawn beside it.
#include <fmt/format.h>
#include <imgui.h>

#include <string>

#include "node_scalars.hpp"
#include "rheo/limits.hpp"
#include "view/ui.hpp"

namespace app::view {
namespace {

constexpr const char* color_names[]{"|w_lambda|", "|w_mu|", "|w| (both)", "speed", "none"};

}  // namespace

void Ui::choose_colour(rheo::ColorBy color) {
  const auto unit = [](rheo::ColorBy by) { return scalar_text(by, 0).unit; };
  // A range in Pa m says nothing of one in m/s.
  if (unit(color) != unit(style_.color)) style_.range_mode = RangeMode::automatic;
  style_.color = color;
}

// Its own colour and range, as at the start.
void Ui::take_colours_of(const rheo::Scene& scene) {
  const PictureStyle own = style_of(scene.picture);
  style_.color = own.color;
  style_.range_mode = own.range_mode;
  type_range(own.typed);
}

void Ui::type_range(const std::array<double, 2>& range) {
  style_.typed = range;
  typed_ = {range[0], range[1]};
}

// What is no range waits in its fields until its other end is typed too.
void Ui::take_typed_range() {
  const std::string colours = fmt::format("colours from {:.4g} to {:.4g}", typed_.x, typed_.y);
  if (!(typed_.x < typed_.y) || !rheo::within_size(typed_.x) || !rheo::within_size(typed_.y))
    return say(
        fmt::format("{}: low < high is needed, each of at most {:g} in size", colours, rheo::largest_size));
  style_.typed = {typed_.x, typed_.y};
  say(colours);
}

void Ui::draw_colour_section() {
  if (!widgets_.begin_section("Picture", Widgets::At::first_open)) return;
  int color = static_cast<int>(style_.color);
  if (widgets_.choice("colour", &color, color_names)) choose_colour(static_cast<rheo::ColorBy>(color));
  if (widgets_.radio("auto", style_.range_mode == RangeMode::automatic))
    style_.range_mode = RangeMode::automatic;
  ImGui::SameLine();
  if (widgets_.radio("held", style_.range_mode == RangeMode::held)) style_.range_mode = RangeMode::held;
  ImGui::SameLine();
  if (widgets_.radio("typed", style_.range_mode == RangeMode::typed) &&
      style_.range_mode != RangeMode::typed) {
    style_.range_mode = RangeMode::typed;
    type_range(picture_.range());
  }
  ImGui::SameLine();
  label("range");
  if (style_.range_mode == RangeMode::typed && widgets_.pair("low, high", &typed_, "%.4g"))
    take_typed_range();
  widgets_.checkbox("mesh", &style_.mesh_lines);
  ImGui::SameLine();
  widgets_.checkbox("rest shape", &style_.rest_shape);
  ImGui::SameLine();
  widgets_.checkbox("nodes", &style_.node_numbers);
  ImGui::SameLine();
  widgets_.checkbox("dark", &style_.dark);
  widgets_.end_section();
}

}  // namespace app::view
