// A run that goes on from a checkpoint is the run that was never cut, to the bit: state, energies, reactions
// and counters, whatever the integrator, the material, the constraints and the moment.
#include "rheo/io/checkpoint.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "support/event_scenes.hpp"
#include "support/live_scenes.hpp"
#include "support/sanitized.hpp"
#include "support/whole_materials.hpp"

namespace rheo::test {
namespace {

namespace fs = std::filesystem;

struct Case {
  std::string name;
  Scene scene;
  SimulationOptions options;
};

Case with(Case each, IntegratorKind kind, const std::string& name) {
  each.scene.time.integrator = kind;
  each.name += " " + name;
  return each;
}

// A harder half in the middle of the beam.
Scene layered(Scene scene) {
  Region region;
  region.name = "layer";
  region.material = scene.material;
  region.material.mu_ela *= 3.0;
  region.material.lambda_vis *= 0.5;
  scene.regions.push_back(region);
  scene.region_of_triangle.assign(scene.mesh.triangles.size(), 0);
  for (std::size_t i = 0; i < scene.region_of_triangle.size(); i += 2) scene.region_of_triangle[i] = 1;
  return scene;
}

Scene with_whole_material(Scene scene) {
  const Response mu = presets().back().mu;
  const Mass mass = scene.material.mass;
  scene.material = material_of(mu.scaled(1.3), mu, 0.2);
  scene.material.mass = mass;
  return scene;
}

// Pulled for a while, under its weight for ever, onto springs and dashpots: it comes to rest, steps end, and
// begin again with the second pull.
Scene comes_to_rest(Mass mass) {
  Scene scene = paper_beam(mass);
  scene.material = {7.0, 5.0, 0.7, 0.5, 0.2, mass};
  scene.material.elastic = {6.0, 4.0};
  scene.material.viscous = {0.5, 0.3};
  scene.fixes[0].nodes = nodes_of(scene.mesh.edge_groups.at("bottom"));
  scene.tractions[0].window = {0.0, 0.5};
  scene.tractions.push_back(scene.tractions[0]);
  scene.tractions[1].window = {14.321, 14.5};
  scene.body_acceleration = {0.0, -0.5};
  scene.time.duration = 15.0;
  return scene;
}

std::vector<Case> scenes(Mass mass) {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, Scene scene) {
    scene.time.duration = std::max(scene.time.duration, 1.0);
    scene.time.frame_rate = scene.time.duration > 2.0 ? 1.0 : 20.0;
    cases.push_back({name + (mass == Mass::lumped ? " lumped" : " consistent"), std::move(scene), {}});
  };
  add("ramped", ramped(mass));
  add("smooth", moved(mass, Profile::smooth));
  add("hermite", moved(mass, Profile::hermite));
  add("linear", moved(mass, Profile::linear));
  add("tied", tied(mass));
  add("pulled together", pulled_together(mass));
  add("roller", roller(mass));
  add("caught", caught(mass));
  add("baumgarte", baumgarte(moved(mass, Profile::smooth)));
  add("one rate", with_material(caught(mass), 7.0, 5.0, 3.5, 2.5));
  add("elastic", with_material(caught(mass), 7.0, 5.0, forever, forever));
  add("mu alone", with_material(ramped(mass), 0.0, 5.0, 4.0, 2.0));
  add("layered", layered(moved(mass, Profile::smooth)));
  add("whole", with_whole_material(moved(mass, Profile::hermite)));
  add("whole, layered", layered(with_whole_material(caught(mass))));
  add("rest", comes_to_rest(mass));
  return cases;
}

bool is_general(const Scene& scene) {
  return !scene.constraints.empty() || scene.time.constraints == ConstraintMethod::baumgarte;
}

constexpr bool both_masses = !is_sanitized;  // else a scene has one or the other

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    int number = 0;
    for (const Case& each : scenes(mass)) {
      const bool is_turn = number++ % 2 == (mass == Mass::lumped ? 0 : 1) || each.name.starts_with("caught");
      if (!is_turn && !both_masses) continue;
      cases.push_back(with(each, IntegratorKind::rk4, "rk4"));
      cases.push_back(with(each, IntegratorKind::implicit, "implicit"));
      if (!is_general(each.scene)) cases.push_back(with(each, IntegratorKind::exponential, "exponential"));
      // Undamped swings have no stable step.
      if (each.name.find("elastic") == std::string::npos)
        cases.push_back(with(each, IntegratorKind::euler, "euler"));
    }
  }
  // Other ways to the same forces, and energies looked at now and then only.
  for (const char* const name : {"ramped lumped rk4", "caught lumped rk4"}) {
    Case each = *std::find_if(cases.begin(), cases.end(), [&](const Case& c) { return c.name == name; });
    each.options.kernel = Kernel::csr;
    each.name += " csr";
    cases.push_back(each);
    each.options.kernel = Kernel::element;
    each.options.energies = false;
    each.name += " element without energies";
    cases.push_back(each);
  }
  return cases;
}

