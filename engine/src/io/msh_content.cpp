#include "io/msh_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "io/message.hpp"
#include "rheo/error.hpp"

namespace rheo {
namespace {

enum ElementType { line_type = 1, triangle_type = 2, point_type = 15 };

// Files differ in rounding where a tool has turned or scaled a plane; a fraction of the mesh's size.
constexpr double flatness = 1e-9;

// A negative tag means the group with the curve or surface turned round.
int without_sign(int group) {
  return group == std::numeric_limits<int>::min() ? group : std::abs(group);
}

std::string group_name(const std::map<int, std::string>& names, int tag) {
  const auto name = names.find(tag);
  const bool named = name != names.end() && !name->second.empty();
  return named ? name->second : fmt::format("physical_{}", tag);
}

class MeshMaker {
 public:
  MeshMaker(const MshContent& content, const std::string& file) : content_(content), file_(file) {}

  Mesh make(LeftOutNodes* left_out) {
    if (content_.triangles.empty()) {
      refuse(
          "no triangles: a surface mesh is needed; make it with gmsh -2 (and a physical surface, where there "
          "are "
          "physical groups)");
    }
    sort_tags();
    add_triangles();
    check_flat();
    add_points();
    add_groups();
    if (left_out != nullptr) *left_out = left_out_;
    return std::move(mesh_);
  }

 private:
  template <typename... Arguments>
  [[noreturn]] void refuse(fmt::format_string<Arguments...> text, Arguments&&... arguments) const {
    throw Error(Error::Kind::input,
                fmt::format("{}: {}", file_, fmt::format(text, std::forward<Arguments>(arguments)...)));
  }

  void sort_tags() {
    by_tag_.reserve(content_.nodes.size());
    for (std::size_t i = 0; i < content_.nodes.size(); ++i) by_tag_.push_back({content_.nodes[i].tag, i});
    std::sort(by_tag_.begin(), by_tag_.end());
    for (std::size_t i = 1; i < by_tag_.size(); ++i) {
      if (by_tag_[i].first == by_tag_[i - 1].first)
        refuse("node tag {} is there twice; each node needs its own", by_tag_[i].first);
    }
  }

  // Place of a node in the file.
  std::size_t place(std::int64_t tag, const char* kind, std::int64_t element) const {
    const auto found = std::lower_bound(by_tag_.begin(), by_tag_.end(), std::pair{tag, std::size_t{0}});
    if (found == by_tag_.end() || found->first != tag) {
      refuse("{} with tag {}: there is no node with tag {}", kind, element, tag);
    }
    return found->second;
  }

  void add_triangles() {
    used_.assign(content_.nodes.size(), 0);
    mesh_.triangles.reserve(content_.triangles.size());
    std::vector<int> groups;
    for (const auto& triangle : content_.triangles) {
      Triangle corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t node = place(triangle.nodes[k], "the triangle", triangle.tag);
        used_[node] = 1;
        corners[k] = static_cast<int>(node);
      }
      mesh_.triangles.push_back(corners);
      groups.push_back(triangle.group);
    }
    const bool several =
        std::any_of(groups.begin(), groups.end(), [&](int group) { return group != groups[0]; });
    if (several) drop_repeated(groups);
    if (several || groups[0] != 0) {
      for (std::size_t i = 0; i < groups.size(); ++i) {
        if (groups[i] == 0) continue;
        const auto triangle = static_cast<std::int32_t>(several ? kept_as_[i] : i);
        const std::string name = group_name(content_.surface_names, groups[i]);
        mesh_.triangle_groups[name].push_back(triangle);
        mesh_.triangle_group_of_number[groups[i]] = name;
      }
    }
  }

  // A triangle stands in the list once for every physical surface that it belongs to.
  void drop_repeated(const std::vector<int>& groups) {
    struct Entry {
      Triangle sorted;
      std::size_t index;
      bool operator<(const Entry& other) const {
        return sorted != other.sorted ? sorted < other.sorted : index < other.index;
      }
    };
    std::vector<Entry> entries;
    entries.reserve(groups.size());
    for (std::size_t i = 0; i < groups.size(); ++i) {
      Triangle sorted = mesh_.triangles[i];
      std::sort(sorted.begin(), sorted.end());
      entries.push_back({sorted, i});
    }
    std::sort(entries.begin(), entries.end());
    std::vector<std::size_t> same_as(groups.size());
    for (std::size_t i = 0, first = 0; i < entries.size(); ++i) {
      if (entries[i].sorted != entries[first].sorted) first = i;
      // The same triangle twice in one group is a mistake, which prepare() names.
      const bool repeats = i != first && groups[entries[i].index] != groups[entries[first].index];
      same_as[entries[i].index] = repeats ? entries[first].index : entries[i].index;
    }
    kept_as_.resize(groups.size());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      if (same_as[i] != i) continue;
      kept_as_[i] = kept;
      mesh_.triangles[kept++] = mesh_.triangles[i];
    }
    for (std::size_t i = 0; i < groups.size(); ++i) kept_as_[i] = kept_as_[same_as[i]];
    mesh_.triangles.resize(kept);
  }

