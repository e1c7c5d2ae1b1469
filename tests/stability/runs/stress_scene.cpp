#include "stability/runs/stress_scene.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "rheo/shapes.hpp"

namespace rheo::test {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  double decades(double low, double high) { return low * std::pow(high / low, unit()); }
  int below(int n) { return std::min(n - 1, static_cast<int>(unit() * n)); }
  bool chance(double p) { return unit() < p; }

 private:
  std::mt19937_64 random_;
};

// Coordinates from 0 to 1 whose pieces shrink by up to `ratio` from first to last.
std::vector<double> graded(int pieces, double ratio) {
  std::vector<double> x{0.0};
  for (int k = 0; k < pieces; ++k)
    x.push_back(x.back() + std::pow(ratio, -static_cast<double>(k) / std::max(1, pieces - 1)));
  for (double& each : x) each /= x.back();
  return x;
}

Mesh mesh_of(Draw& draw, double size, std::string& kind) {
  Mesh mesh;
  const double choice = draw.unit();
  if (choice < 0.1) {
    kind = "triangle";
    mesh.points = {{0, 0}, {size, 0}, {size * draw.unit(), size * draw.decades(1e-3, 2)}};
    mesh.triangles = {{0, 1, 2}};
  } else if (choice < 0.2) {
    kind = "disk";
    mesh = disk(size, 1);
  } else {
    const int nx = 2 + draw.below(3), ny = 2 + draw.below(2);
    mesh = rectangle({size, size * draw.decades(0.2, 2)}, nx, ny,
                     draw.chance(0.5) ? Diagonal::rising : Diagonal::alternating);
    if (choice < 0.4) {
      kind = "graded";
      const std::vector<double> x = graded(nx - 1, draw.decades(1, 1e4)),
                                y = graded(ny - 1, draw.decades(1, 1e4));
      for (std::size_t i = 0; i < mesh.points.size(); ++i)
        mesh.points[i] = {size * x[i % static_cast<std::size_t>(nx)],
                          size * y[i / static_cast<std::size_t>(nx)]};
    } else if (choice < 0.6) {
      kind = "sliver";  // a row as flat as its small angles say
      const double flat = size / (nx - 1) * std::tan(draw.decades(0.01, 10) * std::numbers::pi / 180);
      for (std::size_t i = static_cast<std::size_t>(nx * (ny - 1)); i < mesh.points.size(); ++i)
        mesh.points[i].y = mesh.points[i - static_cast<std::size_t>(nx)].y + flat;
    } else {
      kind = "plain";
      const double jitter = 0.3 * draw.unit() * size / nx;
      for (Vec2& p : mesh.points)
        p.x += jitter * (draw.unit() - 0.5), p.y += 0.3 * jitter * (draw.unit() - 0.5);
    }
  }
  mesh.thickness = draw.decades(1e-3, 10);
  mesh.edge_groups.clear();
  prepare(mesh);
  return mesh;
}

// Relaxation times from 1e-9 s to infinity; for lambda and mu alike or not.
Material material_of(Draw& draw, Mass mass, int most_branches, bool whole) {
  const auto relaxation = [&] { return draw.chance(0.15) ? infinite : draw.decades(1e-9, 1e6); };
  Material m;
  m.density = draw.decades(1e-6, 1e6);
  m.mass = mass;
  const double modulus = draw.decades(1e-2, 1e8);
  const int count = 1 + draw.below(most_branches);
  for (int k = 0; k < count; ++k) {
    MaxwellBranch b;
    b.lambda_ela = draw.chance(0.1) ? 0.0 : modulus * draw.decades(1e-2, 1e2);
    b.mu_ela = draw.chance(0.05) && b.lambda_ela > 0.0 ? 0.0 : modulus * draw.decades(1e-2, 1e2);
    const double time = relaxation();
    if (b.lambda_ela > 0.0) b.lambda_vis = b.lambda_ela * time;
    if (b.mu_ela > 0.0) b.mu_vis = b.mu_ela * (draw.chance(0.4) ? time : relaxation());
    if (k == 0)
      m.lambda_ela = b.lambda_ela, m.mu_ela = b.mu_ela, m.lambda_vis = b.lambda_vis, m.mu_vis = b.mu_vis;
    else
      m.more_branches.push_back(b);
  }
  if (whole) {
    if (draw.chance(0.7)) m.elastic = {modulus * draw.decades(1e-3, 10), modulus * draw.decades(1e-3, 10)};
    if (draw.chance(0.7)) {
      const double time = draw.decades(1e-9, 1e3);
      m.viscous = {modulus * time * draw.decades(1e-2, 1e2), modulus * time * draw.decades(1e-2, 1e2)};
    }
  }
  return m;
}

