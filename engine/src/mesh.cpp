#include "rheo/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "io/message.hpp"
#include "mesh_edges.hpp"
#include "rheo/error.hpp"
#include "rheo/limits.hpp"

namespace rheo {
namespace {

// A triangle is taken for a line where its doubled area is this fraction of its longest side squared: an
// angle of 1e-12 rad, some thousand times what rounding of the coordinates alone can make.
constexpr double flat_fraction = 1e-12;

class Preparation {
 public:
  Preparation(Mesh& mesh, const std::string& where) : mesh_(mesh), where_(where) {}

  int run() {
    check_sizes();
    check_points();
    const int turned = check_triangles();
    const MeshEdges edges(mesh_);
    const std::vector<Edge> boundary = check_edges(edges);
    check_nodes();
    check_groups(edges, boundary);
    mesh_.edge_groups["boundary"] = boundary;
    return turned;
  }

 private:
  template <typename... Arguments>
  [[noreturn]] void refuse(fmt::format_string<Arguments...> text, Arguments&&... arguments) const {
    std::string message = where_.empty() ? std::string{} : where_ + ": ";
    message += fmt::format(text, std::forward<Arguments>(arguments)...);
    throw Error(Error::Kind::input, message);
  }

  std::string name(int triangle) const {
    const Triangle& t = mesh_.triangles[static_cast<std::size_t>(triangle)];
    return fmt::format("triangle {} ({}, {}, {})", triangle, t[0], t[1], t[2]);
  }

  void check_sizes() const {
    if (!(mesh_.thickness > 0.0) || !std::isfinite(mesh_.thickness)) {
      refuse("thickness = {}: a positive, finite number of metres is needed", mesh_.thickness);
    }
    if (!of_usable_size(mesh_.thickness)) {
      refuse("thickness = {}: {:g} to {:g} m is allowed", mesh_.thickness, smallest_size, largest_size);
    }
    for (const double thickness : mesh_.thickness_of_node) {
      if (!(thickness > 0.0) || !of_usable_size(thickness))
        refuse("thickness = {}: {:g} to {:g} m is allowed", thickness, smallest_size, largest_size);
    }
    if (!mesh_.thickness_of_node.empty() && mesh_.thickness_of_node.size() != mesh_.points.size())
      refuse("{} thicknesses for {} nodes: one for all, or one a node is needed",
             mesh_.thickness_of_node.size(), mesh_.points.size());
    if (mesh_.triangles.empty()) refuse("the mesh has no triangles: at least one is needed");
    constexpr auto most = static_cast<std::size_t>(std::numeric_limits<int>::max() / 6);
    if (mesh_.points.size() > most || mesh_.triangles.size() > most) {
      refuse("the mesh has {} nodes and {} triangles: at most {} of each are allowed", mesh_.points.size(),
             mesh_.triangles.size(), most);
    }
  }

  void check_points() const {
    for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
      const Vec2 p = mesh_.points[i];
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
        refuse("node {} at ({}, {}): finite coordinates are needed", i, p.x, p.y);
      }
      if (!within_size(p.x) || !within_size(p.y)) {
        refuse("node {} at ({}, {}): at most {:g} m from the origin is allowed", i, p.x, p.y, largest_size);
      }
    }
  }

