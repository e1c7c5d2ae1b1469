#include "rheo/io/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "io/message.hpp"
#include "io/msh_content.hpp"
#include "io/msh_input.hpp"
#include "io/read_file.hpp"
#include "memory_budget.hpp"
#include "rheo/error.hpp"

namespace rheo {
namespace {

constexpr std::size_t most_bytes = std::size_t{4} << 30;

// Versions 2.2 and 4.1 differ in how they write nodes and elements, and 4.1 has $Entities.
class MshReader {
 public:
  MshReader(std::string bytes, const std::string& name, double memory)
      : in_(std::move(bytes), name), memory_(memory_limit(memory)) {}

  Mesh read(LeftOutNodes* left_out) {
    read_format();
    bool nodes = false;
    bool elements = false;
    for (std::string_view line = in_.line(); !line.empty(); line = in_.line()) {
      if (line[0] != '$') in_.refuse("{} where a section ($Nodes, say) is expected", in_quotes(line, 30));
      const std::string section(line.substr(1));
      in_.pass_line_end();
      if (section == "PartitionedEntities") {
        in_.refuse("the mesh is in partitions, whose physical groups are not read: save it in one piece");
      }
      if (section == "PhysicalNames") {
        read_names();
      } else if (section == "Entities" && version_4_) {
        read_entities();
      } else if (section == "Nodes") {
        nodes = true;
        version_4_ ? read_nodes_4() : read_nodes_2();
      } else if (section == "Elements") {
        elements = true;
        version_4_ ? read_elements_4() : read_elements_2();
      } else {
        in_.skip_section(section);
        continue;
      }
      in_.end_section(section);
    }
    if (!nodes) in_.refuse("the file ends without $Nodes");
    if (!elements) in_.refuse("the file ends without $Elements");
    return make_mesh(content_, in_.name(), left_out);
  }

 private:
  // What a file of another kind may be, by its first bytes.
  static std::string_view other_format(std::string_view bytes) {
    struct Mark {
      std::string_view begin;
      std::string_view format;
    };
    static constexpr Mark marks[] = {
        {"solid", "an STL file"}, {"# vtk", "a VTK file"},         {"<?xml", "an XML file (VTU?)"},
        {"<VTK", "a VTK file"},   {"MeshVersion", "a Medit file"}, {"$NOD", "an MSH file of version 1"},
        {"ply", "a PLY file"},    {"OFF", "an OFF file"},          {"v ", "an OBJ file"},
        {"*", "an Abaqus file"},  {"CDF", "an Exodus file"},       {"\x89HDF", "an HDF5 file"}};
    for (const Mark& mark : marks) {
      if (bytes.starts_with(mark.begin)) return mark.format;
    }
    return {};
  }

  void read_format() {
    if (in_.rest().empty()) in_.refuse("the mesh file is empty");
    std::string_view bytes = in_.rest();
    bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
    const std::string_view guess = other_format(bytes);
    if (in_.line() != "$MeshFormat") {
      in_.refuse(
          "no Gmsh MSH file (it would begin with $MeshFormat){}{}: give one made with: gmsh -2 FILE -format "
          "msh41 -o FILE.msh",
          guess.empty() ? "" : "; it looks like ", guess);
    }
    const std::string_view line = in_.line();
    const std::string_view version = line.substr(0, line.find(' '));
    version_4_ = version == "4.1";
    if (!version_4_ && version != "2.2") {
      in_.refuse(
          "MSH version {}: versions 2.2 and 4.1 are read; convert it with: gmsh OLD.msh -save -format msh41 "
          "-o NEW.msh",
          in_quotes(version, 20));
    }
    const std::string_view rest = line.substr(version.size());
    if (rest != " 0 8" && rest != " 1 8") {
      in_.refuse("{} behind the version: 0 or 1 (text or binary) and 8 (bytes a number) are read",
                 in_quotes(rest, 20));
    }
    if (rest == " 1 8") {
      in_.pass_line_end();
      in_.read_byte_order();
    }
    in_.end_section("MeshFormat");
  }