// lambda over mu from 0 to 1e8, the relaxation times kept: nearly incompressible, or each branch for itself.
void spread_ratios(Draw& draw, Material& m) {
  const double choice = draw.unit();
  const double shared = choice < 0.2 ? 0.0 : draw.decades(1e4, 1e8);
  const auto ratio = [&] { return choice < 0.7 ? shared : draw.decades(1e-8, 1e8); };
  const auto spread = [&](double& lambda_ela, double& lambda_vis, double mu_ela, double mu_vis) {
    if (mu_ela == 0.0) return;
    const double time = lambda_ela > 0.0 ? lambda_vis / lambda_ela : mu_vis / mu_ela;
    lambda_ela = mu_ela * ratio();
    if (lambda_ela > 0.0) lambda_vis = lambda_ela * time;
  };
  spread(m.lambda_ela, m.lambda_vis, m.mu_ela, m.mu_vis);
  for (MaxwellBranch& b : m.more_branches) spread(b.lambda_ela, b.lambda_vis, b.mu_ela, b.mu_vis);
  for (Moduli* moduli : {&m.elastic, &m.viscous}) moduli->lambda = moduli->mu * ratio();
}

struct Sides {
  std::set<int> left, bottom;
};

Sides sides_of(const Mesh& mesh) {
  Sides sides;
  double x = infinite, y = infinite;
  for (const Vec2& p : mesh.points) x = std::min(x, p.x), y = std::min(y, p.y);
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (mesh.points[static_cast<std::size_t>(i)].x == x) sides.left.insert(i);
    if (mesh.points[static_cast<std::size_t>(i)].y == y) sides.bottom.insert(i);
  }
  return sides;
}

void fix(Scene& scene, const std::set<int>& nodes, Axis axis) {
  scene.fixes.push_back({{nodes.begin(), nodes.end()}, axis, {}, "fix"});
}

void constrain(Draw& draw, StressScene& stress) {
  Scene& scene = stress.scene;
  const Mesh& mesh = scene.mesh;
  const auto& [left, bottom] = sides_of(mesh);
  const double choice = draw.unit();
  if (choice < 0.25) {
    stress.constraints = "free";
  } else if (choice < 0.5) {
    stress.constraints = "clamped";
    fix(scene, left, Axis::both);
  } else if (choice < 0.65) {
    stress.constraints = "rollers";
    fix(scene, left, Axis::x);
    fix(scene, bottom, Axis::y);
  } else if (choice < 0.75) {
    stress.constraints = "nearly all held";
    std::set<int> all;
    for (int i = 0; i + 1 < mesh.node_count(); ++i) all.insert(i);
    fix(scene, all, Axis::both);
  } else {
    stress.constraints = "tied";
    if (draw.chance(0.5)) fix(scene, left, Axis::both);
    const int last = mesh.node_count() - 1;
    scene.constraints.push_back(
        {{{last, Axis::x, 1.0}, {last - 1, Axis::y, draw.decades(0.1, 10)}}, 0.0, "tie"});
  }
  if (stress.constraints != "tied" && draw.chance(0.2)) {
    stress.constraints += ", Baumgarte";
    scene.time.constraints = ConstraintMethod::baumgarte;
  }
  // From none to far beyond what any step takes.
  scene.time.baumgarte = draw.chance(0.15) ? 0.0 : stress.frequency * draw.decades(1e-2, 1e3);
}

