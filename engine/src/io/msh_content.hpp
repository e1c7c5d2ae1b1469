// What a Gmsh file says, in its own tags, and the mesh made of it.
//
// Errors   make_mesh: Error::Kind::input, naming the file and the tag
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rheo/io/mesh_file.hpp"
#include "rheo/mesh.hpp"

namespace rheo {

// Nodes of an element type that is read (point, line, triangle); 0 for all others.
std::size_t corner_count(int type);
// "quadrangle with 4 nodes"; empty for a type that Gmsh does not have.
std::string_view element_name(int type);

struct MshContent {
  struct Node {
    std::int64_t tag = 0;
    double x = 0.0, y = 0.0, z = 0.0;
    bool may_be_unused = false;  // lies on a geometric point or curve: the middle of an arc, say
  };
  struct Corners {  // a triangle or line, once for each of its groups
    std::int64_t tag = 0;
    std::array<std::int64_t, 3> nodes{};
    int group = 0;
  };

  std::vector<Node> nodes;
  std::vector<Corners> triangles;
  std::vector<Corners> lines;                      // in groups; two nodes
  std::vector<std::int64_t> loose_nodes;           // of point elements and of lines without a group
  std::map<int, std::string> names;                // of physical curves, by tag
  std::map<int, std::string> surface_names;        // of physical surfaces, by tag
  std::map<int, std::vector<int>> curve_groups;    // physical tags of a curve (version 4.1)
  std::map<int, std::vector<int>> surface_groups;  // physical tags of a surface (version 4.1)

  // `groups`: physical tags; a 0 means none.
  void add_element(int type, std::int64_t tag, const std::array<std::int64_t, 3>& corners,
                   std::span<const int> groups);
};

// Points in the order of the file, without those that only points and lines without a group use; where
// `left_out` is not null, it tells about these.
Mesh make_mesh(const MshContent& content, const std::string& file, LeftOutNodes* left_out);

}  // namespace rheo
