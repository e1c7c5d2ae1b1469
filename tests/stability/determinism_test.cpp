// What is promised of bits, and what is not.
//
// Promised: the same scene with the same options on the same machine gives the same bits, in every block, at
// every output: again and again, on any number of threads, beside other simulations, through a hand's session
// written as a scene, and going on twice from one saved state. Assembled matrices with rk4 or euler give them
// in every build (Release, Debug, sanitized) and on every processor of one kind: sums are added in one order,
// written down.
//
// Not promised, but rounding: other kernels and other instruction sets (their sums have other orders and
// fused multiply-adds), other compilers' and libraries' exp and cos in `exponential`, steps that end
// elsewhere because outputs or events do; -march=native or -ffast-math builds.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>
#include <thread>

#include "rheo/live.hpp"
#include "support/event_scenes.hpp"
#include "support/live_scenes.hpp"
#include "support/state_hash.hpp"
#include "support/whole_materials.hpp"

namespace rheo::test {
namespace {

using Hashes = std::vector<std::uint64_t>;

#if defined(RHEO_SANITIZE_ADDRESS) || defined(RHEO_SANITIZE_THREAD)
constexpr int across = 6, up = 4;
#else
constexpr int across = 11, up = 7;
#endif

Hashes hashes_of(const Scene& scene, const SimulationOptions& options) {
  Simulation simulation(scene, options);
  Hashes all;
  for (std::int64_t k = 0; k < output_count(scene.time); ++k) {
    EXPECT_FALSE(simulation.advance(output_time(scene.time, k)));
    all.push_back(state_hash(simulation));
    StateHash energies;
    const Energies e = simulation.energies();
    const double values[] = {e.kinetic, e.stored, e.dissipated, e.work};
    energies.add(values);
    all.push_back(energies.value());
  }
  return all;
}

struct Setting {
  std::string name;
  Scene scene;
  SimulationOptions options;
};

Scene with_mesh(Scene scene, int nx, int ny) {
  scene.mesh = rectangle({2.0, 1.0}, nx, ny, Diagonal::alternating);
  scene.fixes[0].nodes = nodes_of(scene.mesh.edge_groups.at("left"));
  for (Traction& traction : scene.tractions) traction.edges = scene.mesh.edge_groups.at("right");
  for (Move& move : scene.moves) move.nodes = right_nodes(scene);
  return scene;
}

// Of one branch, of many parts, of several regions.
Scene of_many_parts(Scene scene) {
  std::mt19937 random(5);
  const Mass mass = scene.material.mass;
  scene.material = random_material(random, 0.2, 5.0, 30.0);
  scene.material.mass = mass;
  return scene;
}
Scene of_regions(Scene scene) {
  Material other = scene.material;
  other.mu_ela *= 3.0, other.density *= 2.0;
  scene.regions = {{"other", other, {}, "other"}};
  for (int t = 0; t < scene.mesh.triangle_count(); ++t) scene.region_of_triangle.push_back(t % 3 == 0);
  return scene;
}

// Every integrator with every kernel and kind of material that goes with it.
std::vector<Setting> settings(int nx, int ny) {
  std::vector<Setting> all;
  const auto add = [&](const std::string& name, Scene scene, Kernel kernel) {
    for (const auto& [integrator, its_name] : {std::pair{IntegratorKind::rk4, "rk4"},
                                               {IntegratorKind::euler, "euler"},
                                               {IntegratorKind::exponential, "exponential"},
                                               {IntegratorKind::implicit, "implicit"}}) {
      if (integrator == IntegratorKind::implicit && kernel != Kernel::csr) continue;
      if (integrator == IntegratorKind::exponential && !scene.constraints.empty()) continue;
      scene.time.integrator = integrator;
      scene.body_acceleration = {0.3, -1.0};
      scene.time.duration = 0.2;
      scene.time.frame_rate = 20.0;
      if (integrator == IntegratorKind::rk4) scene.time.step = 1e-3;
      if (integrator == IntegratorKind::euler) scene.time.step = 2e-4;
      SimulationOptions options;
      options.kernel = kernel;
      options.allow_unstable = true;  // Euler's limit is only a bound here
      all.push_back({name + ", " + its_name, scene, options});
    }
  };
  const Scene pulled = with_mesh(ramped(Mass::lumped), nx, ny);
  for (const auto& [kernel, name] :
       {std::pair{Kernel::edge, "edge"}, {Kernel::element, "element"}, {Kernel::csr, "csr"}})
    add(name, pulled, kernel);
  add("edge, many parts", of_many_parts(pulled), Kernel::edge);
  add("element, regions", of_regions(pulled), Kernel::element);
  add("csr, moved", with_mesh(moved(Mass::lumped, Profile::smooth), nx, ny), Kernel::csr);
  add("csr, consistent", with_mesh(ramped(Mass::consistent), nx, ny), Kernel::csr);
  add("csr, tied", with_mesh(tied(Mass::lumped), nx, ny), Kernel::csr);
  return all;
}

TEST(Determinism, TheSameSceneGivesTheSameBitsAgain) {
  for (const Setting& each : settings(across, up)) {
    const Hashes first = hashes_of(each.scene, each.options);
    EXPECT_EQ(hashes_of(each.scene, each.options), first) << each.name;
    EXPECT_NE(first.front(), first.back()) << each.name << ": nothing moved";
  }
}

// More threads than processors too.
TEST(Determinism, ThreadsDoNotChangeABit) {
  const int nx = 61, ny = 41;  // a smaller body is not given a second thread
  int with_threads = 0;
  for (Setting& each : settings(nx, ny)) {
    if (each.options.kernel == Kernel::csr) continue;
    each.scene.time.duration = 1e-3;
    each.scene.time.frame_rate = 2000.0;
    if (each.scene.time.step > 0.0) each.scene.time.step = 1e-5;
    each.options.threads = 1;
    const Hashes one = hashes_of(each.scene, each.options);
    for (const int threads : {2, 3}) {
      each.options.threads = threads;
      with_threads += Simulation(each.scene, each.options).threads() > 1;
      EXPECT_EQ(hashes_of(each.scene, each.options), one) << each.name << " on " << threads << " threads";
    }
  }
  EXPECT_GT(with_threads, 0) << "the body is too small for a second thread";
}

// No simulation sees another one.
TEST(Determinism, SimulationsBesideEachOtherDoNotChangeABit) {
  std::vector<Setting> all = settings(across + 2, up);
  std::vector<Hashes> alone(all.size()), together(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) alone[i] = hashes_of(all[i].scene, all[i].options);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 3; ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t i = t; i < all.size(); i += 3) together[i] = hashes_of(all[i].scene, all[i].options);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(together[i], alone[i]) << all[i].name;
}

// Two that go on from one saved state are alike to the bit.
TEST(Determinism, GoingOnTwiceFromOneStateGivesTheSameBits) {
  for (const Setting& each : settings(across, up)) {
    Simulation first(each.scene, each.options);
    ASSERT_FALSE(first.advance(0.12)) << each.name;
    const SavedState saved = first.save();
    Hashes ends;
    for (int k = 0; k < 2; ++k) {
      Simulation next(each.scene, each.options);
      next.resume(saved);
      ASSERT_FALSE(next.advance(0.2)) << each.name;
      ends.push_back(state_hash(next));
    }
    EXPECT_EQ(ends[0], ends[1]) << each.name;
  }
}

// One number for every build: Release, Debug and sanitized builds all run this test.
TEST(Determinism, AssembledMatricesGiveTheSameBitsInEveryBuild) {
#if !defined(__x86_64__) || !defined(__GNUC__) || defined(__FMA__) || defined(__FAST_MATH__)
  GTEST_SKIP() << "promised for x86-64 without -march and -ffast-math";
#endif
  static_assert(EIGEN_WORLD_VERSION == 3);
  const std::pair<const char*, std::uint64_t> known[] = {{"csr, rk4", 10418508106802265969u},
                                                         {"csr, euler", 9056021273807711730u}};
  for (const Setting& each : settings(11, 7)) {
    for (const auto& [name, hash] : known) {
      if (each.name != name) continue;
      EXPECT_EQ(hashes_of(each.scene, each.options).end()[-2], hash) << each.name;
    }
  }
}

// Not promised to the bit, but to rounding.
TEST(Determinism, KernelsDifferByRoundingOnly) {
  std::vector<Setting> all = settings(11, 7);
  const auto end_of = [](const Setting& each) {
    Simulation simulation(each.scene, each.options);
    EXPECT_FALSE(simulation.advance(0.2));
    return std::vector<double>(simulation.u().begin(), simulation.u().end());
  };
  for (const std::string integrator : {"rk4", "euler"}) {
    std::vector<double> reference;
    for (const std::string kernel : {"csr", "edge", "element"}) {
      const auto found = std::find_if(all.begin(), all.end(), [&](const Setting& each) {
        return each.name == kernel + ", " + integrator;
      });
      ASSERT_NE(found, all.end());
      const std::vector<double> u = end_of(*found);
      if (reference.empty()) reference = u;
      double largest = 0.0, difference = 0.0;
      for (std::size_t i = 0; i < u.size(); ++i) {
        largest = std::max(largest, std::abs(reference[i]));
        difference = std::max(difference, std::abs(u[i] - reference[i]));
      }
      // Of 200 steps, and of 1000.
      EXPECT_LE(difference, 1e-12 * largest) << kernel << ", " << integrator;
    }
  }
}

}  // namespace
}  // namespace rheo::test
