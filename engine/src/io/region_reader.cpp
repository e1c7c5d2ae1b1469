#include "io/region_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "io/material_reader.hpp"
#include "io/message.hpp"
#include "io/table_reader.hpp"
#include "rheo/error.hpp"

namespace rheo {
namespace {

constexpr NumberRule metres{.unit = "m"};

using Inside = std::function<bool(Vec2)>;

// The numbers of a list of `count` finite ones.
std::vector<double> numbers(const TableReader& reader, const std::string& key, const char* form,
                            std::size_t count) {
  const TomlValue& value = *reader.find(key);
  const bool fits = value.type == TomlValue::Type::array && value.items.size() == count &&
                    std::all_of(value.items.begin(), value.items.end(), [](const TomlValue& item) {
                      return item.is_number() && metres.admits(item.number);
                    });
  if (!fits) reader.refuse(key, value, fmt::format("{}, finite numbers (m), is needed", form));
  std::vector<double> result;
  for (const TomlValue& item : value.items) result.push_back(item.number);
  return result;
}

Inside in_box(const TableReader& reader) {
  const std::vector<double> b = numbers(reader, "box", "[x0, y0, x1, y1]", 4);
  if (!(b[0] < b[2]) || !(b[1] < b[3]))
    reader.refuse("box", *reader.find("box"), "x0 < x1 and y0 < y1 are needed");
  return [b](Vec2 p) { return p.x >= b[0] && p.x <= b[2] && p.y >= b[1] && p.y <= b[3]; };
}

Inside in_disk(const TableReader& reader) {
  const std::vector<double> d = numbers(reader, "disk", "[x, y, radius]", 3);
  if (!(d[2] > 0.0)) reader.refuse("disk", *reader.find("disk"), "a radius > 0 is needed");
  return [d](Vec2 p) { return std::hypot(p.x - d[0], p.y - d[1]) <= d[2]; };
}

Inside in_polygon(const TableReader& reader) {
  const TomlValue& value = *reader.find("polygon");
  std::vector<Vec2> corners;
  for (const auto& row : reader.rows("polygon", value, 2, "[x, y]").rows) corners.push_back({row[0], row[1]});
  if (corners.size() < 3) reader.refuse("polygon", value, "three corners [x, y] or more are needed");
  return [corners](Vec2 p) {
    bool inside = false;
    for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
      const Vec2 a = corners[i], b = corners[j];
      if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
    }
    return inside;
  };
}

std::vector<std::int32_t> in_physical(const TableReader& reader, const Mesh& mesh) {
  const TomlValue& value = *reader.find("physical");
  const bool by_number = value.type == TomlValue::Type::integer;
  if (!by_number && value.type != TomlValue::Type::string)
    reader.refuse("physical", value, "the name or number of a physical surface is needed");
  std::string name = value.text;
  if (by_number) {
    const auto known =
        std::find_if(mesh.triangle_group_of_number.begin(), mesh.triangle_group_of_number.end(),
                     [&](const auto& group) { return group.first == value.integer; });
    name = known == mesh.triangle_group_of_number.end() ? std::string() : known->second;
  }
  if (const auto group = mesh.triangle_groups.find(name); group != mesh.triangle_groups.end())
    return group->second;
  if (mesh.triangle_groups.empty())
    reader.refuse("physical", value, "the mesh has no physical surface; give a box, a disk or a polygon");
  std::vector<std::string> names;
  for (const auto& [known, triangles] : mesh.triangle_groups) names.push_back(known);
  const std::string near = nearest_word(name, names);
  reader.refuse("physical", value,
                fmt::format("no such surface; {}the mesh has {}",
                            near.empty() ? "" : fmt::format("did you mean {}? ", in_quotes(near)),
                            word_list(names, "and")));
}

std::vector<std::int32_t> by_number(const TableReader& reader, const Mesh& mesh) {
  const TomlValue& value = *reader.find("triangles");
  const int last = mesh.triangle_count() - 1;
  if (value.type != TomlValue::Type::array || value.items.empty())
    reader.refuse("triangles", value, fmt::format("a list of triangle numbers from 0 to {} is needed", last));
  std::vector<std::int32_t> triangles;
  for (std::size_t k = 0; k < value.items.size(); ++k)
    triangles.push_back(
        reader.integer(fmt::format("triangles[{}]", k), value.items[k], 0, last, "triangle number"));
  return triangles;
}

std::vector<std::int32_t> in_shape(const Mesh& mesh, const Inside& inside) {
  std::vector<std::int32_t> triangles;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    Vec2 centroid;
    for (const int node : mesh.triangles[static_cast<std::size_t>(t)]) {
      const Vec2 p = mesh.points[static_cast<std::size_t>(node)];
      centroid.x += p.x / 3;
      centroid.y += p.y / 3;
    }
    if (inside(centroid)) triangles.push_back(t);
  }
  return triangles;
}

}  // namespace

