#include "bench_picture.hpp"

#include <stdexcept>

#include "drawing_room.hpp"
#include "option_values.hpp"
#include "render/context.hpp"
#include "render/plot.hpp"
#include "render/png.hpp"
#include "render_backend.hpp"

namespace app {

std::string no_picture(const rheo::PictureSettings& picture, const Options& options) {
  try {
    require_drawing_room();
    render::open_context(backend_of(options.backend), picture.size[0], picture.size[1]);
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

void draw_bench(const std::filesystem::path& file, const rheo::Scene& scene, const std::vector<Row>& rows,
                const Options& options) {
  struct Curve {
    rheo::IntegratorKind integrator;
    std::vector<double> error, seconds;
  };
  std::vector<Curve> curves;
  for (const Row& row : rows) {
    if (curves.empty() || curves.back().integrator != row.setting.integrator)
      curves.push_back({row.setting.integrator, {}, {}});
    curves.back().error.push_back(row.error);
    curves.back().seconds.push_back(row.median());
  }
  render::Plot plot;
  plot.title = scene.title.empty() ? "Run time against error" : scene.title + ": run time against error";
  plot.x_label = "error, relative [1]";
  plot.y_label = "run time [s]";
  plot.x_scale = plot.y_scale = render::Scale::log;
  for (const Curve& curve : curves)
    plot.series.push_back(
        {.name = name_of(curve.integrator), .x = curve.error, .y = curve.seconds, .markers = true});
  const auto context =
      render::open_context(backend_of(options.backend), scene.picture.size[0], scene.picture.size[1]);
  render::write_png(file, render::draw_plot(*context, plot));
}

}  // namespace app
