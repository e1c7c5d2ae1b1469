// The items of a scene file that act on its mesh: [edges], [[fix]], [[move]], [[constraint]], [[traction]],
// [[probe]].
//
// Errors   Error::Kind::input, "file:line: [[table]] key = value: what is allowed"; Error::Kind::file for a
// table of keys
//          that cannot be read
#pragma once

#include <string>
#include <vector>

#include "io/allowance.hpp"
#include "io/toml_tree.hpp"
#include "mesh_edges.hpp"
#include "rheo/scene.hpp"

namespace rheo {

class ItemReader {
 public:
  // `mesh` is prepared; its groups may be added to. `files` gets the tables of keys that are opened.
  // `owner`: what the tables' names begin with ("body.").
  ItemReader(Mesh& mesh, std::vector<std::string>& files, std::string file, Allowance& allowance,
             std::string owner = {});

  // Adds the groups of [edges] to the mesh.
  void add_groups(const TomlEntry& table);

  Fix fix(const TomlValue& table) const;
  Move move(const TomlValue& table) const;
  Constraint constraint(const TomlValue& table) const;
  Traction traction(const TomlValue& table) const;
  Probe probe(const TomlValue& table) const;

 private:
  class Item;

  Mesh& mesh_;
  std::vector<std::string>& files_;
  MeshEdges edges_;
  std::string file_;
  Allowance& allowance_;
  std::string name_;  // of the tables' owner
};

}  // namespace rheo
