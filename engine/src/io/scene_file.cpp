#include "rheo/io/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "io/allowance.hpp"
#include "io/bodies_reader.hpp"
#include "io/body_reader.hpp"
#include "io/message.hpp"
#include "io/read_file.hpp"
#include "io/table_reader.hpp"
#include "io/table_set.hpp"
#include "io/toml_tree.hpp"
#include "rheo/error.hpp"

namespace rheo {
namespace {

constexpr std::size_t most_bytes = std::size_t{64} << 20;

class SceneReader {
 public:
  SceneReader(const std::string& text, const std::string& file, const std::filesystem::path& folder,
              const ReadOptions& options)
      : file_(file),
        most_outputs_(options.outputs),
        allowance_{FileAccess(folder, options.outside), MemoryBudget(memory_limit(options.memory))},
        root_(parse_toml(text, file, allowance_.memory)),
        tables_(root_, file_, "", 1) {}

  Scene read() {
    if (root_.entries.empty()) {
      throw Error(Error::Kind::input,
                  fmt::format("{}:1: the scene is empty: [mesh], [material] and [time] are needed", file_));
    }
    std::vector<std::string> keys = body_keys();
    keys.insert(keys.begin(), "title");
    keys.insert(keys.end(), {"body", "body_force", "time", "render"});
    const TableReader top(root_, file_, "", 1, keys);
    if (tables_.has("body"))
      scene_ = read_bodies(root_, file_, allowance_);
    else
      scene_ = read_body(root_, file_, allowance_, "", 1);
    scene_.title = top.text("title", std::filesystem::path(file_).filename().string());
    read_body_force();
    read_time();
    read_render();
    try {
      validate(scene_);
    } catch (const Error& error) {  // items name their own place
      const std::string_view message = error.what();
      throw message.starts_with(file_) ? error : Error(error.kind(), fmt::format("{}: {}", file_, message));
    }
    return std::move(scene_);
  }

 private:
  void read_body_force() {
    const TableReader body = tables_.table("body_force", {"acceleration"});
    scene_.body_acceleration = body.pair("acceleration", {.unit = "m/s^2"}, {});
  }

  void read_time() {
    const TableReader time = tables_.required_table(
        "time", "duration",
        {"duration", "frame_rate", "integrator", "step", "accuracy", "baumgarte", "constraints"});
    static const std::array<std::string, 4> integrators{"rk4", "euler", "exponential", "implicit"};
    static const std::array<std::string, 2> methods{"auto", "baumgarte"};
    constexpr NumberRule seconds{.low = 0.0, .low_allowed = false, .unit = "s"};
    TimeSettings& t = scene_.time;
    t.most_outputs = most_outputs_;
    t.duration = time.required_number("duration", seconds, "how long the run is");
    t.frame_rate = time.number("frame_rate", {.low = 0.0, .low_allowed = false, .unit = "outputs per second"},
                               t.frame_rate);
    if (time.find("integrator") != nullptr)
      t.integrator = static_cast<IntegratorKind>(time.choice("integrator", integrators, 0));
    if (const TomlValue* step = time.find("step"); step != nullptr && step->text != "auto") {
      if (!step->is_number() || !seconds.admits(step->number)) {
        time.refuse("step", *step, fmt::format("\"auto\" or {} is needed", seconds.allowed()));
      }
      t.step = step->number;
    }
    if (const TomlValue* accuracy = time.find("accuracy")) {
      constexpr NumberRule rule{.low = finest_accuracy, .high = coarsest_accuracy};
      t.accuracy = time.number("accuracy", rule, 0.0);
      if (t.step > 0.0) {
        time.refuse("accuracy", *accuracy,
                    fmt::format("step = {:g} decides already; leave out one of the two", t.step));
      }
    }
    // Of what decides the step.
    const TomlValue* decides = time.find(t.accuracy > 0.0 ? "accuracy"
                                         : t.step > 0.0   ? "step"
                                                          : "integrator");
    t.where = decides == nullptr ? time.where() : time.where(*decides);
    t.baumgarte = time.number("baumgarte", {.low = 0.0, .unit = "1/s"}, t.baumgarte);
    t.constraints = static_cast<ConstraintMethod>(time.choice("constraints", methods, 0));
    time.locate([&] { validate(t); });
  }