  // Returns how many were turned round.
  int check_triangles() {
    const int nodes = mesh_.node_count();
    int turned = 0;
    for (int i = 0; i < mesh_.triangle_count(); ++i) {
      Triangle& t = mesh_.triangles[static_cast<std::size_t>(i)];
      for (const int node : t) {
        if (node < 0 || node >= nodes) {
          refuse("{}: there is no node {}; the nodes are numbered 0 to {}", name(i), node, nodes - 1);
        }
      }
      for (const std::size_t k : {0u, 1u, 2u}) {
        if (t[k] == t[(k + 1) % 3])
          refuse("{}: node {} twice; three different nodes are needed", name(i), t[k]);
      }
      if (mesh_.thickness_at(t[1]) != mesh_.thickness_at(t[0]) ||
          mesh_.thickness_at(t[2]) != mesh_.thickness_at(t[0]))
        refuse("{}: its nodes differ in thickness; a triangle has one", name(i));
      double longest2 = 0.0;
      for (const std::size_t k : {0u, 1u, 2u}) {
        const Vec2 a = mesh_.points[static_cast<std::size_t>(t[k])];
        const Vec2 b = mesh_.points[static_cast<std::size_t>(t[(k + 1) % 3])];
        longest2 = std::max(longest2, (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
      }
      const double area = signed_area(mesh_, i);
      if (!(2.0 * std::abs(area) > flat_fraction * longest2) || !std::isfinite(longest2)) {
        refuse("{}: it has no area ({} m^2 with a longest side of {} m); its nodes must not lie on a line",
               name(i), std::abs(area), std::sqrt(longest2));
      }
      if (const double longest = std::sqrt(longest2); !of_usable_size(longest)) {
        refuse("{}: its longest side has {} m; {:g} to {:g} m is allowed", name(i), longest, smallest_size,
               largest_size);
      }
      if (area < 0.0) {
        std::swap(t[1], t[2]);
        ++turned;
      }
    }
    return turned;
  }

  // Two triangles at most on an edge, one on each side. Returns the boundary, the interior on its left.
  std::vector<Edge> check_edges(const MeshEdges& edges) const {
    std::vector<Edge> boundary;
    for (int low = 0; low < mesh_.node_count(); ++low) {
      const auto sides = edges.sides_of(low);
      for (std::size_t first = 0; first < sides.size();) {
        std::size_t last = first + 1;
        while (last < sides.size() && sides[last].high == sides[first].high) ++last;
        check_edge(low, sides.subspan(first, last - first));
        if (last - first == 1) {
          const int high = sides[first].high;
          boundary.push_back(sides[first].forward ? Edge{low, high} : Edge{high, low});
        }
        first = last;
      }
    }
    return boundary;
  }

  void check_edge(int low, std::span<const MeshEdges::Side> sides) const {
    if (sides.size() == 1 || (sides.size() == 2 && sides[0].forward != sides[1].forward)) return;
    const int high = sides[0].high;
    const auto third = [&](const MeshEdges::Side& side) {
      const Triangle& t = mesh_.triangles[static_cast<std::size_t>(side.triangle)];
      return t[0] + t[1] + t[2] - low - high;  // below 2^31: the counts were checked
    };
    for (std::size_t i = 0; i < std::min<std::size_t>(sides.size(), 3); ++i) {
      for (std::size_t j = i + 1; j < std::min<std::size_t>(sides.size(), 3); ++j) {
        if (third(sides[i]) == third(sides[j])) {
          refuse("{} is the same as triangle {}; each may be there once", name(sides[j].triangle),
                 sides[i].triangle);
        }
      }
    }
    if (sides.size() > 2) {
      refuse("edge ({}, {}) belongs to {} triangles, {}, {} and {} among them; at most two may share an edge",
             low, high, sides.size(), sides[0].triangle, sides[1].triangle, sides[2].triangle);
    }
    refuse("edge ({}, {}): {} and {} lie on the same side of it and overlap", low, high,
           name(sides[0].triangle), name(sides[1].triangle));
  }

  void check_nodes() const {
    std::vector<char> used(mesh_.points.size(), 0);
    for (const Triangle& t : mesh_.triangles) {
      for (const int node : t) used[static_cast<std::size_t>(node)] = 1;
    }
    const auto unused = std::find(used.begin(), used.end(), 0);
    if (unused == used.end()) return;
    const auto node = static_cast<std::size_t>(unused - used.begin());
    refuse("node {} at ({}, {}) belongs to no triangle: it would have no mass; leave it out", node,
           mesh_.points[node].x, mesh_.points[node].y);
  }

  void check_groups(const MeshEdges& edges, const std::vector<Edge>& boundary) {
    for (auto& [group, members] : mesh_.edge_groups) {
      for (Edge& edge : members) {
        const auto oriented = edges.oriented(edge);
        if (!oriented) {
          refuse("edge ({}, {}) of group {} is no edge of the mesh (the nodes are numbered 0 to {})", edge[0],
                 edge[1], in_quotes(group), mesh_.node_count() - 1);
        }
        edge = *oriented;
      }
      const auto sorted = undirected(members);
      const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
      if (twice != sorted.end()) {
        refuse("edge ({}, {}) is twice in group {}; once is enough", (*twice)[0], (*twice)[1],
               in_quotes(group));
      }
      if (group == "boundary" && sorted != undirected(boundary)) {
        refuse(
            "group \"boundary\" has {} edges, but the name is kept for all {} edges with one triangle; "
            "give the group another name",
            members.size(), boundary.size());
      }
    }
  }

  static std::vector<Edge> undirected(std::vector<Edge> edges) {
    for (Edge& edge : edges) {
      if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
    }
    std::sort(edges.begin(), edges.end());
    return edges;
  }

  Mesh& mesh_;
  const std::string& where_;
};

}  // namespace

MeshEdges::MeshEdges(const Mesh& mesh)
    : begin_(mesh.points.size() + 1, 0), sides_(3 * mesh.triangles.size()) {
  const auto low_of = [](const Triangle& t, std::size_t k) {
    return static_cast<std::size_t>(std::min(t[k], t[(k + 1) % 3]));
  };
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++begin_[low_of(t, k) + 1];
  }
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (int i = 0; i < mesh.triangle_count(); ++i) {
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      sides_[next[low_of(t, k)]++] = {std::max(a, b), i, a < b};
    }
  }
  for (std::size_t i = 0; i + 1 < begin_.size(); ++i) {
    const auto at = [&](std::size_t k) { return sides_.begin() + static_cast<std::ptrdiff_t>(begin_[k]); };
    std::sort(at(i), at(i + 1), [](const Side& a, const Side& b) {
      return a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
    });
  }
}

