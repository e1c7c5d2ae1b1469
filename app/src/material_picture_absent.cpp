// Stands in for material_picture.cpp in a build without the renderer.
#include "material_picture.hpp"

namespace app {

std::vector<std::string> draw_material(const rheo::Scene&, const MaterialCurves&, const std::string&,
                                       const Options&, OutputFolder&) {
  return {};
}

}  // namespace app
