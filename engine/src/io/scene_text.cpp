#include "rheo/io/scene_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "io/message.hpp"

namespace rheo {
namespace {

std::string number(double x) {
  if (x == 0.0 && std::signbit(x)) return "-0.0";  // "-0" would be a whole number, which has no sign
  return std::isinf(x) ? (x > 0 ? "inf" : "-inf") : fmt::format("{:.17g}", x);
}

// Bytes that are no text (a file's name as a title, say) as \xNN: TOML has no words for them.
std::string quoted(std::string_view text) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  std::string out = "\"";
  while (!text.empty()) {
    const auto end = std::find_if(text.begin(), text.end(), is_control);
    for (const char c : one_line(std::string_view(text.begin(), end), std::string::npos)) {
      if (c == '"' || c == '\\') out += '\\';
      out += c;
    }
    text.remove_prefix(static_cast<std::size_t>(end - text.begin()));
    if (text.empty()) break;
    out += fmt::format("\\u{:04x}", static_cast<unsigned>(text.front()));
    text.remove_prefix(1);
  }
  return out + '"';
}

const char* name_of(Axis axis) {
  return axis == Axis::both ? "both" : axis == Axis::x ? "x" : "y";
}

class SceneWriter {
 public:
  explicit SceneWriter(const Scene& scene) : scene_(scene) {}

  std::string text() {
    line("title = {}", quoted(scene_.title));
    mesh();
    material("material", scene_.material);
    for (std::size_t r = 0; r < scene_.regions.size(); ++r) region(r);
    line("\n[body_force]\nacceleration = [{}, {}]", number(scene_.body_acceleration.x),
         number(scene_.body_acceleration.y));
    for (const Fix& fix : scene_.fixes) {
      line("\n[[fix]]");
      held(fix.nodes, fix.axis);
      window(fix.window);
    }
    for (const Move& each : scene_.moves) move(each);
    for (const Constraint& each : scene_.constraints) constraint(each);
    for (const Traction& each : scene_.tractions) traction(each);
    for (const Probe& probe : scene_.probes) {
      line("\n[[probe]]\nname = {}", quoted(probe.name));
      if (probe.edges.empty())
        nodes(probe.nodes);
      else
        edges("edges", probe.edges);
    }
    time();
    render();
    return std::move(out_);
  }

 private:
  template <class... Values>
  void line(fmt::format_string<Values...> format, Values&&... values) {
    out_ += fmt::format(format, std::forward<Values>(values)...);
    out_ += '\n';
  }

  // name = [row, row, ...], one a line where they are many.
  template <class Rows, class Text>
  void rows(const std::string& name, const Rows& all, const Text& text) {
    out_ += name + " = [";
    bool first = true;
    for (const auto& row : all) {
      if (!first) out_ += all.size() > 8 ? ",\n  " : ", ";
      first = false;
      out_ += text(row);
    }
    out_ += "]\n";
  }
  void edges(const std::string& name, const std::vector<Edge>& all) {
    rows(name, all, [](const Edge& e) { return fmt::format("[{}, {}]", e[0], e[1]); });
  }
  void numbers(const std::string& name, const std::vector<int>& all) {
    rows(name, all, [](int i) { return std::to_string(i); });
  }
  void nodes(const std::vector<int>& all) { numbers("nodes", all); }
  void held(const std::vector<int>& all, Axis axis) {
    nodes(all);
    if (axis != Axis::both) line("axis = {}", quoted(name_of(axis)));
  }
  void window(const Window& w) {
    if (w.from != 0.0) line("from = {}", number(w.from));
    if (std::isfinite(w.until)) line("until = {}", number(w.until));
  }

  void mesh() {
    line("\n[mesh]");
    if (scene_.mesh.thickness_of_node.empty())
      line("thickness = {}", number(scene_.mesh.thickness));
    else
      rows("thickness", scene_.mesh.thickness_of_node, [](double thickness) { return number(thickness); });
    rows("points", scene_.mesh.points,
         [](const Vec2& p) { return fmt::format("[{}, {}]", number(p.x), number(p.y)); });
    rows("triangles", scene_.mesh.triangles,
         [](const Triangle& t) { return fmt::format("[{}, {}, {}]", t[0], t[1], t[2]); });
    line("\n[edges]");
    for (const auto& [name, group] : scene_.mesh.edge_groups) {
      if (name != "boundary" && !group.empty()) edges(quoted(name), group);
    }
  }

  void branch(const MaxwellBranch& b) {
    line("lambda_ela = {}\nmu_ela = {}\nlambda_vis = {}\nmu_vis = {}", number(b.lambda_ela), number(b.mu_ela),
         number(b.lambda_vis), number(b.mu_vis));
  }

