#include "view/view_setup.hpp"

#include "memory_need.hpp"
#include "overrides.hpp"

namespace app {

ViewSetup view_setup(const Options& options) {
  ViewSetup setup;
  setup.scene = load_scene(options);
  require_memory(setup.scene, options);
  setup.size = options.size.value_or(std::array<int, 2>{1280, 720});
  setup.ui.scene = options.scene;
  setup.ui.folder = options.folder;
  setup.ui.style = view::style_of(setup.scene.picture);
  // A scene that is loaded later is taken as it is, but for what a stranger's may do.
  setup.ui.read = [read = options.read](const std::filesystem::path& file) {
    Options other;
    other.command = Command::view;
    other.scene = file;
    other.read = read;
    rheo::Scene scene = load_scene(other);
    require_memory(scene, other);
    return scene;
  };
  setup.core.simulation = options.simulation;
  return setup;
}

}  // namespace app