  void read_render() {
    const TableReader render = tables_.table(
        "render", {"color", "branch", "range", "size", "every", "bounds", "arrow_scale", "sheet"});
    static const std::array<std::string, 5> colors{"w_lambda", "w_mu", "w", "speed", "none"};
    PictureSettings& p = scene_.picture;
    p.color = static_cast<ColorBy>(render.choice("color", colors, 0));
    if (const TomlValue* branch = render.find("branch")) {
      p.branch = render.integer("branch", *branch, 0, static_cast<int>(most_branches(scene_)),
                                "whole number, 0 for all Maxwell branches or one of them,");
    }
    if (const TomlValue* range = render.find("range"); range != nullptr && range->text != "auto") {
      if (range->type != TomlValue::Type::array) {
        render.refuse("range", *range, "\"auto\" or [low, high] is needed");
      }
      const auto finite = [](const TomlValue& x) { return x.is_number() && std::isfinite(x.number); };
      if (range->items.size() != 2 || !finite(range->items[0]) || !finite(range->items[1])) {
        render.refuse("range", *range, "\"auto\" or [low, high], each a finite number, is needed");
      }
      const Vec2 limits = render.pair("range", *range, {});
      p.range_auto = false;
      p.range = {limits.x, limits.y};
    }
    if (const TomlValue* size = render.find("size")) {
      if (size->type != TomlValue::Type::array || size->items.size() != 2) {
        render.refuse(
            "size", *size,
            fmt::format("[width, height], from {} x {} to {} x {} pixels, is needed", min_picture_size[0],
                        min_picture_size[1], max_picture_side, max_picture_side));
      }
      const double width = size->items[0].number, height = size->items[1].number;
      if (std::max(width, height) > max_picture_side && std::min(width, height) > 0.0 &&
          std::isfinite(width * height)) {
        render.refuse(
            "size", *size,
            fmt::format("about {} of memory; a width of {} to {} and a height of {} to {} pixels are "
                        "allowed, which OpenGL draws",
                        memory_text(bytes_a_pixel * width * height), min_picture_size[0], max_picture_side,
                        min_picture_size[1], max_picture_side));
      }
      for (std::size_t i = 0; i < 2; ++i) {
        p.size[i] = render.integer(fmt::format("size[{}]", i), size->items[i], min_picture_size[i],
                                   max_picture_side, "whole number of pixels");
      }
    }
    if (const TomlValue* every = render.find("every"))
      p.every = render.integer("every", *every, 1, most_every,
                               "whole number of outputs from one frame to the next,");
    p.arrow_scale = render.number("arrow_scale", {.low = 0.0, .low_allowed = false, .unit = "Pa"}, 0.0);
    if (const TomlValue* bounds = render.find("bounds")) read_bounds(render, *bounds);
    if (const TomlValue* sheet = render.find("sheet")) read_sheet(render, *sheet);
    render.locate([&] { validate(p); });
  }

  void read_bounds(const TableReader& render, const TomlValue& bounds) {
    constexpr NumberRule metres{.unit = "m"};
    std::array<double, 4> b{};
    bool fits = bounds.type == TomlValue::Type::array && bounds.items.size() == b.size();
    for (std::size_t k = 0; fits && k < b.size(); ++k) {
      fits = bounds.items[k].is_number() && metres.admits(bounds.items[k].number);
      if (fits) b[k] = bounds.items[k].number;
    }
    if (!fits || !(b[0] < b[2]) || !(b[1] < b[3]))
      render.refuse("bounds", bounds, "[x0, y0, x1, y1] with x0 < x1 and y0 < y1 (m) is needed");
    scene_.picture.bounds = b;
  }

  void read_sheet(const TableReader& render, const TomlValue& sheet) {
    std::vector<double>& times = scene_.picture.sheet;
    if (sheet.items.size() > most_sheet_times)
      render.refuse(
          "sheet", sheet,
          fmt::format("{} times: at most {} shapes are drawn", sheet.items.size(), most_sheet_times));
    bool fits = sheet.type == TomlValue::Type::array && !sheet.items.empty();
    for (std::size_t k = 0; fits && k < sheet.items.size(); ++k) {
      const TomlValue& item = sheet.items[k];  // a time, or [time, "caption"]
      const bool captioned = item.type == TomlValue::Type::array && item.items.size() == 2 &&
                             item.items[1].type == TomlValue::Type::string;
      const TomlValue& time = captioned ? item.items[0] : item;
      fits = time.is_number() && time.number >= 0.0 && time.number <= scene_.time.duration &&
             (times.empty() || time.number > times.back());
      if (!fits) break;
      times.push_back(time.number);
      scene_.picture.captions.push_back(captioned ? item.items[1].text : "");
    }
    if (!fits)
      render.refuse(
          "sheet", sheet,
          fmt::format("a list of times, or of [time, \"caption\"], strictly rising from 0 to the duration, "
                      "{:g} s, is needed",
                      scene_.time.duration));
  }

  const std::string& file_;
  double most_outputs_;
  Allowance allowance_;
  TomlValue root_;
  TableSet tables_;
  Scene scene_;
};

}  // namespace

Scene read_scene(const std::filesystem::path& file, const ReadOptions& options) {
  return parse_scene(read_file(file, "scene", most_bytes), file.string(), file.parent_path(), options);
}

Scene parse_scene(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                  const ReadOptions& options) {
  return SceneReader(text, name, folder, options).read();
}

}  // namespace rheo
