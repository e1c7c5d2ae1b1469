#include "io/body_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "io/material_reader.hpp"
#include "io/region_reader.hpp"
#include "io/scene_items.hpp"
#include "io/table_set.hpp"
#include "rheo/io/mesh_file.hpp"
#include "rheo/shapes.hpp"

namespace rheo {
namespace {

constexpr NumberRule positive_length{.low = 0.0, .low_allowed = false, .unit = "m"};

using Words = std::vector<std::string>;

class BodyReader {
 public:
  BodyReader(const TomlValue& root, const std::string& file, Allowance& allowance, const std::string& owner,
             int line)
      : file_(file), allowance_(allowance), owner_(owner), tables_(root, file, owner, line) {}

  Scene read() {
    read_mesh();
    read_material();
    read_regions();
    read_items();
    return std::move(scene_);
  }

 private:
  void read_mesh() {
    const TableReader mesh = tables_.required_table("mesh", "a shape, a file, or points and triangles",
                                                    {"shape", "size", "nodes", "diagonal", "radius", "rings",
                                                     "file", "points", "triangles", "thickness"});
    static const std::array<std::string, 3> sources{"shape", "file", "points"};
    const std::string source = mesh.exactly_one(sources);
    if (source == "shape") read_shape(mesh);
    if (source != "shape") refuse_other_keys(mesh, {"size", "nodes", "diagonal", "radius", "rings"}, "shape");
    if (source == "file") read_mesh_file(mesh);
    if (source != "points") refuse_other_keys(mesh, {"triangles"}, "points");
    if (source == "points") read_points(mesh);
    const TomlValue* const thickness = mesh.find("thickness");
    if (thickness != nullptr && thickness->type == TomlValue::Type::array)
      read_thickness(mesh, *thickness);
    else
      scene_.mesh.thickness = mesh.number("thickness", positive_length, 1.0);
  }

  // One a node, as sessions of bodies that differ are saved.
  void read_thickness(const TableReader& mesh, const TomlValue& list) {
    const auto nodes = static_cast<std::size_t>(scene_.mesh.node_count());
    if (list.items.size() != nodes)
      mesh.refuse("thickness", list,
                  fmt::format("one number, or one for each of the {} nodes, is needed (m)", nodes));
    for (std::size_t i = 0; i < nodes; ++i)
      scene_.mesh.thickness_of_node.push_back(
          mesh.number(fmt::format("thickness[{}]", i), list.items[i], positive_length));
    scene_.mesh.thickness = scene_.mesh.thickness_of_node.front();
    mesh.attribute("thickness", list, [&] { prepare(scene_.mesh); });  // a triangle has one
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
      mesh.attribute("rings", rings, [&] {
        scene_.mesh = disk(radius, count, allowance_.memory.left());
        take_mesh();
      });
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
    mesh.attribute("nodes", nodes, [&] {
      scene_.mesh = rectangle(extent, nx, ny, diagonal, allowance_.memory.left());
      take_mesh();
    });
  }

  void take_mesh() {
    const double nodes = scene_.mesh.node_count();
    allowance_.memory.take(bytes_a_shape_node * nodes, fmt::format("{:.3g} nodes", nodes), "take fewer");
  }

  void read_mesh_file(const TableReader& mesh) {
    const TomlValue& file = *mesh.find("file");
    const std::string name = mesh.text("file", {});
    if (name.empty()) mesh.refuse("file", file, "the name of a Gmsh file (.msh) is needed");
    mesh.attribute("file", file, [&] {
      const std::filesystem::path path = allowance_.files.resolve(name);
      LeftOutNodes left_out;
      scene_.mesh = read_msh(path, &left_out, allowance_.memory.left());
      take_mesh();
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
    mesh.attribute("triangles", triangles, [&] { note_turned(prepare(scene_.mesh)); });
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
        tables_.required_value_of(
            "material", "lambda_ela, mu_ela, lambda_vis, mu_vis and density (or a preset, parts or data)"),
        file_, allowance_, owner_);
    scene_.material = std::move(reading.material);
    scene_.origin = std::move(reading.origin);
    scene_.files.insert(scene_.files.end(), reading.files.begin(), reading.files.end());
    scene_.notes.insert(scene_.notes.end(), reading.notes.begin(), reading.notes.end());
  }

  void read_regions() {
    for (const TomlValue& value : tables_.list("region"))
      read_region(value, file_, allowance_, owner_, scene_);
    check_regions(scene_);
    drop_unused_material();
  }

  // Where regions cover the mesh, nothing is of [material].
  void drop_unused_material() {
    std::vector<std::int32_t>& of = scene_.region_of_triangle;
    if (of.empty() || std::find(of.begin(), of.end(), 0) != of.end()) return;
    scene_.material = scene_.regions.front().material;
    scene_.origin = scene_.regions.front().origin;
    scene_.material_name = scene_.regions.front().name;
    scene_.regions.erase(scene_.regions.begin());
    for (std::int32_t& number : of) --number;
    if (scene_.regions.empty()) of.clear();
  }

  void read_items() {
    ItemReader items(scene_.mesh, scene_.files, file_, allowance_, owner_);
    if (const TomlEntry* edges = tables_.find("edges")) items.add_groups(*edges);
    for (const TomlValue& value : tables_.list("fix")) scene_.fixes.push_back(items.fix(value));
    for (const TomlValue& value : tables_.list("move")) scene_.moves.push_back(items.move(value));
    for (const TomlValue& value : tables_.list("constraint"))
      scene_.constraints.push_back(items.constraint(value));
    for (const TomlValue& value : tables_.list("traction")) scene_.tractions.push_back(items.traction(value));
    for (const TomlValue& value : tables_.list("probe")) scene_.probes.push_back(items.probe(value));
  }

  const std::string& file_;
  Allowance& allowance_;
  const std::string& owner_;
  TableSet tables_;
  Scene scene_;
};

}  // namespace

const std::vector<std::string>& body_keys() {
  static const Words keys{"mesh", "edges",      "material", "region", "fix",
                          "move", "constraint", "traction", "probe"};
  return keys;
}

Scene read_body(const TomlValue& root, const std::string& file, Allowance& allowance,
                const std::string& owner, int line) {
  return BodyReader(root, file, allowance, owner, line).read();
}

}  // namespace rheo
