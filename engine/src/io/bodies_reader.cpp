#include "io/bodies_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "io/body_reader.hpp"
#include "io/message.hpp"
#include "io/table_set.hpp"
#include "rheo/error.hpp"

namespace rheo {
namespace {

constexpr NumberRule metres{.unit = "m"};
constexpr double farthest = 1e6;  // times a body's size

// The diagonal of the box around it.
double size_of(const Mesh& mesh) {
  Vec2 low = mesh.points.front(), high = low;
  for (const Vec2& p : mesh.points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return std::hypot(high.x - low.x, high.y - low.y);
}

constexpr NumberRule radians{.low = -1e3, .high = 1e3, .unit = "rad, counter-clockwise"};

template <typename T>
void append(std::vector<T>& to, std::vector<T>&& more) {
  to.insert(to.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

// Puts one body after the other into one scene.
class Assembly {
 public:
  explicit Assembly(Scene& scene) : scene_(scene) {}

  // `where`: of the body's material, for messages.
  void add(Scene&& body, const std::string& name, const std::string& where) {
    first_node_ = scene_.mesh.node_count();
    BodyPart part{name, first_node_, body.mesh.node_count(), scene_.mesh.triangle_count(),
                  body.mesh.triangle_count()};
    add_materials(body, name, where);
    add_mesh(body.mesh, name);
    for (Fix& fix : body.fixes) shift(fix.nodes);
    for (Move& move : body.moves) shift(move.nodes);
    for (Constraint& constraint : body.constraints)
      for (ConstraintTerm& term : constraint.terms) term.node += first_node_;
    for (Traction& traction : body.tractions) shift(traction.edges);
    for (Probe& probe : body.probes) shift(probe.nodes), shift(probe.edges);
    append(scene_.fixes, std::move(body.fixes));
    append(scene_.moves, std::move(body.moves));
    append(scene_.constraints, std::move(body.constraints));
    append(scene_.tractions, std::move(body.tractions));
    append(scene_.probes, std::move(body.probes));
    for (const std::string& note : body.notes) scene_.notes.push_back(fmt::format("{}: {}", name, note));
    for (std::string& file : body.files) {
      if (std::find(scene_.files.begin(), scene_.files.end(), file) == scene_.files.end())
        scene_.files.push_back(std::move(file));
    }
    scene_.bodies.push_back(std::move(part));
  }

 private:
  void shift(std::vector<int>& nodes) const {
    for (int& node : nodes) node += first_node_;
  }
  void shift(std::vector<Edge>& edges) const {
    for (Edge& edge : edges) edge[0] += first_node_, edge[1] += first_node_;
  }

  // Number of a material in the scene: one that is there already, or a new one.
  std::int32_t material_number(const Material& material, const MaterialOrigin& origin,
                               const std::string& name, const std::string& where) {
    if (scene_.bodies.empty() && !any_material_) {
      any_material_ = true;
      scene_.material = material;
      scene_.origin = origin;
      scene_.material_name = name;
      return 0;
    }
    if (scene_.material == material) return 0;
    for (std::size_t r = 0; r < scene_.regions.size(); ++r)
      if (scene_.regions[r].material == material) return static_cast<std::int32_t>(r) + 1;
    scene_.regions.push_back({name, material, origin, where});
    return static_cast<std::int32_t>(scene_.regions.size());
  }

  void add_materials(const Scene& body, const std::string& name, const std::string& where) {
    const std::string own =
        body.material_name.empty() ? name : fmt::format("{}.{}", name, body.material_name);
    std::vector<std::int32_t> number{material_number(body.material, body.origin, own, where)};
    for (const Region& region : body.regions)
      number.push_back(material_number(region.material, region.origin,
                                       fmt::format("{}.{}", name, region.name), region.where));
    std::vector<std::int32_t>& all = scene_.region_of_triangle;
    const auto triangles = static_cast<std::size_t>(body.mesh.triangle_count());
    for (std::size_t t = 0; t < triangles; ++t)
      all.push_back(
          number[body.region_of_triangle.empty() ? 0 : static_cast<std::size_t>(body.region_of_triangle[t])]);
  }

  void add_mesh(const Mesh& mesh, const std::string& name) {
    Mesh& all = scene_.mesh;
    const auto first_triangle = static_cast<std::int32_t>(all.triangle_count());
    all.points.insert(all.points.end(), mesh.points.begin(), mesh.points.end());
    for (int node = 0; node < mesh.node_count(); ++node)
      all.thickness_of_node.push_back(mesh.thickness_at(node));
    for (Triangle t : mesh.triangles) {
      for (int& node : t) node += first_node_;
      all.triangles.push_back(t);
    }
    for (const auto& [group, members] : mesh.edge_groups) {
      std::vector<Edge> edges = members;
      shift(edges);
      std::vector<Edge>& boundary = all.edge_groups["boundary"];
      if (group == "boundary") boundary.insert(boundary.end(), edges.begin(), edges.end());
      all.edge_groups[fmt::format("{}.{}", name, group)] = std::move(edges);
    }
    for (const auto& [group, members] : mesh.triangle_groups) {
      std::vector<std::int32_t>& triangles = all.triangle_groups[fmt::format("{}.{}", name, group)];
      for (const std::int32_t t : members) triangles.push_back(t + first_triangle);
    }
  }

  Scene& scene_;
  int first_node_ = 0;
  bool any_material_ = false;
};

void place(Mesh& mesh, Vec2 position, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  for (Vec2& p : mesh.points) {
    if (angle != 0.0) p = {c * p.x - s * p.y, s * p.x + c * p.y};
    p = {p.x + position.x, p.y + position.y};
  }
}

}  // namespace

Scene read_bodies(const TomlValue& root, const std::string& file, Allowance& allowance) {
  for (const std::string& key : body_keys()) {
    if (const TomlEntry* entry = root.find(key))
      throw Error(Error::Kind::input, fmt::format("{}:{}: {} beside [[body]]: each body has its own, body.{}",
                                                  file, entry->line, key, key));
  }
  const TableSet top(root, file, "", 1);
  if (top.list("body").empty())
    throw Error(Error::Kind::input,
                fmt::format("{}:1: body is empty: one or more [[body]] are needed", file));
  Scene scene;
  Assembly assembly(scene);
  std::set<std::string> names;
  for (const TomlValue& value : top.list("body")) {
    std::vector<std::string> keys = body_keys();
    keys.insert(keys.end(), {"name", "position", "angle"});
    const TableReader reader(value, file, "[[body]]", value.line, keys);
    const std::string name = reader.text("name", fmt::format("body {}", scene.bodies.size() + 1));
    if (name.empty() || !names.insert(name).second)
      reader.refuse_text("name", name, "each body needs a name of its own, not empty");
    Scene body = read_body(value, file, allowance, "body.", value.line);
    const Vec2 position = reader.pair("position", metres, {});
    if (const double most = farthest * size_of(body.mesh); std::hypot(position.x, position.y) > most)
      reader.refuse(
          "position", *reader.find("position"),
          fmt::format(
              "within {:.3g} m, a million times the body's size, is needed: farther away its triangles "
              "are lost in rounding",
              most));
    place(body.mesh, position, reader.number("angle", radians, 0.0));
    assembly.add(std::move(body), name,
                 fmt::format("{}:{}: [body.material]", file, reader.find("material")->line));
  }
  std::vector<double>& thickness = scene.mesh.thickness_of_node;
  scene.mesh.thickness = thickness.front();
  if (std::ranges::count(thickness, thickness.front()) == std::ssize(thickness)) thickness.clear();
  if (scene.regions.empty()) scene.region_of_triangle.clear();
  return scene;
}

}  // namespace rheo