// More constraints than the body needs, by chance all that it can move by; those that say no more than the
// others, or hardly more, are the redundant ones.
void over_constrain(Draw& draw, StressScene& stress) {
  Scene& scene = stress.scene;
  const int last = scene.mesh.node_count() - 1;
  const auto [left, bottom] = sides_of(scene.mesh);
  const double c = draw.decades(0.1, 10), d = draw.decades(0.1, 10);
  const Constraint tie{{{last, Axis::x, 1.0}, {last - 1, Axis::y, c}}, 0.0, "tie"};
  const auto times = [](Constraint constraint, double factor) {
    for (ConstraintTerm& term : constraint.terms) term.coefficient *= factor;
    return constraint;
  };
  switch (draw.below(6)) {
    case 0:
      stress.constraints = "over: fixed twice";
      fix(scene, left, Axis::both);
      fix(scene, left, Axis::x);
      fix(scene, bottom, Axis::y);
      fix(scene, {0, last}, Axis::y);
      break;
    case 1:
      stress.constraints = "over: tied twice";
      scene.constraints = {tie};
      for (int copies = 1 + draw.below(3); copies > 0; --copies)
        stress.redundant.push_back(times(tie, (draw.chance(0.5) ? 1 : -1) * draw.decades(1e-3, 1e3)));
      break;
    case 2:
      stress.constraints = "over: held and tied";
      fix(scene, left, Axis::both);
      stress.redundant = {{{{*left.begin(), Axis::x, 1.0}, {*left.rbegin(), Axis::y, c}}, 0.0, "tie"}};
      break;
    case 3:
      stress.constraints = "over: a loop";
      scene.constraints = {{{{last, Axis::x, 1.0}, {last - 1, Axis::x, -c}}, 0.0, "tie"},
                           {{{last - 1, Axis::x, 1.0}, {last - 2, Axis::x, -d}}, 0.0, "tie"}};
      stress.redundant = {{{{last - 2, Axis::x, c * d}, {last, Axis::x, -1.0}}, 0.0, "tie"}};
      break;
    case 4: {
      stress.constraints = "over: all freedoms";
      const bool one_left = draw.chance(0.5);
      for (int node = 0; node <= last; ++node) {
        scene.constraints.push_back({{{node, Axis::x, draw.decades(0.1, 10)}}, 0.0, "grip"});
        if (node < last || !one_left) scene.constraints.push_back({{{node, Axis::y, 1.0}}, 0.0, "grip"});
      }
      stress.redundant = {{{{0, Axis::x, c}, {last - 1, Axis::y, d}}, 0.0, "tie"}};
      break;
    }
    default:
      stress.constraints = "over: nearly alike";
      scene.constraints = {tie};
      stress.redundant = {tie};
      stress.redundant[0].terms[1].coefficient *= 1.0 + draw.decades(1e-9, 0.1);
  }
  if (draw.chance(0.5)) scene.time.constraints = ConstraintMethod::baumgarte;
  scene.time.baumgarte = draw.chance(0.15) ? 0.0 : stress.frequency * draw.decades(1e-2, 1e3);
}

}  // namespace

StressScene stress_scene(std::uint64_t seed, int number) {
  Draw draw(seed * 1000003u + static_cast<std::uint64_t>(number));
  StressScene stress;
  Scene& scene = stress.scene;
  const double size = draw.decades(1e-6, 1e6);
  scene.mesh = mesh_of(draw, size, stress.mesh);
  const Mass mass = draw.chance(0.5) ? Mass::lumped : Mass::consistent;
  const double kind = draw.unit();
  stress.material = kind < 0.45 ? "branch" : kind < 0.6 ? "branches" : kind < 0.8 ? "whole" : "regions";
  const bool whole = stress.material == "whole" || (stress.material == "regions" && draw.chance(0.4));
  const int most = stress.material == "branch" ? 1 : stress.material == "regions" ? 3 : 8;
  scene.material = material_of(draw, mass, most, whole);
  if (stress.material == "regions") {
    const int others = 1 + draw.below(2);
    for (int r = 0; r < others; ++r)
      scene.regions.push_back({"region", material_of(draw, mass, most, whole), {}, "region"});
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t)
      scene.region_of_triangle.push_back(
          static_cast<std::int32_t>(t % scene.regions.size() + (t > 0 ? 1 : 0)) % (others + 1));
  }
  // By turns, so that the other scenes are what they were.
  const bool ratios = number % 5 == 1, over = number % 5 == 2;
  Draw more((seed + 1) * 7000003u + static_cast<std::uint64_t>(number));
  if (ratios) {
    spread_ratios(more, scene.material);
    for (Region& region : scene.regions) spread_ratios(more, region.material);
  }
  const Moduli springs = scene.material.instantaneous();
  stress.frequency = std::sqrt((springs.lambda + 2 * springs.mu) / scene.material.density) / size;
  for (const Relaxation& each : relaxations_of(scene.material))
    stress.rate = std::max(stress.rate, each.rate);
  if (over)
    over_constrain(more, stress);
  else
    constrain(draw, stress);
  scene.tractions.push_back({{scene.mesh.edge_groups.at("boundary")[static_cast<std::size_t>(draw.below(
                                 static_cast<int>(scene.mesh.edge_groups.at("boundary").size())))]},
                             {{0.0, {draw.decades(1e-6, 1e12), draw.decades(1e-6, 1e12)}}},
                             {},
                             "traction"});
  return stress;
}

}  // namespace rheo::test
