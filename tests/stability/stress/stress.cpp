// The whole stress matrix: a table, each broken promise, and the stability map.
//
//   rheo_stress [--count N] [--seed S] [--from K] [--steps N] [--csv FILE] [--map FILE.png]

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "stability/runs/stress_run.hpp"
#ifdef RHEO_STRESS_MAP
#include "render/context.hpp"
#include "render/plot.hpp"
#include "render/png.hpp"
#endif

namespace {

using rheo::IntegratorKind;
using rheo::test::StressOutcome;
using rheo::test::StressScene;

struct Asked {
  int count = 2000, from = 0, steps = 10000;
  std::uint64_t seed = 1;
  std::string csv, map;
};

Asked asked(int argc, char** argv) {
  Asked a;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view key = argv[i];
    if (i + 1 == argc) throw std::invalid_argument(fmt::format("{}: a value is needed", key));
    const std::string value = argv[i + 1];
    if (key == "--count")
      a.count = std::stoi(value);
    else if (key == "--from")
      a.from = std::stoi(value);
    else if (key == "--steps")
      a.steps = std::stoi(value);
    else if (key == "--seed")
      a.seed = std::stoull(value);
    else if (key == "--csv")
      a.csv = value;
    else if (key == "--map")
      a.map = value;
    else
      throw std::invalid_argument(fmt::format("{}: --count, --from, --seed, --steps, --csv or --map", key));
  }
  return a;
}

const char* name_of(rheo::test::Promise promise) {
  switch (promise) {
    case rheo::test::Promise::limit:
      return "no step beyond the true limit";
    case rheo::test::Promise::nearness:
      return "within 5 % of it";
    case rheo::test::Promise::stable:
      return "stable at 0.99 of the promise";
    case rheo::test::Promise::refused:
      return "refused at 1.05 of the true limit";
    case rheo::test::Promise::named:
      return "redundant constraints: told why";
    case rheo::test::Promise::noticed:
      return "allowed, noticed before it shows";
  }
  return "";
}

struct Row {
  int scenes = 0, determined = 0, no_step = 0, grew = 0, broken = 0;
  double lowest = 1e300, sum = 0.0, worst_energy = 0.0, first_energy = 0.0;

  void add(const StressOutcome& o) {
    ++scenes;
    grew += o.grew;
    broken += !o.broken.empty();
    no_step += o.predicted == 0.0;
    worst_energy = std::max(worst_energy, o.worst_energy);
    first_energy = std::max(first_energy, o.first_energy);
    if (!o.truth.determined() || !std::isfinite(o.truth.low) || o.truth.low == 0.0) return;
    ++determined;
    lowest = std::min(lowest, o.predicted / o.truth.low);
    sum += o.predicted / o.truth.low;
  }
};

// Of one integrator in the map: fastest relaxation over the body's frequency, the promised step times the
// latter. (True limits lie at most a twentieth higher: within the points.)
struct Points {
  std::vector<double> x, promised;
};

#ifdef RHEO_STRESS_MAP
void draw_map(const std::string& file, const std::map<std::string, Points>& points) {
  const auto context = render::open_context(render::Backend::automatic, 1280, 720);
  render::Plot plot;
  plot.title = "Largest stable steps of random bodies";
  plot.x_label = "fastest relaxation rate over the body's frequency";
  plot.y_label = "step times the body's frequency";
  plot.x_scale = plot.y_scale = render::Scale::log;
  for (const auto& [name, p] : points) {
    plot.series.push_back({name == "rk4" ? "RK4" : "Euler", p.x, p.promised, true, false});
  }
  render::write_png(file, render::draw_plot(*context, plot));
}
#endif

