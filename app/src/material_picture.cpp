#include "material_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "render/context.hpp"
#include "render/plot.hpp"
#include "render/png.hpp"
#include "render_backend.hpp"

namespace app {
namespace {

// Curves with their values too small to show taken out, kept as long as the plot that looks at them.
class Curves {
 public:
  explicit Curves(std::string title) {
    plot.title = std::move(title);
    plot.x_scale = plot.y_scale = render::Scale::log;
  }

  // A curve that is 0 all along is left out.
  void add(const std::string& name, const std::vector<double>& x, const std::vector<double>& y) {
    if (std::ranges::max(y) > 0.0) curves_.push_back({name, &x, y, Look::line});
  }
  void add_points(const std::string& name, const std::vector<double>& x, const std::vector<double>& y) {
    if (std::ranges::max(y) > 0.0) curves_.push_back({name, &x, y, Look::points});
  }

  bool empty() const { return curves_.empty(); }

  void draw(render::Context& context, OutputFolder& folder, const std::string& name) {
    constexpr double smallest_share = 1e-4;
    double largest = 0.0;
    for (const Curve& curve : curves_) largest = std::max(largest, std::ranges::max(curve.y));
    for (Curve& curve : curves_)
      for (double& y : curve.y)
        if (y < smallest_share * largest) y = std::numeric_limits<double>::quiet_NaN();
    for (const Curve& curve : curves_)
      plot.series.push_back({.name = curve.name,
                             .x = *curve.x,
                             .y = curve.y,
                             .markers = curve.look == Look::points,
                             .line = curve.look == Look::line});
    render::write_png(folder.file(name), render::draw_plot(context, plot));
    folder.made(name);
  }

  render::Plot plot;

 private:
  enum class Look { line, points };
  struct Curve {
    std::string name;
    const std::vector<double>* x;
    std::vector<double> y;
    Look look;
  };
  std::vector<Curve> curves_;
};

std::string titled(const rheo::Scene& scene, const std::string& what, const std::string& alone) {
  return scene.title.empty() ? alone : fmt::format("{}: {}", scene.title, what);
}

void draw_fit(const rheo::Scene& scene, const std::string& ending, render::Context& context,
              OutputFolder& folder) {
  const rheo::MeasuredMaterial& measured = *scene.origin.measured;
  const FitCurves fit = fit_curves_of(measured);
  const bool young = measured.modulus == rheo::MeasuredModulus::young;
  const char* modulus = young ? "Young's modulus" : "the shear modulus";
  const std::string what = fmt::format("fit of {}", modulus), alone = fmt::format("Fit of {}", modulus);
  Curves picture(fmt::format("{}, error {:.2g} % root mean square", titled(scene, what, alone),
                             100.0 * measured.fit.rms));
  picture.plot.y_label = young ? "E [Pa]" : "mu [Pa]";
  picture.plot.x_label = fit.sweep ? "frequency [Hz]" : "t [s]";
  if (fit.sweep) {
    picture.add("storage, fit", fit.x, fit.fit);
    picture.add_points("storage, measured", fit.data_x, fit.data);
    picture.add("loss, fit", fit.x, fit.fit_loss);
    picture.add_points("loss, measured", fit.data_x, fit.data_loss);
  } else {
    picture.add("fit", fit.x, fit.fit);
    picture.add_points("measured", fit.data_x, fit.data);
  }
  picture.draw(context, folder, "fit" + ending + ".png");
}

}  // namespace

std::vector<std::string> draw_material(const rheo::Scene& scene, const MaterialCurves& c,
                                       const std::string& ending, const Options& options,
                                       OutputFolder& folder) {
  std::vector<std::string> notes;
  const auto context =
      render::open_context(backend_of(options.backend), scene.picture.size[0], scene.picture.size[1]);
  const bool viscous = scene.material.viscous.lambda > 0.0 || scene.material.viscous.mu > 0.0;
  Curves relaxation(titled(scene, "relaxation", "Relaxation") +
                    (viscous ? ", without the viscous part's pulse at t = 0" : ""));
  relaxation.plot.x_label = "t [s]";
  relaxation.plot.y_label = "r [Pa]";
  relaxation.add("r_lambda", c.t, c.r_lambda);
  relaxation.add("r_mu", c.t, c.r_mu);
  if (relaxation.empty())
    notes.emplace_back("no relaxation.png: after t = 0 there is no stress, nothing is elastic or relaxes");
  else
    relaxation.draw(*context, folder, "relaxation" + ending + ".png");

  Curves moduli(titled(scene, "complex moduli", "Complex moduli"));
  moduli.plot.x_label = "frequency [Hz]";
  moduli.plot.y_label = "modulus [Pa]";
  moduli.add("lambda, storage", c.frequency, c.lambda_storage);
  moduli.add("lambda, loss", c.frequency, c.lambda_loss);
  moduli.add("mu, storage", c.frequency, c.mu_storage);
  moduli.add("mu, loss", c.frequency, c.mu_loss);
  if (moduli.empty())
    notes.emplace_back("no moduli.png: the material resists nothing");
  else
    moduli.draw(*context, folder, "moduli" + ending + ".png");

  if (scene.origin.measured) draw_fit(scene, ending, *context, folder);
  return notes;
}

}  // namespace app