std::span<const MeshEdges::Side> MeshEdges::sides_of(int low) const {
  const auto i = static_cast<std::size_t>(low);
  return std::span<const Side>(sides_).subspan(begin_[i], begin_[i + 1] - begin_[i]);
}

std::span<const MeshEdges::Side> MeshEdges::sides(const Edge& edge) const {
  const auto [low, high] = std::minmax(edge[0], edge[1]);
  if (low < 0 || static_cast<std::size_t>(low) + 1 >= begin_.size()) return {};
  const auto all = sides_of(low);
  struct ByHigh {
    bool operator()(const Side& side, int node) const { return side.high < node; }
    bool operator()(int node, const Side& side) const { return node < side.high; }
  };
  const auto [first, last] = std::equal_range(all.begin(), all.end(), high, ByHigh{});
  return {first, last};
}

std::optional<Edge> MeshEdges::oriented(const Edge& edge) const {
  const auto found = sides(edge);
  if (found.empty()) return std::nullopt;
  const bool upward = edge[0] < edge[1];
  return found.size() == 1 && found[0].forward != upward ? Edge{edge[1], edge[0]} : edge;
}

int prepare(Mesh& mesh, const std::string& where) {
  return Preparation(mesh, where).run();
}

double signed_area(const Mesh& mesh, int triangle) {
  const Triangle& t = mesh.triangles[static_cast<std::size_t>(triangle)];
  const Vec2 a = mesh.points[static_cast<std::size_t>(t[0])];
  const Vec2 b = mesh.points[static_cast<std::size_t>(t[1])];
  const Vec2 c = mesh.points[static_cast<std::size_t>(t[2])];
  return 0.5 * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
}

std::vector<int> pieces_of(const Mesh& mesh) {
  // Union by the smaller number, with paths halved.
  std::vector<int> parent(mesh.points.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int node) {
    while (parent[node] != node) {
      parent[node] = parent[parent[node]];
      node = parent[node];
    }
    return node;
  };
  for (const Triangle& t : mesh.triangles) {
    for (const int k : {1, 2}) {
      const auto [low, high] = std::minmax({root(t[0]), root(t[k])});
      parent[high] = low;
    }
  }
  for (int& node : parent) node = root(node);
  return parent;
}

int piece_count(const Mesh& mesh) {
  const std::vector<int> pieces = pieces_of(mesh);
  int count = 0;
  for (int node = 0; node < mesh.node_count(); ++node) count += pieces[node] == node ? 1 : 0;
  return count;
}

std::vector<int> nodes_of(const std::vector<Edge>& edges) {
  std::vector<int> nodes;
  nodes.reserve(2 * edges.size());
  for (const Edge& edge : edges) nodes.insert(nodes.end(), edge.begin(), edge.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace rheo