void read_region(const TomlValue& table, const std::string& file, Allowance& allowance,
                 const std::string& owner, Scene& scene) {
  static const std::array<std::string, 5> ways{"physical", "box", "disk", "polygon", "triangles"};
  const TableReader reader(table, file, fmt::format("[[{}region]]", owner), table.line,
                           {"name", "physical", "box", "disk", "polygon", "triangles", "material"});
  Region region;
  region.where = reader.where();
  region.name = reader.text("name", fmt::format("region {}", scene.regions.size() + 1));
  const bool taken = std::any_of(scene.regions.begin(), scene.regions.end(),
                                 [&](const Region& other) { return other.name == region.name; });
  if (region.name.empty() || region.name == "material" || taken)
    reader.refuse_text(
        "name", region.name,
        "each region needs a name of its own, not empty and not \"material\", which the rest has");
  const std::string way = reader.exactly_one(ways);
  const std::vector<std::int32_t> triangles = way == "physical"    ? in_physical(reader, scene.mesh)
                                              : way == "triangles" ? by_number(reader, scene.mesh)
                                              : way == "box"       ? in_shape(scene.mesh, in_box(reader))
                                              : way == "disk"      ? in_shape(scene.mesh, in_disk(reader))
                                                                   : in_shape(scene.mesh, in_polygon(reader));
  if (triangles.empty())
    reader.refuse(way, *reader.find(way), "no triangle of the mesh has its centroid in it");
  const TomlValue& material = reader.require(
      "material", fmt::format("[{}region.material], as [{}material], is needed", owner, owner));
  if (material.type != TomlValue::Type::table)
    reader.refuse("material", material, fmt::format("one table, [{}region.material], is needed", owner));
  MaterialReading reading = read_material(material, file, allowance, owner + "region.");
  if (material.find("mass") == nullptr) reading.material.mass = scene.material.mass;
  region.material = std::move(reading.material);
  region.origin = std::move(reading.origin);
  scene.files.insert(scene.files.end(), reading.files.begin(), reading.files.end());
  for (const std::string& note : reading.notes)
    scene.notes.push_back(fmt::format("{}: {}", region.name, note));
  scene.regions.push_back(std::move(region));
  scene.region_of_triangle.resize(static_cast<std::size_t>(scene.mesh.triangle_count()), 0);
  for (const std::int32_t t : triangles)
    scene.region_of_triangle[static_cast<std::size_t>(t)] = static_cast<std::int32_t>(scene.regions.size());
}

void check_regions(const Scene& scene) {
  for (std::size_t r = 0; r < scene.regions.size(); ++r) {
    const auto number = static_cast<std::int32_t>(r) + 1;
    if (std::find(scene.region_of_triangle.begin(), scene.region_of_triangle.end(), number) ==
        scene.region_of_triangle.end()) {
      throw Error(Error::Kind::input,
                  fmt::format("{} later regions have taken all of its triangles", scene.regions[r].where));
    }
  }
}

}  // namespace rheo