  void material(const std::string& table, const Material& m) {
    line("\n[{}]", table);
    branch(m.branch(0));
    line("density = {}\nmass = {}", number(m.density),
         quoted(m.mass == Mass::lumped ? "lumped" : "consistent"));
    if (m.elastic.lambda != 0.0 || m.elastic.mu != 0.0)
      line("\n[{}.elastic]\nlambda = {}\nmu = {}", table, number(m.elastic.lambda), number(m.elastic.mu));
    if (m.viscous.lambda != 0.0 || m.viscous.mu != 0.0)
      line("\n[{}.viscous]\nlambda = {}\nmu = {}", table, number(m.viscous.lambda), number(m.viscous.mu));
    for (const MaxwellBranch& b : m.more_branches) {
      line("\n[[{}.maxwell]]", table);
      branch(b);
    }
  }

  void region(std::size_t r) {
    std::vector<int> triangles;
    for (std::size_t t = 0; t < scene_.region_of_triangle.size(); ++t)
      if (scene_.region_of_triangle[t] == static_cast<std::int32_t>(r) + 1)
        triangles.push_back(static_cast<int>(t));
    line("\n[[region]]\nname = {}", quoted(scene_.regions[r].name));
    numbers("triangles", triangles);
    material("region.material", scene_.regions[r].material);
  }

  void move(const Move& m) {
    static constexpr const char* profiles[]{"smooth", "linear", "hermite"};
    line("\n[[move]]");
    held(m.nodes, m.axis);
    window(m.window);
    line("profile = \"{}\"", profiles[static_cast<int>(m.profile)]);
    rows("keys", m.keys, [&](const MoveKey& k) {
      if (m.profile == Profile::hermite)
        return fmt::format("[{}, {}, {}, {}, {}]", number(k.t), number(k.u.x), number(k.u.y), number(k.v.x),
                           number(k.v.y));
      return fmt::format("[{}, {}, {}]", number(k.t), number(k.u.x), number(k.u.y));
    });
  }

  void constraint(const Constraint& c) {
    line("\n[[constraint]]\nvalue = {}", number(c.value));
    rows("terms", c.terms, [](const ConstraintTerm& t) {
      return fmt::format("[{}, \"{}\", {}]", t.node, name_of(t.axis), number(t.coefficient));
    });
  }

  void traction(const Traction& t) {
    line("\n[[traction]]");
    edges("edges", t.edges);
    window(t.window);
    if (t.keys.size() == 1) {
      line("vector = [{}, {}]", number(t.keys[0].p.x), number(t.keys[0].p.y));
      return;
    }
    rows("keys", t.keys, [](const TractionKey& k) {
      return fmt::format("[{}, {}, {}]", number(k.t), number(k.p.x), number(k.p.y));
    });
  }

  void time() {
    static constexpr const char* integrators[]{"rk4", "euler", "exponential", "implicit"};
    const TimeSettings& t = scene_.time;
    line("\n[time]\nduration = {}\nframe_rate = {}", number(t.duration), number(t.frame_rate));
    if (t.integrator != IntegratorKind::automatic)
      line("integrator = \"{}\"", integrators[static_cast<int>(t.integrator)]);
    if (t.step > 0.0) line("step = {}", number(t.step));
    if (t.accuracy > 0.0) line("accuracy = {}", number(t.accuracy));
    line("baumgarte = {}", number(t.baumgarte));
    if (t.constraints == ConstraintMethod::baumgarte) line("constraints = \"baumgarte\"");
  }

  void render() {
    static constexpr const char* colors[]{"w_lambda", "w_mu", "w", "speed", "none"};
    const PictureSettings& p = scene_.picture;
    line("\n[render]\ncolor = \"{}\"\nsize = [{}, {}]", colors[static_cast<int>(p.color)], p.size[0],
         p.size[1]);
    if (p.branch != 0) line("branch = {}", p.branch);
    if (p.every != 1) line("every = {}", p.every);
    // A session may be shorter than the scene that it began with.
    std::vector<std::string> shapes;
    for (std::size_t k = 0; k < p.sheet.size() && p.sheet[k] <= scene_.time.duration; ++k) {
      const bool bare = p.captions.empty() || p.captions[k].empty();
      shapes.push_back(bare ? number(p.sheet[k])
                            : fmt::format("[{}, {}]", number(p.sheet[k]), quoted(p.captions[k])));
    }
    if (!shapes.empty()) rows("sheet", shapes, [](const std::string& shape) { return shape; });
    if (p.bounds)
      line("bounds = [{}, {}, {}, {}]", number((*p.bounds)[0]), number((*p.bounds)[1]),
           number((*p.bounds)[2]), number((*p.bounds)[3]));
    if (p.arrow_scale != 0.0) line("arrow_scale = {}", number(p.arrow_scale));
    if (!p.range_auto) line("range = [{}, {}]", number(p.range[0]), number(p.range[1]));
  }

  const Scene& scene_;
  std::string out_;
};

}  // namespace

std::string scene_text(const Scene& scene) {
  return SceneWriter(scene).text();
}

}  // namespace rheo