  void read_names() {
    const auto encoding = in_.use_text();
    const std::size_t count = in_.count_integer("the number of physical names", 1, 3);
    for (std::size_t i = 0; i < count; ++i) {
      const int dimension = in_.integer("a physical group's dimension");
      const int tag = in_.integer("a physical group's tag");
      const std::string_view line = in_.line();
      const auto first = line.find('"');
      const auto last = line.rfind('"');
      if (first != 0 || last == 0)
        in_.refuse("{} where a physical group's name in quotes is expected", in_quotes(line, 30));
      // Gmsh writes what it was given; names go into messages and scene files, which are text.
      const std::string name = one_line(line.substr(1, last - 1), std::string::npos);
      if (dimension == 1) content_.names[tag] = name;
      if (dimension == 2) content_.surface_names[tag] = name;
    }
    in_.set_encoding(encoding);
  }

  void read_entities() {
    const std::size_t points = in_.count_size("the number of points", 36, 5);
    const std::size_t curves = in_.count_size("the number of curves", 68, 9);
    const std::size_t surfaces = in_.count_size("the number of surfaces", 68, 9);
    const std::size_t volumes = in_.count_size("the number of volumes", 68, 9);
    const auto pass_tags = [&](const char* what) {
      const std::size_t count = in_.count_size(what, 4, 1);
      for (std::size_t i = 0; i < count; ++i) in_.integer("an entity's tag");
    };
    const auto pass_box = [&](int numbers) {
      for (int i = 0; i < numbers; ++i) in_.real("a coordinate of an entity");
    };
    for (std::size_t i = 0; i < points; ++i) {
      in_.integer("a point's tag");
      pass_box(3);
      pass_tags("a point's number of physical groups");
    }
    for (std::size_t i = 0; i < curves + surfaces + volumes; ++i) {
      const int tag = in_.integer("an entity's tag");
      pass_box(6);
      const bool is_curve = i < curves;
      if (i < curves + surfaces) {
        const std::size_t groups = in_.count_size("an entity's number of physical groups", 4, 1);
        // Each element is entered in each of its groups.
        constexpr std::size_t most_groups = 1000;
        if (groups > most_groups)
          in_.refuse("{} {} is in {} physical groups: at most {} are read", is_curve ? "curve" : "surface",
                     tag, groups, most_groups);
        auto& list = (is_curve ? content_.curve_groups : content_.surface_groups)[tag];
        for (std::size_t k = 0; k < groups; ++k) list.push_back(in_.integer("a physical group's tag"));
      } else {
        pass_tags("an entity's number of physical groups");
      }
      pass_tags("an entity's number of boundary entities");
    }
  }

  // Before they are read: a triangle in many physical groups stands in the list once for each of them.
  void book(std::size_t count, double bytes, const char* what) {
    try {
      memory_.take(bytes * static_cast<double>(count), fmt::format("{} {}", count, what),
                   "take a coarser mesh");
    } catch (const Error& error) {
      in_.refuse("{}", error.what());
    }
  }
  void book_nodes(std::size_t count) { book(count, 150.0, "nodes"); }
  void book_elements(std::size_t count) { book(count, 150.0, "elements"); }

  // Version 2.2 writes these counts as text in binary files too.
  std::size_t text_count(const char* what, std::size_t bytes, std::size_t numbers) {
    const auto encoding = in_.use_text();
    const int count = in_.integer(what);
    in_.set_encoding(encoding);
    const std::size_t checked = in_.checked_count(count, what, bytes, numbers);
    in_.pass_line_end();
    return checked;
  }

  void read_nodes_2() {
    const std::size_t count = text_count("the number of nodes", 28, 4);
    book_nodes(count);
    for (std::size_t i = 0; i < count; ++i) {
      const int tag = in_.integer("a node's tag");
      add_node(tag, false);
    }
  }

  void add_node(std::int64_t tag, bool on_point_or_curve) {
    const double x = in_.real("a node's x");
    const double y = in_.real("a node's y");
    const double z = in_.real("a node's z");
    content_.nodes.push_back({tag, x, y, z, on_point_or_curve});
  }

