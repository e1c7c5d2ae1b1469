// What the command line asks of the window, as the window's parts take it.
//
// Errors   as load_scene (overrides.hpp), require_memory (memory_need.hpp)
#pragma once

#include <array>

#include "command_line.hpp"
#include "view/ui.hpp"

namespace app {

struct ViewSetup {
  rheo::Scene scene;
  std::array<int, 2> size{};  // of the window
  view::UiSettings ui;        // but for the display's scale
  view::CoreSettings core;
};
ViewSetup view_setup(const Options& options);

}  // namespace app
