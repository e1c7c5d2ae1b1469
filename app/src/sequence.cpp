#include "sequence.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "body_labels.hpp"
#include "flat_rows.hpp"
#include "frame_outputs.hpp"
#include "loaded_edges.hpp"
#include "node_scalars.hpp"
#include "render/context.hpp"
#include "render/mesh_picture.hpp"
#include "render/plot.hpp"
#include "render/png.hpp"
#include "render_backend.hpp"
#include "scene_parts.hpp"
#include "sheet_frames.hpp"

namespace app {
namespace {

// A recorded output with its own memory, as the renderer's view of it.
struct LoadedFrame {
  std::vector<double> positions{}, scalar{};
  std::vector<render::TractionArrow> arrows{};
  const RecordedLoads* loads = nullptr;
  bool bare = false;  // nothing to colour

  void load(const Recorder& recorder, const LoadedEdges& edges, std::int64_t k) {
    recorder.read(k, positions, scalar);
    if (bare) scalar.clear();
    loads = &recorder.loads(k);
    arrows = edges.arrows(loads->tractions, positions);
  }

  render::MeshFrame view() const {
    return {
        .positions = positions, .scalar = scalar, .held = *loads->held, .arrows = arrows, .time = loads->t};
  }
};

// Of the shape that the scene asked for nearest to this output.
std::string_view caption_at(const rheo::Scene& scene, double t) {
  const rheo::PictureSettings& picture = scene.picture;
  for (std::size_t i = 0; i < picture.captions.size(); ++i)
    if (std::llround(picture.sheet[i] * scene.time.frame_rate) == std::llround(t * scene.time.frame_rate))
      return picture.captions[i];
  return {};
}

std::string all_captions(const rheo::Scene& scene) {
  std::string all;
  for (const std::string& caption : scene.picture.captions) all += caption;
  return all;
}

double largest_traction(const Recorder& recorder, const LoadedEdges& edges) {
  double largest = 0.0;
  for (std::int64_t k = 0; k < recorder.count(); ++k)
    for (const auto& [x, y] : edges.sums(recorder.loads(k).tractions))
      largest = std::max(largest, std::hypot(x, y));
  return largest;
}

std::array<double, 2> colour_range(const rheo::PictureSettings& picture, const Recorder& recorder) {
  if (!picture.range_auto) return picture.range;
  std::array<double, 2> range = recorder.scalar_range().value_or(std::array<double, 2>{0.0, 1.0});
  // One value everywhere: any width will do, and the picture is all of the lowest colour.
  if (!(range[1] > range[0])) range[1] = range[0] + (range[0] != 0.0 ? std::abs(range[0]) : 1.0);
  return range;
}

}  // namespace

struct Sequence::Impl {
  std::unique_ptr<render::Context> context;
  int threads = 1;
  std::optional<int> shapes;
  bool bare = false;  // nothing to colour
  DrawCounters counters;

  bool draw_frames(render::MeshPicture& picture, const Recorder& recorder, int every,
                   const LoadedEdges& edges, OutputFolder& folder, Progress& progress, Seconds& seconds,
                   const DrawHooks& hooks) const {
    render::PngSequence png(threads);
    LoadedFrame frame{.bare = bare};
    const std::int64_t count = frame_count(recorder.count(), every);
    progress.begin("drawing", count);
    std::int64_t k = 0;
    for (; k < count && hooks.goes_on(); ++k) {
      if (hooks.is_there(k)) continue;
      render::Image image = png.recycle();
      {
        const Timed timed(seconds.draw);
        frame.load(recorder, edges, frame_output(k, recorder.count(), every));
        picture.draw(frame.view(), image);
      }
      const Timed timed(seconds.encode);
      png.submit(std::move(image), folder.file(frame_name(k)));
      progress.update(k + 1);
    }
    {
      const Timed timed(seconds.encode);
      png.finish();
    }
    for (std::int64_t made = 0; made < k; ++made) folder.made(frame_name(made));
    progress.end();
    return k == count;
  }

  std::vector<std::int64_t> sheet_outputs(const rheo::Scene& scene, std::int64_t outputs) const {
    const std::vector<double>& asked = scene.picture.sheet;
    if (!asked.empty() && !shapes) return frames_at(asked, outputs, scene.time.frame_rate);
    return sheet_frames(outputs, scene.time.frame_rate, event_times(scene), shapes,
                        render::sheet_room(scene.picture.size[0], scene.picture.size[1]));
  }

  void draw_sheet(const rheo::Scene& scene, render::MeshPicture& picture, const Recorder& recorder,
                  const LoadedEdges& edges, OutputFolder& folder, Seconds& seconds) const {
    std::vector<LoadedFrame> frames;
    std::vector<render::MeshFrame> views;
    render::Image image;
    {
      const Timed timed(seconds.draw);
      std::vector<std::int64_t> outputs = sheet_outputs(scene, recorder.count());
      // All are kept, but for a run that diverged: its sheet is not the one that was planned.
      for (std::int64_t& k : outputs) k = recorder.nearest_kept(k);
      outputs.erase(std::unique(outputs.begin(), outputs.end()), outputs.end());
      for (const std::int64_t k : outputs)
        frames.emplace_back(LoadedFrame{.bare = bare}).load(recorder, edges, k);
      for (const LoadedFrame& frame : frames) {
        views.push_back(frame.view());
        views.back().caption = caption_at(scene, views.back().time);
      }
      image = picture.sheet(views);
    }
    const Timed timed(seconds.encode);
    render::write_png(folder.file("sheet.png"), image);
    folder.made("sheet.png");
  }