// All that a run shows at an output.
std::vector<double> shown(Simulation& simulation) {
  std::vector<double> numbers{simulation.time(), simulation.largest_step()};
  const auto add = [&](std::span<const double> x) { numbers.insert(numbers.end(), x.begin(), x.end()); };
  for (const auto x : {simulation.u(), simulation.v(), simulation.w_lambda(), simulation.w_mu(),
                       simulation.pull_lambda(), simulation.pull_mu()})
    add(x);
  const Energies e = simulation.energies();
  for (const double x : {e.kinetic, e.stored, e.dissipated, e.work}) numbers.push_back(x);
  add(simulation.reaction());
  add(simulation.external_force());
  add(simulation.multipliers());
  for (const int dof : simulation.held_dofs()) numbers.push_back(dof);
  for (const auto& traction : simulation.active_tractions())
    for (const double x : {static_cast<double>(traction.index), traction.p.x, traction.p.y})
      numbers.push_back(x);
  const Counters& c = simulation.counters();
  // (Factors are made again where a run goes on.)
  for (const std::int64_t count :
       {c.steps, c.force_evaluations, c.branch_updates, c.displacement_updates, c.mass_solves,
        c.constraint_solves, c.projections, c.energy_samples, c.steps_at_rest, c.shifted_solves})
    numbers.push_back(static_cast<double>(count));
  return numbers;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

fs::path checkpoint_file(const std::string& name) {
  const fs::path folder = fs::path(RHEO_TEST_OUTPUT) / "checkpoints";
  fs::create_directories(folder);
  return folder / name;
}

TEST(Checkpoint, ARunThatGoesOnIsTheSameToTheBit) {
  const fs::path file = checkpoint_file("same.rheo");
  for (const Case& each : all_cases()) {
    SCOPED_TRACE(each.name);
    const TimeSettings& time = each.scene.time;
    const std::int64_t count = output_count(time);
    std::vector<std::vector<double>> straight;
    {
      Simulation simulation(each.scene, each.options);
      for (std::int64_t k = 0; k < count; ++k) {
        ASSERT_FALSE(simulation.advance(output_time(time, k)));
        straight.push_back(shown(simulation));
      }
    }
    const bool rests = each.name.starts_with("rest");
    // Cut after these, one after the other: a run that has gone on is cut again.
    Simulation simulation(each.scene, each.options);
    for (std::int64_t k = 0; k < count; ++k) {
      ASSERT_FALSE(simulation.advance(output_time(time, k)));
      const auto numbers = shown(simulation);
      ASSERT_TRUE(same_bits(straight[static_cast<std::size_t>(k)], numbers)) << "output " << k;
      if (!rests && k != 0 && k != 1 && k != 4 && k != 9 && k != count / 2 && k != count - 2) continue;
      Simulation next(each.scene, each.options);
      if (k == 4) {  // by a file, which has to reach the disk
        write_checkpoint(file, simulation);
        go_on(next, read_checkpoint(file));
      } else {
        next.restore(simulation.snapshot());
      }
      ASSERT_TRUE(same_bits(numbers, shown(next))) << "just gone on, output " << k;
      simulation = std::move(next);
    }
    if (rests && each.scene.time.integrator == IntegratorKind::rk4) {
      EXPECT_GT(simulation.counters().steps_at_rest, 0);
    }
  }
}

// Between outputs, on both sides of an event, and with nobody looking at the state in between.
TEST(Checkpoint, AnyMomentWillDo) {
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    const Scene scene = caught(mass);
    for (const double t : {1e-4, 0.1234567, 0.1234568, 0.3, 0.4321, 0.4321001, 0.7999, 0.95}) {
      Simulation straight(scene), first(scene), second(scene);
      ASSERT_FALSE(straight.advance(t));
      ASSERT_FALSE(first.advance(t));
      second.restore(first.snapshot());
      ASSERT_FALSE(straight.advance(1.0));
      ASSERT_FALSE(second.advance(1.0));
      EXPECT_TRUE(same_bits(shown(straight), shown(second))) << t;
    }
  }
}

TEST(Checkpoint, ManyThreadsMakeTheSameOne) {
  Scene scene = live_block(Mass::lumped, 61, 41);
  scene.time.duration = 0.1;
  SimulationOptions two, one;
  two.threads = 2;
  one.threads = 1;
  Simulation straight(scene, one), first(scene, two), second(scene, one);
  ASSERT_FALSE(straight.advance(0.1));
  ASSERT_FALSE(first.advance(0.05));
  second.restore(first.snapshot());
  ASSERT_FALSE(second.advance(0.1));
  EXPECT_TRUE(same_bits(shown(straight), shown(second)));
}

// The start of another run on the same mesh: the shape is there at t = 0, under its own loads and holds.
TEST(Checkpoint, AnotherSceneBeginsFromIt) {
  const fs::path file = checkpoint_file("start.rheo");
  for (const auto& make : {ramped, tied}) {
    const Scene scene = layered(make(Mass::lumped));
    Simulation first(scene);
    ASSERT_FALSE(first.advance(0.5));
    write_checkpoint(file, first);
    Scene other = scene;
    other.tractions.clear();
    other.material.density *= 2.0;
    other.time.integrator = IntegratorKind::implicit;
    Simulation next(other);
    begin_from(next, read_checkpoint(file));
    EXPECT_EQ(next.time(), 0.0);
    EXPECT_TRUE(std::ranges::equal(first.u(), next.u()));
    EXPECT_TRUE(std::ranges::equal(first.w_lambda(), next.w_lambda()));
    const Energies start = next.energies();
    EXPECT_GT(start.stored, 0.0);
    EXPECT_EQ(start.work, 0.0);
    ASSERT_FALSE(next.advance(1.0));
    EXPECT_LT(next.energies().stored, start.stored);
    // Held where they were at the start.
    for (const int node : scene.fixes[0].nodes) EXPECT_EQ(next.u()[2 * node], first.u()[2 * node]);
  }
}

}  // namespace
}  // namespace rheo::test
