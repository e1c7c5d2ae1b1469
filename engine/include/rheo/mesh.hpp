// A flat mesh of linear triangles with named groups of edges.
//
// Units    points [m], thickness [m]
// Shapes   points: n nodes; triangles: m x 3 node numbers from 0
// Errors   prepare: Error::Kind::input, naming the triangle, edge or node
// Not here mesh files (io/mesh_file.hpp), scenes, materials
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace rheo {

struct Vec2 {
  double x = 0.0;
  double y = 0.0;
  friend bool operator==(const Vec2&, const Vec2&) = default;
};

using Edge = std::array<int, 2>;
using Triangle = std::array<int, 3>;

struct Mesh {
  std::vector<Vec2> points;
  std::vector<Triangle> triangles;
  double thickness = 1.0;
  // By node, where bodies differ; empty: the one above is that of all. The nodes of a triangle have one.
  std::vector<double> thickness_of_node{};
  // Named edges. prepare() adds "boundary": every edge with a triangle on one side only, the interior on its
  // left.
  std::map<std::string, std::vector<Edge>> edge_groups;
  // Named triangles: a Gmsh file's physical surfaces.
  std::map<std::string, std::vector<std::int32_t>> triangle_groups;
  std::map<int, std::string> triangle_group_of_number;  // by Gmsh's number

  int node_count() const { return static_cast<int>(points.size()); }
  double thickness_at(int node) const {
    return thickness_of_node.empty() ? thickness : thickness_of_node[static_cast<std::size_t>(node)];
  }
  double thickness_of(const Triangle& triangle) const { return thickness_at(triangle[0]); }
  double thickness_of(const Edge& edge) const { return thickness_at(edge[0]); }
  int triangle_count() const { return static_cast<int>(triangles.size()); }
};

// Makes a mesh fit for use: turns clockwise triangles round (and returns how many), adds the group "boundary"
// and turns every edge of the other groups so that a boundary edge has the interior on its left. Preparing
// twice changes nothing. Refuses: no triangles, a node number out of range, a triangle with a repeated node
// or no area (doubled area at most 1e-12 of its longest side squared), the same triangle twice, an edge with
// more than two triangles or with two on the same side, a node without a triangle, a non-finite coordinate, a
// thickness that is not positive and finite, thicknesses that are not one a node or differ in a triangle, a
// group edge that is no edge of the mesh or is there twice, a group "boundary" that is not the boundary.
// `where` (a file name, say) begins the message when not empty. After an error the mesh is not to be used.
int prepare(Mesh& mesh, const std::string& where = {});

// Half the cross product of two sides; positive when counter-clockwise. [m^2]
double signed_area(const Mesh& mesh, int triangle);

// Pieces of a mesh that share no node: of each node, the lowest node of its piece.
std::vector<int> pieces_of(const Mesh& mesh);

// How many there are.
int piece_count(const Mesh& mesh);

// Node numbers of some edges, each once, in rising order.
std::vector<int> nodes_of(const std::vector<Edge>& edges);

}  // namespace rheo
