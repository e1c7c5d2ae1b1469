#include "io/scene_items.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "io/message.hpp"
#include "io/table_file.hpp"
#include "io/table_reader.hpp"
#include "rheo/error.hpp"

namespace rheo {
namespace {

const std::array<std::string, 3> axes{"both", "x", "y"};
const std::array<std::string, 3> profiles{"smooth", "linear", "hermite"};

constexpr NumberRule start_rule{.low = 0.0, .unit = "s"};

std::vector<Edge> read_edges(const TableReader& reader, std::string_view key, const TomlValue& value,
                             const MeshEdges& known, int node_count) {
  const auto rows = reader.integer_rows(key, value, 2, 0, node_count - 1, "[i, j]");
  std::vector<Edge> edges;
  edges.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto edge = known.oriented({rows[i][0], rows[i][1]});
    if (!edge)
      reader.refuse(fmt::format("{}[{}]", key, i), value.items[i],
                    "two nodes joined by an edge of the mesh are needed");
    edges.push_back(*edge);
  }
  std::vector<std::pair<Edge, std::size_t>> sorted;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    sorted.push_back({{std::min(edges[i][0], edges[i][1]), std::max(edges[i][0], edges[i][1])}, i});
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first != sorted[i - 1].first) continue;
    reader.refuse(fmt::format("{}[{}]", key, sorted[i].second), value.items[sorted[i].second],
                  "the edge is in the list already; once is enough");
  }
  return edges;
}

}  // namespace

// One table with what several kinds of items have in common.
class ItemReader::Item : public TableReader {
 public:
  Item(const ItemReader& owner, const TomlValue& table, const char* name, std::vector<std::string> keys)
      : TableReader(table, owner.file_, fmt::format("[[{}{}]]", owner.name_, name), table.line,
                    std::move(keys)),
        owner_(owner) {}

  std::vector<Edge> edges(const TomlValue& value) const {
    if (value.type != TomlValue::Type::string) {
      if (value.type != TomlValue::Type::array)
        refuse("edges", value, "a group's name or [[i, j], ...] is needed");
      return read_edges(*this, "edges", value, owner_.edges_, owner_.mesh_.node_count());
    }
    const auto& groups = owner_.mesh_.edge_groups;
    if (const auto group = groups.find(value.text); group != groups.end()) return group->second;
    std::vector<std::string> names;
    for (const auto& [name, members] : groups) names.push_back(name);
    const std::string near = nearest_word(value.text, names);
    refuse("edges", value,
           fmt::format("no such group; {}the groups are {}",
                       near.empty() ? "" : fmt::format("did you mean {}? ", in_quotes(near)),
                       word_list(names, "and")));
  }

  std::vector<int> nodes(const TomlValue& value) const {
    const int last = owner_.mesh_.node_count() - 1;
    if (value.type != TomlValue::Type::array || value.items.empty()) {
      refuse("nodes", value, fmt::format("a list of node numbers from 0 to {} is needed", last));
    }
    std::vector<int> result;
    result.reserve(value.items.size());
    for (const TomlValue& item : value.items) {
      result.push_back(integer(fmt::format("nodes[{}]", result.size()), item, 0, last, "node number"));
    }
    std::sort(result.begin(), result.end());
    const auto twice = std::adjacent_find(result.begin(), result.end());
    if (twice != result.end()) refuse("nodes", value, fmt::format("node {} twice; each node once", *twice));
    return result;
  }

  // Nodes given by `edges` or `nodes`.
  std::vector<int> group() const {
    static const std::array<std::string, 2> ways{"edges", "nodes"};
    const std::string way = exactly_one(ways);
    return way == "edges" ? nodes_of(edges(*find(way))) : nodes(*find(way));
  }

  // Books nodes or edges of an item: a short text can name a large group many times.
  void book(std::size_t count) const {
    constexpr double bytes = 80.0;  // in the scene, and where a simulation holds or loads them
    try {
      owner_.allowance_.memory.take(bytes * static_cast<double>(count), fmt::format("{} nodes", count),
                                    "take fewer");
    } catch (const Error& error) {
      refuse(error.what());
    }
  }

  Axis axis() const { return static_cast<Axis>(choice("axis", axes, 0)); }

  Window window() const {
    Window window;
    window.from = number("from", start_rule, window.from);
    const NumberRule until_rule{
        .low = window.from, .low_allowed = false, .infinite_allowed = true, .unit = "s"};
    window.until = number("until", until_rule, window.until);
    return window;
  }

  // Rows of `keys`, inline or from a file, their times rising.
  NumberTable keys(const std::string& form, std::size_t columns) const {
    const TomlValue& value =
        require("keys", fmt::format("a list of [{}] or the name of a CSV file is needed", form));
    NumberTable table;
    std::filesystem::path path;
    if (value.type == TomlValue::Type::string) {
      attribute("keys", value, [&] {
        path = owner_.allowance_.files.resolve(value.text);
        table = read_table(path, columns, form, owner_.allowance_.memory);
      });
      std::vector<std::string>& files = owner_.files_;
      if (std::find(files.begin(), files.end(), path.string()) == files.end()) files.push_back(path.string());
    } else {
      table = rows("keys", value, columns, fmt::format("[{}]", form));
    }
    for (std::size_t i = 1; i < table.rows.size(); ++i) {
      if (table.rows[i][0] > table.rows[i - 1][0]) continue;
      const std::string text =
          fmt::format("times must rise; t = {} is not after t = {}", table.rows[i][0], table.rows[i - 1][0]);
      if (path.empty()) refuse(fmt::format("keys[{}]", i), value.items[i], text);
      refuse("keys", value, fmt::format("{}:{}: {}", path.string(), table.lines[i], text));
    }
    return table;
  }

