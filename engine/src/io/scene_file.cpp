#include "rheo/io/scene_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "io/material_reader.hpp"
#include "io/message.hpp"
#include "io/read_file.hpp"
#include "io/scene_items.hpp"
#include "io/table_reader.hpp"
#include "io/toml_tree.hpp"
#include "rheo/error.hpp"
#include "rheo/io/mesh_file.hpp"
#include "rheo/shapes.hpp"

namespace rheo {
namespace {

constexpr std::size_t most_bytes = std::size_t{64} << 20;

constexpr NumberRule positive_length{.low = 0.0, .low_allowed = false, .unit = "m"};

using Words = std::vector<std::string>;

class SceneReader {
 public:
  SceneReader(const std::string& text, const std::string& file, std::filesystem::path folder)
      : file_(file), folder_(std::move(folder)), root_(parse_toml(text, file)) {}

  Scene read() {
    if (root_.entries.empty()) {
      throw Error(Error::Kind::input,
                  fmt::format("{}:1: the scene is empty: [mesh], [material] and [time] are needed", file_));
    }
    const TableReader top(root_, file_, "", 1,
                          {"title", "mesh", "edges", "material", "body_force", "fix", "move", "constraint",
                           "traction", "probe", "time", "render"});
    scene_.title = top.text("title", std::filesystem::path(file_).filename().string());
    read_mesh();
    read_material();
    read_body_force();
    read_items();
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
  // [name], empty where it is not there.
  const TomlValue& value_of(const std::string& name) const {
    static const TomlValue empty;
    const TomlEntry* entry = root_.find(name);
    if (entry == nullptr) return empty;
    if (entry->value.type == TomlValue::Type::array) {
      throw Error(Error::Kind::input, fmt::format("{}:{}: {} is a list: one table, [{}], is needed", file_,
                                                  entry->line, name, name));
    }
    return entry->value;
  }

  const TomlValue& required_value_of(const std::string& name, const char* meaning) const {
    if (root_.find(name) == nullptr) {
      throw Error(Error::Kind::input,
                  fmt::format("{}:1: [{}] is missing; needed: {}", file_, name, meaning));
    }
    return value_of(name);
  }

  TableReader table(const std::string& name, Words keys) const {
    const TomlValue& value = value_of(name);
    return TableReader(value, file_, fmt::format("[{}]", name), value.line, std::move(keys));
  }

  TableReader required_table(const std::string& name, const char* meaning, Words keys) const {
    required_value_of(name, meaning);
    return table(name, std::move(keys));
  }

  void read_mesh() {
    const TableReader mesh = required_table("mesh", "a shape, a file, or points and triangles",
                                            {"shape", "size", "nodes", "diagonal", "radius", "rings", "file",
                                             "points", "triangles", "thickness"});
    static const std::array<std::string, 3> sources{"shape", "file", "points"};
    const std::string source = mesh.exactly_one(sources);
    if (source == "shape") read_shape(mesh);
    if (source != "shape") refuse_other_keys(mesh, {"size", "nodes", "diagonal", "radius", "rings"}, "shape");
    if (source == "file") read_mesh_file(mesh);
    if (source != "points") refuse_other_keys(mesh, {"triangles"}, "points");
    if (source == "points") read_points(mesh);
    scene_.mesh.thickness = mesh.number("thickness", positive_length, 1.0);
  }

  // Keys that mean nothing beside the chosen ones.
  static void refuse_other_keys(const TableReader& mesh, const Words& keys, const std::string& owner) {
    for (const std::string& key : keys) {
      if (const TomlValue* value = mesh.find(key)) {
        mesh.refuse(key, *value, fmt::format("goes with {} only; leave it out here", owner));
      }
    }
  }

  void read_shape(const TableReader& mesh) {
    static const std::array<std::string, 2> shapes{"rectangle", "disk"};
    static const std::array<std::string, 3> diagonals{"falling", "rising", "alternating"};
    constexpr int most = std::numeric_limits<int>::max();
    const bool is_disk = mesh.choice("shape", shapes, 0) == 1;
    if (is_disk) {
      refuse_other_keys(mesh, {"size", "nodes", "diagonal"}, "shape = \"rectangle\"");
      const double radius = mesh.required_number("radius", positive_length, "the disk's radius");
      const TomlValue& rings =
          mesh.require("rings", "the number of rings of triangles, 1 or more, is needed");
      const int count = mesh.integer("rings", rings, 1, most, "whole number");
      mesh.attribute("rings", rings, [&] { scene_.mesh = disk(radius, count); });
      return;
    }
    refuse_other_keys(mesh, {"radius", "rings"}, "shape = \"disk\"");
    const TomlValue& size = mesh.require("size", "[width, height] (m) is needed");
    const Vec2 extent = mesh.pair("size", size, positive_length);
    const TomlValue& nodes =
        mesh.require("nodes", "the numbers of nodes [across, upwards], each 2 or more, are needed");
    if (nodes.type != TomlValue::Type::array || nodes.items.size() != 2) {
      mesh.refuse("nodes", nodes, "two whole numbers [across, upwards], each 2 or more, are needed");
    }
    const int nx = mesh.integer("nodes[0]", nodes.items[0], 2, most, "whole number");
    const int ny = mesh.integer("nodes[1]", nodes.items[1], 2, most, "whole number");
    const auto diagonal = static_cast<Diagonal>(mesh.choice("diagonal", diagonals, 0));
    mesh.attribute("nodes", nodes, [&] { scene_.mesh = rectangle(extent, nx, ny, diagonal); });
  }

  void read_mesh_file(const TableReader& mesh) {
    const TomlValue& file = *mesh.find("file");
    const std::string name = mesh.text("file", {});
    if (name.empty()) mesh.refuse("file", file, "the name of a Gmsh file (.msh) is needed");
    const std::filesystem::path path = folder_ / name;
    mesh.attribute("file", file, [&] {
      LeftOutNodes left_out;
      scene_.mesh = read_msh(path, &left_out);
      note_left_out(left_out);
      scene_.files.push_back(path.string());
      note_turned(prepare(scene_.mesh, path.string()));
    });
  }

  void read_points(const TableReader& mesh) {
    for (const auto& row : mesh.rows("points", *mesh.find("points"), 2, "[x, y]").rows) {
      scene_.mesh.points.push_back({row[0], row[1]});
    }
    const TomlValue& triangles =
        mesh.require("triangles", "a list of [i, j, k], three numbers of points, is needed");
    for (const auto& row :
         mesh.integer_rows("triangles", triangles, 3, 0, scene_.mesh.node_count() - 1, "[i, j, k]")) {
      scene_.mesh.triangles.push_back({row[0], row[1], row[2]});
    }
    note_turned(prepare(scene_.mesh, mesh.where()));
  }

  void note_left_out(const LeftOutNodes& nodes) {
    if (nodes.count == 0) return;
    scene_.notes.push_back(
        nodes.count == 1 ? fmt::format("1 node without a triangle was left out: tag {}", nodes.first_tag)
                         : fmt::format("{} nodes without a triangle were left out, the "
                                       "first of them tag {}",
                                       nodes.count, nodes.first_tag));
  }

  void note_turned(int triangles) {
    if (triangles == 0) return;
    scene_.notes.push_back(triangles == 1
                               ? "1 clockwise triangle was turned round"
                               : fmt::format("{} clockwise triangles were turned round", triangles));
  }

  void read_material() {
    MaterialReading reading = rheo::read_material(
        required_value_of("material",
                          "lambda_ela, mu_ela, lambda_vis, mu_vis and density (or a preset, parts or data)"),
        file_, folder_);
    scene_.material = std::move(reading.material);
    scene_.origin = std::move(reading.origin);
    scene_.files.insert(scene_.files.end(), reading.files.begin(), reading.files.end());
    scene_.notes.insert(scene_.notes.end(), reading.notes.begin(), reading.notes.end());
  }

  void read_body_force() {
    const TableReader body = table("body_force", {"acceleration"});
    scene_.body_acceleration = body.pair("acceleration", {.unit = "m/s^2"}, {});
  }

  const std::vector<TomlValue>& list(const std::string& name) const {
    const TomlEntry* entry = root_.find(name);
    return tables_of(entry == nullptr ? nullptr : &entry->value, file_, name);
  }

  void read_items() {
    ItemReader items(scene_.mesh, scene_.files, file_, folder_);
    if (const TomlEntry* edges = root_.find("edges")) items.add_groups(*edges);
    for (const TomlValue& value : list("fix")) scene_.fixes.push_back(items.fix(value));
    for (const TomlValue& value : list("move")) scene_.moves.push_back(items.move(value));
    for (const TomlValue& value : list("constraint")) scene_.constraints.push_back(items.constraint(value));
    for (const TomlValue& value : list("traction")) scene_.tractions.push_back(items.traction(value));
    for (const TomlValue& value : list("probe")) scene_.probes.push_back(items.probe(value));
  }

  void read_time() {
    const TableReader time = required_table(
        "time", "duration",
        {"duration", "frame_rate", "integrator", "step", "accuracy", "baumgarte", "constraints"});
    static const std::array<std::string, 4> integrators{"rk4", "euler", "exponential", "implicit"};
    static const std::array<std::string, 2> methods{"auto", "baumgarte"};
    constexpr NumberRule seconds{.low = 0.0, .low_allowed = false, .unit = "s"};
    TimeSettings& t = scene_.time;
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
    const TableReader render = table("render", {"color", "branch", "range", "size"});
    static const std::array<std::string, 5> colors{"w_lambda", "w_mu", "w", "speed", "none"};
    PictureSettings& p = scene_.picture;
    p.color = static_cast<ColorBy>(render.choice("color", colors, 0));
    if (const TomlValue* branch = render.find("branch")) {
      p.branch = render.integer("branch", *branch, 0, static_cast<int>(scene_.material.branch_count()),
                                "Maxwell branch of the material, or 0 for all");
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
      for (std::size_t i = 0; i < 2; ++i) {
        p.size[i] = render.integer(fmt::format("size[{}]", i), size->items[i], min_picture_size[i],
                                   max_picture_side, "whole number of pixels");
      }
    }
    render.locate([&] { validate(p); });
  }

  const std::string& file_;
  std::filesystem::path folder_;
  TomlValue root_;
  Scene scene_;
};

}  // namespace

Scene read_scene(const std::filesystem::path& file) {
  return parse_scene(read_file(file, "scene", most_bytes), file.string(), file.parent_path());
}

Scene parse_scene(const std::string& text, const std::string& name, const std::filesystem::path& folder) {
  return SceneReader(text, name, folder).read();
}

}  // namespace rheo
