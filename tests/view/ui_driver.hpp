// Somebody who looks at the window and moves cursor and keys, without a window.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "render/context.hpp"
#include "rheo/io/scene_file.hpp"
#include "view/ui.hpp"

namespace view_tests {

namespace fs = std::filesystem;
using app::view::Display;
using app::view::Hold;
using app::view::Key;
using app::view::key_of;

inline fs::path output_folder() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const fs::path folder = fs::path(RHEO_TEST_OUTPUT) / info->test_suite_name() / info->name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

// Null where this machine has no way to draw.
inline std::unique_ptr<render::Context> open_or_null() {
  try {
    return render::open_context(render::Backend::automatic, 64, 64);
  } catch (const std::runtime_error&) {
    return nullptr;
  }
}

class Driver {
 public:
  Driver(render::Context& context, rheo::Scene scene, fs::path folder, app::view::PictureStyle style = {})
      : Driver(context, std::move(scene), settings(std::move(folder), style)) {}
  Driver(render::Context& context, rheo::Scene scene, app::view::UiSettings settings)
      : physics(std::move(scene), app::view::CoreSettings{}), ui(context, physics, std::move(settings)) {
    frames(3);
  }

  static app::view::UiSettings settings(fs::path folder, const app::view::PictureStyle& style) {
    app::view::UiSettings s;
    s.scene = fs::path(RHEO_SOURCE_DIR) / "app" / "scenes" / "beam.toml";
    s.folder = std::move(folder);
    s.style = style;
    s.read = [](const fs::path& file) { return rheo::read_scene(file); };
    return s;
  }

  void frame() {
    ui.frame(input);
    input.wheel = 0.0f;
    input.text.clear();
    input.dropped.clear();
  }
  void frames(int count) {
    for (int k = 0; k < count; ++k) frame();
  }
  void move(float x, float y) {
    input.cursor = {x, y};
    frame();
  }
  void press(int button = 0) {
    input.buttons[static_cast<std::size_t>(button)] = true;
    frame();
  }
  void release(int button = 0) {
    input.buttons[static_cast<std::size_t>(button)] = false;
    frame();
  }
  void click(float x, float y) {
    move(x, y);
    frame();
    press();
    release();
  }
  void key(Key key) {
    input.down = {key};
    frame();
    input.down.clear();
    frame();
  }
  void key_with_control(Key with) {
    input.control = true;
    key(with);
    input.control = false;
  }
  // Frames until it is so; false after a minute.
  bool until(const std::function<bool(const Display&)>& holds) {
    const auto begin = std::chrono::steady_clock::now();
    while (!holds(ui.shown())) {
      if (std::chrono::steady_clock::now() - begin > std::chrono::minutes(1)) return false;
      frame();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }
  // So many ticks of a paused body, all of them shown.
  bool ticks(int count) {
    const std::int64_t end = ui.shown().ticks + count;
    physics.step(count);
    return until([&](const Display& d) { return d.ticks >= end; });
  }
  // Where a point of the plane is in the window.
  std::array<float, 2> pixel(double x, double y) {
    const auto [px, py] = ui.picture().plane().pixel(x, y);
    return {static_cast<float>(px) + static_cast<float>(ui.picture_area()[0]),
            static_cast<float>(py) + static_cast<float>(ui.picture_area()[1])};
  }
  bool says(const std::string& part) const {
    return std::ranges::any_of(
        ui.labels(), [&](const std::string& label) { return label.find(part) != std::string::npos; });
  }
  const app::view::Widgets::Seen* widget(const std::string& name) const {
    for (const auto& widget : ui.widgets())
      if (widget.name == name) return &widget;
    return nullptr;
  }
  bool click_widget(const std::string& name) {
    const auto* found = widget(name);
    if (found == nullptr) return false;
    click(found->x0 + std::min(12.0f, (found->x1 - found->x0) / 2), (found->y0 + found->y1) / 2);
    return true;
  }

  // Into a field, in the place of what is there.
  bool type_into(const std::string& name, const std::string& text) {
    if (!click_widget(name)) return false;
    key_with_control(key_of('A'));
    for (const char letter : text) {
      input.text = {static_cast<unsigned char>(letter)};
      frame();
    }
    key(Key::enter);
    frame();
    return true;
  }

  app::view::Physics physics;
  app::view::Input input;
  app::view::Ui ui;
};

}  // namespace view_tests