 private:
  const ItemReader& owner_;
};

ItemReader::ItemReader(Mesh& mesh, std::vector<std::string>& files, std::string file, Allowance& allowance,
                       std::string owner)
    : mesh_(mesh),
      files_(files),
      edges_(mesh),
      file_(std::move(file)),
      allowance_(allowance),
      name_(std::move(owner)) {}

void ItemReader::add_groups(const TomlEntry& table) {
  std::vector<std::string> names;
  for (const TomlEntry& entry : table.value.entries) names.push_back(entry.key);
  const TableReader reader(table.value, file_, fmt::format("[{}edges]", name_), table.line, names);
  for (const TomlEntry& entry : table.value.entries) {
    if (mesh_.edge_groups.count(entry.key) != 0) {
      reader.refuse(one_line(entry.key), entry.value,
                    "the mesh has a group of this name already; choose another one");
    }
    mesh_.edge_groups[entry.key] =
        read_edges(reader, one_line(entry.key), entry.value, edges_, mesh_.node_count());
  }
}

Fix ItemReader::fix(const TomlValue& table) const {
  const Item item(*this, table, "fix", {"edges", "nodes", "axis", "from", "until"});
  Fix fix;
  fix.where = item.where();
  fix.nodes = item.group();
  item.book(fix.nodes.size());
  fix.axis = item.axis();
  fix.window = item.window();
  return fix;
}

Move ItemReader::move(const TomlValue& table) const {
  const Item item(*this, table, "move", {"edges", "nodes", "axis", "from", "until", "keys", "profile"});
  Move move;
  move.where = item.where();
  move.nodes = item.group();
  item.book(move.nodes.size());
  move.axis = item.axis();
  move.window = item.window();
  move.profile = static_cast<Profile>(item.choice("profile", profiles, 0));
  const bool with_velocity = move.profile == Profile::hermite;
  for (const auto& row :
       item.keys(with_velocity ? "t, ux, uy, vx, vy" : "t, ux, uy", with_velocity ? 5 : 3).rows) {
    move.keys.push_back({row[0], {row[1], row[2]}, with_velocity ? Vec2{row[3], row[4]} : Vec2{}});
  }
  return move;
}

Constraint ItemReader::constraint(const TomlValue& table) const {
  const Item item(*this, table, "constraint", {"terms", "value"});
  Constraint constraint;
  constraint.where = item.where();
  const std::string form = "[node, \"x\" or \"y\", coefficient]";
  const TomlValue& terms = item.require("terms", fmt::format("a list of {} is needed", form));
  if (terms.type != TomlValue::Type::array || terms.items.empty()) {
    item.refuse("terms", terms, fmt::format("a list of one or more {} is needed", form));
  }
  for (std::size_t i = 0; i < terms.items.size(); ++i) {
    const TomlValue& term = terms.items[i];
    const std::string key = fmt::format("terms[{}]", i);
    const auto text_is = [&](const char* text) { return term.items[1].text == text; };
    if (term.type != TomlValue::Type::array || term.items.size() != 3 ||
        term.items[1].type != TomlValue::Type::string || !(text_is("x") || text_is("y")) ||
        !term.items[2].is_number()) {
      item.refuse(key, term, form + " is needed");
    }
    const NumberRule any;
    if (!any.admits(term.items[2].number) || term.items[2].number == 0.0) {
      item.refuse(key, term, "a finite coefficient other than 0 is needed");
    }
    const int node = item.integer(key + "[0]", term.items[0], 0, mesh_.node_count() - 1, "node number");
    constraint.terms.push_back({node, text_is("x") ? Axis::x : Axis::y, term.items[2].number});
  }
  constraint.value = item.number("value", {.unit = "m"}, 0.0);
  return constraint;
}

Traction ItemReader::traction(const TomlValue& table) const {
  const Item item(*this, table, "traction", {"edges", "vector", "keys", "from", "until"});
  Traction traction;
  traction.where = item.where();
  traction.edges = item.edges(item.require("edges", "a group's name or [[i, j], ...] is needed"));
  item.book(traction.edges.size());
  static const std::array<std::string, 2> ways{"vector", "keys"};
  if (item.exactly_one(ways) == "vector") {
    traction.keys = {{0.0, item.pair("vector", {.unit = "Pa"}, {})}};
  } else {
    for (const auto& row : item.keys("t, Px, Py", 3).rows)
      traction.keys.push_back({row[0], {row[1], row[2]}});
  }
  traction.window = item.window();
  return traction;
}

Probe ItemReader::probe(const TomlValue& table) const {
  const Item item(*this, table, "probe", {"name", "edges", "nodes"});
  Probe probe;
  probe.where = item.where();
  const TomlValue& name = item.require("name", "the beginning of its columns in history.csv is needed");
  probe.name = item.text("name", {});
  const bool plain = std::all_of(probe.name.begin(), probe.name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  if (probe.name.empty() || !plain) {
    item.refuse("name", name, "one or more of A-Z, a-z, 0-9, _ and - are needed");
  }
  probe.nodes = item.group();
  item.book(2 * probe.nodes.size());
  if (const TomlValue* edges = item.find("edges")) probe.edges = item.edges(*edges);
  return probe;
}

}  // namespace rheo
