#include "view/view_setup.hpp"

#include "overrides.hpp"

namespace app {
namespace {

view::PictureStyle style_of(const rheo::PictureSettings& picture) {
  view::PictureStyle style;
  style.color = picture.color;
  if (!picture.range_auto) {
    style.range_mode = view::RangeMode::typed;
    style.typed = picture.range;
  }
  return style;
}

}  // namespace

ViewSetup view_setup(const Options& options) {
  ViewSetup setup;
  setup.scene = load_scene(options);
  setup.size = options.size.value_or(std::array<int, 2>{1280, 720});
  setup.ui.scene = options.scene;
  setup.ui.folder = options.folder;
  setup.ui.style = style_of(setup.scene.picture);
  // A scene that is loaded later is taken as it is, but for what a stranger's may do.
  setup.ui.read = [read = options.read](const std::filesystem::path& file) {
    Options other;
    other.scene = file;
    other.read = read;
    return load_scene(other);
  };
  setup.core.simulation = options.simulation;
  return setup;
}

}  // namespace app
