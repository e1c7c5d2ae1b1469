// Euler's largest step on bodies too large for all eigenvalues: of how many it is known, and how long that
// takes.
//
//   rheo_euler_limits [--triangles N] [--count K]
//   rheo_euler_limits --stress N
//
// K random bodies, half of them of any material (rates over four decades, one material or two, some that do
// not relax), half with rates of lambda and mu up to 10, 100 and 1000 apart; free or held, both masses.
// Without N: 250, 1,000, 4,000 and 10,000 triangles.
//
// --stress: the first N scenes of the stress matrix, as if they were too large, against all eigenvalues.
//
//   near   known within 5 %; else the limit stays a safe bound
//   range  what the numerical range alone says, of the known limit

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "rheo/simulation.hpp"
#include "stability/random_bodies.hpp"
#include "stability/runs/by_discs.hpp"
#include "stability/runs/stress_scene.hpp"

namespace {

using namespace rheo;
using namespace rheo::test;

Scene body(std::mt19937& random, int k, int nodes_a_side) {
  Scene scene = random_body(random, k, nodes_a_side, nodes_a_side);
  if (k % 4 >= 2) set_rates_apart(scene, random, k, std::pow(10.0, 1 + k % 3), 1 + k / 4 % 2);
  set_mass(scene, k % 2 == 0 ? Mass::lumped : Mass::consistent);
  scene.time.integrator = IntegratorKind::euler;
  scene.time.step = scene.time.duration = 1.0;  // beyond any limit here
  return scene;
}

void row(int triangles, int count) {
  using Clock = std::chrono::steady_clock;
  std::mt19937 random(5);
  const int side = static_cast<int>(std::lround(std::sqrt(triangles / 2.0))) + 1;
  std::vector<double> seconds, shares;
  int tried = 0;
  for (int k = 0; k < count; ++k) {
    const Scene scene = body(random, k, side);
    const auto spectrum = [&](Nearness nearness) {
      return Simulation(scene, {.allow_unstable = true, .nearness = nearness}).spectrum();
    };
    const Spectrum safe = spectrum(Nearness::safe);
    if (!stable_step_is_bound(safe, IntegratorKind::euler)) continue;  // all relax alike, or few enough
    ++tried;
    const Clock::time_point start = Clock::now();
    const Spectrum found = spectrum(Nearness::near);
    seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    if (found.near_euler_step == 0.0) continue;
    const double by_range = std::max(found.euler_step, stable_step(safe, IntegratorKind::euler));
    shares.push_back(by_range / found.near_euler_step);
  }
  if (tried == 0) throw std::invalid_argument("--triangles: as few have all eigenvalues");
  std::ranges::sort(seconds);
  double sum = 0.0, lowest = 1.0;
  for (const double share : shares) sum += share, lowest = std::min(lowest, share);
  fmt::print("{:>9} {:>6} {:>6} {:>10.2f} {:>8.2f} {:>11.2f} {:>8.3f}\n", 2 * (side - 1) * (side - 1), tried,
             shares.size(), seconds[seconds.size() / 2], seconds.back(),
             sum / static_cast<double>(std::max<std::size_t>(shares.size(), 1)), lowest);
  std::fflush(stdout);
}

// Exit code 1 where a step is beyond the truth, or called near and is not.
int stress(int count) {
  int tried = 0, near = 0, wrong = 0;
  double lowest = 1.0;
  for (int k = 0; k < count; ++k) {
    const ByDiscs found = euler_by_discs(stress_scene(1, k).scene);
    if (!found.counts) continue;
    ++tried;
    if (found.is_near) {
      ++near;
      lowest = std::min(lowest, found.predicted / found.truth.high);
    }
    if (!found.is_beyond() && !(found.is_near && found.is_far())) continue;
    ++wrong;
    fmt::print("WRONG: scene {}: {:g} s, true {:g} s\n", k, found.predicted, found.truth.high);
  }
  fmt::print("{} of {} scenes count; near {}, the lowest {:.4f} of the truth; beyond it or not near: {}\n",
             tried, count, near, lowest, wrong);
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  int triangles = 0, count = 40, stress_scenes = 0;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view key = argv[i];
    if (i + 1 == argc || (key != "--triangles" && key != "--count" && key != "--stress"))
      throw std::invalid_argument(fmt::format("{}: --triangles N, --count K or --stress N", key));
    (key == "--count" ? count : key == "--stress" ? stress_scenes : triangles) = std::stoi(argv[i + 1]);
  }
  if (stress_scenes > 0) return stress(stress_scenes);
  fmt::print("{:>9} {:>6} {:>6} {:>10} {:>8} {:>11} {:>8}\n", "triangles", "bodies", "near", "median [s]",
             "most [s]", "range: mean", "lowest");
  if (triangles > 0) {
    row(triangles, count);
  } else {
    for (const auto& [size, bodies] : {std::pair(250, 40), {1000, 40}, {4000, 20}, {10000, 12}})
      row(size, bodies);
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "rheo_euler_limits: %s\n", e.what());
  return 2;
}