  void draw_residual(const rheo::Scene& scene, const HistoryFile& history, OutputFolder& folder,
                     Seconds& seconds) const {
    render::Plot plot;
    plot.title = scene.title.empty() ? "Residual forces" : scene.title + ": residual forces";
    plot.x_label = "t [s]";
    plot.y_label = "|w| [Pa m]";
    plot.series.push_back({.name = "|w_lambda|", .x = history.times(), .y = history.w_lambda_norms()});
    plot.series.push_back({.name = "|w_mu|", .x = history.times(), .y = history.w_mu_norms()});
    // The axes show time from 0 to where the run went, and norms from 0, even of one output or a scene at
    // rest. Two equal points draw nothing, but count for the axes.
    const bool whole = history.times().size() == static_cast<std::size_t>(rheo::output_count(scene.time));
    const double end = whole || history.times().back() <= 0.0 ? scene.time.duration : history.times().back();
    const double top =
        std::max(std::ranges::max(history.w_lambda_norms()), std::ranges::max(history.w_mu_norms()));
    const double highest = top > 0.0 ? top : 1.0;
    const std::array<double, 2> zeros{}, end_x{end, end}, end_y{highest, highest};
    plot.series.push_back({.name = "", .x = zeros, .y = zeros});
    plot.series.push_back({.name = "", .x = end_x, .y = end_y});
    for (const double t : event_times(scene))
      if (t <= history.times().back()) plot.marks.push_back(t);
    render::Image image;
    {
      const Timed timed(seconds.draw);
      image = render::draw_plot(*context, plot);
    }
    const Timed timed(seconds.encode);
    render::write_png(folder.file("residual.png"), image);
    folder.made("residual.png");
  }
};

Sequence::Sequence(const rheo::PictureSettings& picture, const Options& options) : impl_(new Impl) {
  impl_->context = render::open_context(backend_of(options.backend), picture.size[0], picture.size[1]);
  impl_->threads = options.threads;
  impl_->shapes = options.sheet;
}

Sequence::~Sequence() = default;

std::string Sequence::description() const {
  return impl_->context->description();
}

std::vector<std::int64_t> Sequence::sheet_outputs(const rheo::Scene& scene, std::int64_t outputs) const {
  return impl_->sheet_outputs(scene, outputs);
}

DrawCounters Sequence::counters() const {
  return impl_->counters;
}

bool Sequence::draw(const rheo::Scene& scene, const Recorder& recorder, const HistoryFile& history,
                    OutputFolder& folder, Progress& progress, Seconds& seconds, const DrawHooks& hooks) {
  if (recorder.count() == 0) return true;
  const std::vector<double> rest = flat(scene.mesh.points);
  const std::vector<int> triangles = flat_numbers(scene.mesh.triangles);
  const std::vector<int> boundary = flat_numbers(scene.mesh.edge_groups.at("boundary"));
  const std::vector<int> interfaces = interfaces_of(scene);
  const std::vector<render::BodyLabel> labels = body_labels(scene);
  const LoadedEdges edges(scene);
  const bool bare = nothing_to_colour(scene.picture, recorder);
  const ScalarText scalar = scalar_text(scene.picture.color, scene.picture.branch);
  const render::MeshLayout layout{
      .rest = rest,
      .triangles = triangles,
      .boundary = boundary,
      .interfaces = interfaces,
      .labels = labels,
      .letters = all_captions(scene),
      .title = scene.title,
      .scalar_name = bare ? "" : scalar.name,
      .scalar_unit = bare ? "" : scalar.unit,
      .range = colour_range(scene.picture, recorder),
      .bar_room = scene.picture.bounds ? render::BarRoom::fixed : render::BarRoom::as_needed,
      .bounds = scene.picture.bounds.value_or(recorder.bounds()),
      .arrow_scale =
          scene.picture.arrow_scale > 0.0 ? scene.picture.arrow_scale : largest_traction(recorder, edges)};
  impl_->bare = bare;
  render::MeshPicture picture(*impl_->context, layout);
  if (!impl_->draw_frames(picture, recorder, scene.picture.every, edges, folder, progress, seconds, hooks))
    return false;
  impl_->draw_sheet(scene, picture, recorder, edges, folder, seconds);
  const render::PictureCounters counted = picture.counters();
  impl_->counters = {counted.frames_drawn, counted.frames_repeated, counted.mesh_uploads};
  impl_->draw_residual(scene, history, folder, seconds);
  return true;
}

}  // namespace app