int run(const Asked& a) {
  std::map<std::string, Row> rows;
  std::map<std::string, Points> points;
  std::ofstream csv;
  if (!a.csv.empty()) {
    csv.open(a.csv);
    csv << "number,integrator,mesh,material,constraints,predicted,true_low,true_high,worst_energy,grew,"
           "broken\n";
  }
  std::map<std::string, std::map<rheo::test::Promise, int>> broken;
  int broken_in_all = 0, redundant = 0, redundancies_refused = 0;
  for (int number = a.from; number < a.from + a.count; ++number) {
    StressScene scene = rheo::test::stress_scene(a.seed, number);
    const rheo::test::Redundancy redundancy = rheo::test::settle(scene);
    redundant += redundancy.any;
    redundancies_refused += redundancy.refused;
    for (const rheo::test::Broken& each : redundancy.broken) {
      ++broken["rk4"][each.promise], ++broken["euler"][each.promise];
      ++broken_in_all;
      fmt::print("broken: {} ({}): {}\n", number, scene.constraints, each.text);
    }
    const rheo::test::TrueSpectrum truth(scene.scene);
    for (const IntegratorKind kind : {IntegratorKind::rk4, IntegratorKind::euler}) {
      const std::string name = kind == IntegratorKind::rk4 ? "rk4" : "euler";
      const StressOutcome o = rheo::test::stress(scene, truth, kind, {a.steps});
      rows[fmt::format("{:6} {:9} {}", name, "mesh", scene.mesh)].add(o);
      rows[fmt::format("{:6} {:9} {}", name, "material", scene.material)].add(o);
      rows[fmt::format("{:6} {:9} {}", name, "held", scene.constraints)].add(o);
      rows[fmt::format("{:6} all", name)].add(o);
      if (scene.rate > 0.0 && std::isfinite(o.truth.low) && o.truth.low > 0.0 && o.predicted > 0.0) {
        Points& p = points[name];
        p.x.push_back(scene.rate / scene.frequency);
        p.promised.push_back(o.predicted * scene.frequency);
      }
      for (const rheo::test::Broken& each : o.broken) {
        ++broken[name][each.promise];
        ++broken_in_all;
        fmt::print("broken: {} {} ({}, {}, {}): {}\n", number, name, scene.mesh, scene.material,
                   scene.constraints, each.text);
      }
      if (csv.is_open())
        csv << fmt::format("{},{},{},{},\"{}\",{:.9g},{:.9g},{:.9g},{:.9g},{},{}\n", number, name, scene.mesh,
                           scene.material, scene.constraints, o.predicted, o.truth.low, o.truth.high,
                           o.worst_energy, o.grew ? 1 : 0, o.broken.size());
    }
    if (isatty(2) != 0) fmt::print(stderr, "\r{} of {}", number + 1 - a.from, a.count);
  }
  if (isatty(2) != 0) fmt::print(stderr, "\n");
  fmt::print("{:36} {:>6} {:>10} {:>8} {:>8} {:>8} {:>12} {:>10} {:>6} {:>7}\n", "predicted over true",
             "scenes", "determined", "no step", "lowest", "mean", "energy/work", "at first", "grew",
             "broken");
  for (const auto& [name, row] : rows)
    fmt::print("{:36} {:6} {:10} {:8} {:8.4f} {:8.4f} {:12.9f} {:10.6f} {:6} {:7}\n", name, row.scenes,
               row.determined, row.no_step, row.determined > 0 ? row.lowest : 0.0,
               row.determined > 0 ? row.sum / row.determined : 0.0, row.worst_energy, row.first_energy,
               row.grew, row.broken);
  fmt::print("\n{:36} {:>6} {:>6}\n", "broken promises", "rk4", "euler");
  for (const rheo::test::Promise promise : rheo::test::promises)
    fmt::print("{:36} {:6} {:6}\n", name_of(promise), broken["rk4"][promise], broken["euler"][promise]);
  fmt::print("\nredundant constraints in {} scenes: refused, with the reason, in {}; taken in {}\n",
             redundant, redundancies_refused, redundant - redundancies_refused);
#ifdef RHEO_STRESS_MAP
  if (!a.map.empty()) draw_map(a.map, points);
#else
  if (!a.map.empty()) throw std::invalid_argument("--map: this build has no renderer");
#endif
  return broken_in_all == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(asked(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "rheo_stress: {}\n", error.what());
    return 2;
  }
}
