// A material as a scene file gives it, by every way there is, runs as its relaxation function says: a strip
// that is stretched at one speed for a while and then held.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "rheo/io/scene_file.hpp"
#include "rheo/relaxation.hpp"
#include "rheo/simulation.hpp"

namespace rheo::test {
namespace {

constexpr double pulled_until = 0.5, speed = 0.02;  // s, m/s

// 1 m x 0.5 m, every node's motion prescribed: no inertia at constant speed.
std::string scene_of(const std::string& material) {
  return "[mesh]\nshape = \"rectangle\"\nsize = [1, 0.5]\nnodes = [2, 2]\n[material]\ndensity = 1\n" +
         material +
         "\n[[fix]]\nedges = \"left\"\n[[fix]]\nedges = \"right\"\naxis = \"y\"\n"
         "[[move]]\nedges = \"right\"\naxis = \"x\"\nprofile = \"linear\"\n"
         "keys = [[0, 0, 0], [0.5, 0.01, 0]]\n"
         "[[probe]]\nname = \"grip\"\nedges = \"right\"\n[time]\nduration = 20\nintegrator = "
         "\"exponential\"\n";
}

// sigma(t) = integral over the pull of speed (r_lambda + 2 r_mu)(t - s) ds, t after it, by Simpson's rule.
double stress_by_relaxation(const Material& material, double t) {
  constexpr int halves = 20'000;  // the fastest branch, of 10 ms, has 400 of them
  const auto r = [&](double s) {
    const Moduli m = relaxation(material, t - s);
    return m.lambda + 2.0 * m.mu;
  };
  const double h = pulled_until / halves;
  double sum = r(0.0) + r(pulled_until);
  for (int k = 1; k < halves; ++k) sum += (k % 2 == 1 ? 4.0 : 2.0) * r(k * h);
  return speed * sum * h / 3.0;
}

void expect_relaxation(const std::string& material, const std::filesystem::path& folder = {}) {
  const Scene scene = parse_scene(scene_of(material), "material.toml", folder);
  Simulation simulation(scene);
  double largest = 0.0;
  for (const double t : {0.51, 0.6, 1.0, 3.0, 10.0, 20.0}) {
    ASSERT_FALSE(simulation.advance(t)) << material;
    const double expected = 0.5 * stress_by_relaxation(simulation.scene().material, t);
    largest = std::max(largest, std::abs(expected));
    // The run's own tolerance is 1e-10.
    EXPECT_NEAR(simulation.read(simulation.scene().probes[0]).force.x, expected, 1e-8 * largest)
        << material << " t = " << t;
  }
}

TEST(SceneMaterial, RelaxesAsItsPartsSay) {
  expect_relaxation("lambda_ela = 7\nmu_ela = 5\nlambda_vis = 4\nmu_vis = 2");
  expect_relaxation(
      "young_ela = 7\nyoung_vis = 4\npoisson = 0.3\n[material.elastic]\nyoung = 2\n"
      "[material.viscous]\nlambda = 0.5\nmu = 0.25\n"
      "[[material.maxwell]]\nlambda_ela = 1\nmu_ela = 2\ntime = 0.01\n"
      "[[material.maxwell]]\nlambda_ela = 0\nmu_ela = 2\nlambda_vis = 1\nmu_vis = 60");
}

TEST(SceneMaterial, RelaxesAsItsPresetSays) {
  expect_relaxation("preset = \"elastic\"\nlambda_elastic = 2\nmu_elastic = 3");
  expect_relaxation(
      "preset = \"kelvin_voigt\"\nlambda_elastic = 2\nmu_elastic = 3\nlambda_viscous = 1\nmu_viscous = 1");
  expect_relaxation("preset = \"maxwell\"\nlambda_ela = 2\nmu_ela = 3\nlambda_vis = 1\nmu_vis = 1");
  expect_relaxation("preset = \"zener\"\nyoung_ela = 20\nyoung_vis = 13\nyoung_elastic = 5\npoisson = 0.4");
  expect_relaxation(
      "preset = \"burgers_equivalent\"\nyoung_ela_1 = 20\nyoung_vis_1 = 130\nyoung_ela_2 = 5\n"
      "young_vis_2 = 2\npoisson = 0.4\nplane = \"stress\"");
  expect_relaxation(
      "preset = \"five_element\"\nyoung_ela_1 = 20\nyoung_vis_1 = 130\nyoung_ela_2 = 5\n"
      "young_vis_2 = 2\nyoung_viscous = 1\npoisson = 0.4");
}

// The force of the plastic body ends with the motion.
TEST(SceneMaterial, APlasticPresetIsNotTensedWhenHeld) {
  const Scene scene =
      parse_scene(scene_of("preset = \"plastic\"\nlambda_viscous = 2\nmu_viscous = 3"), "material.toml", {});
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.advance(0.4));
  EXPECT_NEAR(simulation.read(simulation.scene().probes[0]).force.x, 0.5 * speed * (2.0 + 2.0 * 3.0), 1e-10);
  ASSERT_FALSE(simulation.advance(1.0));
  EXPECT_NEAR(simulation.read(simulation.scene().probes[0]).force.x, 0.0, 1e-10);
}

TEST(SceneMaterial, RelaxesAsItsDataSay) {
  const std::filesystem::path folder = std::filesystem::path(RHEO_TEST_OUTPUT) / "scene_material";
  std::filesystem::create_directories(folder);
  std::ofstream csv(folder / "gel.csv");
  csv.precision(17);
  for (int i = 0; i < 60; ++i) {
    const double t = 0.05 * std::pow(10.0, i / 20.0);
    csv << t << ',' << 10.0 * std::exp(-t / 2.0) + 3.0 * std::exp(-t / 0.1) + 2.0 << '\n';
  }
  csv.close();
  expect_relaxation("relaxation = \"gel.csv\"\npoisson = 0.45", folder);
}

}  // namespace
}  // namespace rheo::test