  void read_nodes_4() {
    const std::size_t blocks = in_.count_size("the number of node blocks", 20, 4);
    in_.count_size("the number of nodes", 32, 4);
    in_.size("the smallest node tag");
    in_.size("the largest node tag");
    std::vector<std::int64_t> tags;
    for (std::size_t block = 0; block < blocks; ++block) {
      const int dimension = in_.integer("a node block's dimension");
      in_.integer("a node block's entity");
      const int parametric = in_.integer("a node block's parametric flag");
      if (dimension < 0 || dimension > 3)
        in_.refuse("a node block of dimension {}: 0 to 3 is expected", dimension);
      const std::size_t count = in_.count_size("a node block's number of nodes", 32, 4);
      book_nodes(count);
      tags.clear();
      for (std::size_t i = 0; i < count; ++i) tags.push_back(in_.size("a node's tag"));
      for (const std::int64_t tag : tags) {
        add_node(tag, dimension < 2);
        for (int k = 0; k < (parametric != 0 ? dimension : 0); ++k) in_.real("a node's parameter");
      }
    }
  }

  void read_elements_2() {
    const std::size_t count = text_count("the number of elements", 8, 4);
    book_elements(count);
    std::size_t done = 0;
    while (done < count) {
      // In text each element stands alone: tag type tags; in binary blocks have a head: type number tags.
      int tag = 0;
      if (in_.is_text()) tag = in_.integer("an element's tag");
      const int type = element_type();
      const std::size_t corners = corner_count(type);
      std::size_t in_block = 1;
      if (!in_.is_text()) in_block = in_.count_integer("a block's number of elements", 4 * (1 + corners), 0);
      const std::size_t tags = in_.count_integer("an element's number of tags", 4, 1);
      if (in_block == 0 || in_block > count - done) {
        in_.refuse("a block of {} elements where {} are left", in_block, count - done);
      }
      for (std::size_t i = 0; i < in_block; ++i) {
        if (!in_.is_text()) tag = in_.integer("an element's tag");
        int group = 0;
        for (std::size_t k = 0; k < tags; ++k) {
          const int value = in_.integer("an element's group");
          if (k == 0) group = value;
        }
        std::array<std::int64_t, 3> nodes{};
        for (std::size_t k = 0; k < corners; ++k) nodes[k] = in_.integer("an element's node");
        content_.add_element(type, tag, nodes, {&group, 1});
      }
      done += in_block;
    }
  }

  void read_elements_4() {
    const std::size_t blocks = in_.count_size("the number of element blocks", 20, 4);
    in_.count_size("the number of elements", 16, 2);
    in_.size("the smallest element tag");
    in_.size("the largest element tag");
    for (std::size_t block = 0; block < blocks; ++block) {
      const int dimension = in_.integer("an element block's dimension");
      const int entity = in_.integer("an element block's entity");
      const int type = element_type();
      const std::size_t corners = corner_count(type);
      const std::size_t count =
          in_.count_size("a block's number of elements", 8 * (1 + corners), 1 + corners);
      std::span<const int> groups;
      if (dimension == 1 || dimension == 2) {
        const auto& known = dimension == 1 ? content_.curve_groups : content_.surface_groups;
        if (const auto found = known.find(entity); found != known.end()) groups = found->second;
      }
      book_elements(count * std::max<std::size_t>(1, groups.size()));
      for (std::size_t i = 0; i < count; ++i) {
        const std::int64_t tag = in_.size("an element's tag");
        std::array<std::int64_t, 3> nodes{};
        for (std::size_t k = 0; k < corners; ++k) nodes[k] = in_.size("an element's node");
        content_.add_element(type, tag, nodes, groups);
      }
    }
  }

  int element_type() {
    const int type = in_.integer("an element's type");
    if (corner_count(type) != 0) return type;
    const std::string_view name = element_name(type);
    in_.refuse(
        "element type {}{}{}{}: only triangles with 3 nodes are used; make them with "
        "gmsh -2 -order 1, without recombining",
        type, name.empty() ? "" : " (", name, name.empty() ? "" : ")");
  }

  MshInput in_;
  MemoryBudget memory_;
  MshContent content_;
  bool version_4_ = false;
};

}  // namespace

Mesh read_msh(const std::filesystem::path& file, LeftOutNodes* left_out, double memory) {
  MemoryBudget budget(memory_limit(memory));
  book_file(file, budget);
  return parse_msh(read_file(file, "mesh", most_bytes, "$MeshFormat"), file.string(), left_out,
                   budget.left());
}

Mesh parse_msh(std::string bytes, const std::string& name, LeftOutNodes* left_out, double memory) {
  return MshReader(std::move(bytes), name, memory).read(left_out);
}

}  // namespace rheo