  void check_flat() const {
    constexpr double huge = std::numeric_limits<double>::infinity();
    double low[3] = {huge, huge, huge};
    double high[3] = {-huge, -huge, -huge};
    std::size_t lowest = 0;
    std::size_t highest = 0;
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (used_[i] == 0) continue;
      const auto& node = content_.nodes[i];
      if (!std::isfinite(node.x) || !std::isfinite(node.y) || !std::isfinite(node.z)) {
        refuse("node tag {} at ({}, {}, {}): finite coordinates are needed", node.tag, node.x, node.y,
               node.z);
      }
      if (node.z < low[2]) lowest = i;
      if (node.z > high[2]) highest = i;
      const double at[3] = {node.x, node.y, node.z};
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], at[k]);
        high[k] = std::max(high[k], at[k]);
      }
    }
    const double extent = std::max(high[0] - low[0], high[1] - low[1]);
    if (high[2] - low[2] <= flatness * extent) return;
    const auto& a = content_.nodes[lowest];
    const auto& b = content_.nodes[highest];
    refuse(
        "the mesh is not flat: node tag {} has z = {}, node tag {} has z = {}; one z for all nodes is needed",
        a.tag, a.z, b.tag, b.z);
  }

  // Renumbers, leaving out the nodes that no triangle uses where that is no mistake.
  void add_points() {
    std::vector<char> loose(used_.size(), 0);
    for (const std::int64_t tag : content_.loose_nodes) loose[place(tag, "a point or line", tag)] = 1;
    number_.assign(used_.size(), -1);
    for (std::size_t i = 0; i < used_.size(); ++i) {
      const auto& node = content_.nodes[i];
      if (used_[i] == 0 && loose[i] == 0 && !node.may_be_unused) {
        refuse("node tag {} at ({}, {}) belongs to no triangle", node.tag, node.x, node.y);
      }
      if (used_[i] == 0) {
        if (left_out_.count++ == 0) left_out_.first_tag = node.tag;
        continue;
      }
      number_[i] = mesh_.node_count();
      mesh_.points.push_back({node.x, node.y});
    }
    for (Triangle& triangle : mesh_.triangles) {
      for (int& node : triangle) node = number_[static_cast<std::size_t>(node)];
    }
  }

  void add_groups() {
    for (const auto& line : content_.lines) {
      const std::string group = group_name(content_.names, line.group);
      Edge edge{};
      for (std::size_t k = 0; k < 2; ++k) {
        edge[k] = number_[place(line.nodes[k], "the line", line.tag)];
        if (edge[k] >= 0) continue;
        refuse("the line with tag {} in group {}: its node tag {} belongs to no triangle", line.tag,
               in_quotes(group), line.nodes[k]);
      }
      mesh_.edge_groups[group].push_back(edge);
    }
  }

  const MshContent& content_;
  const std::string& file_;
  Mesh mesh_;
  LeftOutNodes left_out_;
  std::vector<std::pair<std::int64_t, std::size_t>> by_tag_;
  std::vector<char> used_;            // by a triangle
  std::vector<std::size_t> kept_as_;  // the mesh's triangle of each in the file, where some are repeated
  std::vector<int> number_;           // in the mesh, -1: left out
};

}  // namespace

std::size_t corner_count(int type) {
  switch (type) {
    case point_type:
      return 1;
    case line_type:
      return 2;
    case triangle_type:
      return 3;
    default:
      return 0;
  }
}

std::string_view element_name(int type) {
  switch (type) {
    case 3:
      return "quadrangle with 4 nodes";
    case 4:
      return "tetrahedron with 4 nodes";
    case 5:
      return "hexahedron with 8 nodes";
    case 6:
      return "prism with 6 nodes";
    case 7:
      return "pyramid with 5 nodes";
    case 8:
      return "second-order line with 3 nodes";
    case 9:
      return "second-order triangle with 6 nodes";
    case 10:
      return "second-order quadrangle with 9 nodes";
    case 11:
      return "second-order tetrahedron with 10 nodes";
    case 16:
      return "second-order quadrangle with 8 nodes";
    default:
      return {};
  }
}

void MshContent::add_element(int type, std::int64_t tag, const std::array<std::int64_t, 3>& corners,
                             std::span<const int> groups) {
  const bool grouped = std::any_of(groups.begin(), groups.end(), [](int group) { return group != 0; });
  if (type == triangle_type) {
    if (!grouped) triangles.push_back({tag, corners, 0});
    for (const int group : groups)
      if (group != 0) triangles.push_back({tag, corners, without_sign(group)});
  } else if (type == line_type && grouped) {
    for (const int group : groups) {
      if (group != 0) lines.push_back({tag, corners, without_sign(group)});
    }
  } else {
    for (std::size_t k = 0; k < corner_count(type); ++k) loose_nodes.push_back(corners[k]);
  }
}

Mesh make_mesh(const MshContent& content, const std::string& file, LeftOutNodes* left_out) {
  return MeshMaker(content, file).make(left_out);
}

}  // namespace rheo
