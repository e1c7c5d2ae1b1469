// Stands in for bench_picture.cpp in a build without the renderer.
#include "bench_picture.hpp"

namespace app {

std::string no_picture(const rheo::PictureSettings&, const Options&) {
  return "this build of rheo has no renderer (it was configured with RHEO_RENDER=OFF)";
}

void draw_bench(const std::filesystem::path&, const rheo::Scene&, const std::vector<Row>&, const Options&) {}

}  // namespace app
