// Materials of several parts by edges and by elements: the run of the assembled form, the same bits with any
// number of threads.

#include <gtest/gtest.h>

#include <random>

#include "assembled_body.hpp"
#include "kernels/branch_rows.hpp"
#include "kernels/parallel_edge_body.hpp"
#include "kernels/parallel_element_body.hpp"
#include "rheo/error.hpp"
#include "rheo/simulation.hpp"
#include "schedule.hpp"
#include "support/kernel_cases.hpp"
#include "support/sanitized.hpp"
#include "support/whole_materials.hpp"

namespace rheo::test {
namespace {

double apart(std::span<const double> a, std::span<const double> b) {
  return difference({a.begin(), a.end()}, {b.begin(), b.end()}, 0, a.size());
}

void expect_same_run(Kernel kernel, const Scene& scene, double until, double tolerance,
                     const std::string& what) {
  Simulation csr(scene, {.kernel = Kernel::csr}), edge(scene, {.kernel = kernel});
  EXPECT_EQ(edge.kernel(), kernel == Kernel::edge ? "edge" : "element");
  ASSERT_FALSE(csr.advance(until)) << what;
  ASSERT_FALSE(edge.advance(until)) << what;
  EXPECT_LT(apart(csr.u(), edge.u()), tolerance) << what;
  EXPECT_LT(apart(csr.v(), edge.v()), tolerance) << what;
  EXPECT_LT(apart(csr.w_lambda(), edge.w_lambda()), tolerance) << what;
  EXPECT_LT(apart(csr.w_mu(), edge.w_mu()), tolerance) << what;
  EXPECT_LT(apart(csr.pull_mu(), edge.pull_mu()), tolerance) << what;
  EXPECT_LT(apart(csr.reaction(), edge.reaction()), 10 * tolerance) << what;
  const Energies a = csr.energies(), b = edge.energies();
  const bool long_steps = scene.time.integrator == IntegratorKind::exponential;  // work may be unknown
  const double energy = a.kinetic + a.stored + (long_steps ? 0.0 : std::abs(a.work));
  EXPECT_NEAR(a.kinetic, b.kinetic, 10 * tolerance * energy) << what;
  EXPECT_NEAR(a.stored, b.stored, 10 * tolerance * energy) << what;
  if (!long_steps) {
    EXPECT_NEAR(a.dissipated, b.dissipated, 10 * tolerance * energy) << what;
    EXPECT_NEAR(a.work, b.work, 10 * tolerance * energy) << what;
  }
}

// Meshes with holes, hubs and round rims; loads, moved and held nodes.
Scene parallel_scene(unsigned seed) {
  Scene scene = random_scene(seed, Shapes::all);
  std::mt19937 random(seed + 100);
  const double size = std::hypot(scene.mesh.points[1].x - scene.mesh.points[0].x,
                                 scene.mesh.points[1].y - scene.mesh.points[0].y);
  scene.material = random_material(random, 4.0 / (size * size), 4.0, 3.0);
  scene.moves[0].keys = {{0, {0, 0}, {}}, {0.8, {0.1 * size, 0}, {}}};
  scene.moves[0].window.until = 0.9;
  return scene;
}

// Sweeps, energies with their slopes and reactions of random states, whatever the instructions.
TEST(ParallelBodies, AgreeWithTheAssembledForm) {
  for (const SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!has_simd_level(level)) continue;
    for (unsigned seed = 0; seed < 12; ++seed) {
      const Scene scene = parallel_scene(seed);
      const Model model(scene.mesh, scene.material);
      Schedule schedule(scene, model);
      const Interval interval = schedule.interval(0);
      const std::vector<double> y = random_state(model, seed + 1000);
      const Vector base = Vector::Zero(static_cast<Eigen::Index>(model.layout.part));
      AssembledBody assembled(model, 0.0);
      const EdgeForce by_edges(std::make_shared<EdgeForm>(scene.mesh), level);
      const ElementForce by_elements(std::make_shared<ElementForm>(scene.mesh, Regions{{scene.material}, {}}),
                                     level);
      ParallelEdgeBody edges(model, by_edges, 1);
      ParallelElementBody elements(model, by_elements, 1);
      const Outcome a = outcome(assembled, interval, base, y, 0.7);
      const std::string which = std::string(name_of(level)) + " seed " + std::to_string(seed);
      expect_alike(a, outcome(edges, interval, base, y, 0.7), scene, model.layout.part, "edges " + which);
      expect_alike(a, outcome(elements, interval, base, y, 0.7), scene, model.layout.part,
                   "elements " + which);
    }
  }
}

class ParallelKernels : public testing::TestWithParam<Kernel> {};

TEST_P(ParallelKernels, GiveTheRunOfTheAssembledForm) {
  for (unsigned seed = 0; seed < 9; ++seed) {
    Scene scene = parallel_scene(seed);
    expect_same_run(GetParam(), scene, 1.0, 1e-11, "rk4 " + std::to_string(seed));
    scene.time.integrator = IntegratorKind::exponential;
    expect_same_run(GetParam(), scene, 1.0, 1e-9, "exponential " + std::to_string(seed));
  }
}

TEST_P(ParallelKernels, TakeManyBranches) {
  Scene scene = parallel_scene(3);
  for (int k = 1; k <= 14; ++k) scene.material.more_branches.push_back({0.3, 0.2, 0.3 / k, 0.2 / k});
  expect_same_run(GetParam(), scene, 0.3, 1e-11, "rk4");
  scene.time.integrator = IntegratorKind::exponential;
  expect_same_run(GetParam(), scene, 0.3, 1e-9, "exponential");
}

TEST_P(ParallelKernels, ThreadsDoNotChangeTheResult) {
  Scene scene;
  scene.mesh = rectangle({3.0, 1.0}, 121, 41, Diagonal::alternating);
  scene.material = material_of({{{7.0, 2.0}, {3.0, 9.0}}, 1.0, 0.01}, {{{5.0, 3.0}}, 2.0, 0.02}, 0.2);
  const auto& groups = scene.mesh.edge_groups;
  scene.fixes.push_back({nodes_of(groups.at("left")), Axis::both, {}, ""});
  scene.moves.push_back({nodes_of(groups.at("right")),
                         Axis::both,
                         {},
                         {{0, {0, 0}, {}}, {1, {0.1, 0.05}, {}}},
                         Profile::smooth,
                         ""});
  scene.tractions.push_back({groups.at("top"), {{0, {0, -1}}, {1, {2, 0}}}, {}, ""});
  scene.time.duration = 1.0;
  const double duration = is_sanitized ? 0.002 : 0.01;
  Simulation one(scene, {.kernel = GetParam(), .threads = 1}), csr(scene, {.kernel = Kernel::csr});
  EXPECT_EQ(one.threads(), 1);
  ASSERT_FALSE(one.advance(duration));
  ASSERT_FALSE(csr.advance(duration));
  EXPECT_LT(apart(csr.u(), one.u()), 1e-11) << "sweeps follow each other through several blocks";
  for (int threads : {2, 3}) {
    Simulation several(scene, {.kernel = GetParam(), .threads = threads});
    EXPECT_GT(several.threads(), 1);
    ASSERT_FALSE(several.advance(duration));
    for (std::size_t i = 0; i < one.u().size(); ++i) {
      ASSERT_EQ(one.u()[i], several.u()[i]) << threads;
      ASSERT_EQ(one.v()[i], several.v()[i]) << threads;
      ASSERT_EQ(one.w_lambda()[i], several.w_lambda()[i]) << threads;
      ASSERT_EQ(one.w_mu()[i], several.w_mu()[i]) << threads;
    }
    EXPECT_EQ(one.energies().stored, several.energies().stored);
    EXPECT_EQ(one.energies().dissipated, several.energies().dissipated);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ParallelKernels, testing::Values(Kernel::edge, Kernel::element),
                         [](const auto& c) { return c.param == Kernel::edge ? "edge" : "element"; });

TEST(BranchRows, EveryInstructionSetComputesTheSame) {
  constexpr std::int64_t n = 37;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<double> u(2 * n), v(2 * n), x(4 * n), base(4 * n);
  for (auto* field : {&u, &v, &x, &base}) {
    for (double& number : *field) number = unit(random);
  }
  const ParallelPart part{{0.3, 0.3, 0.7, 0.7}, {0.1, 0.1, 0.2, 0.2}};
  const SweepMaterial material{{3, 3, 2, 2}, {0.5, 0.5, 0.9, 0.9}};
  for (const SimdLevel level : {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!has_simd_level(level)) continue;
    std::vector<double> p(4 * n), out(4 * n);
    const BranchRows rows = branch_rows(level);
    rows.begin(part, u.data(), v.data(), p.data(), n);
    rows.advance(material, 0.1, v.data(), x.data(), base.data(), out.data(), p.data(), n);
    for (std::size_t i = 0; i < 4 * n; ++i) {
      const std::size_t c = i % 4, k = 2 * (i / 4) + i % 2;
      const double w = base[i] + 0.1 * (material.growth[c] * v[k] - material.decay[c] * x[i]);
      EXPECT_NEAR(out[i], w, 1e-15);
      EXPECT_NEAR(p[i], part.elastic[c] * u[k] + part.viscous[c] * v[k] + w, 1e-15);
    }
  }
}

TEST(ParallelMaterial, TakesTheKernelThatItsMassAllows) {
  Scene scene = parallel_scene(1);
  EXPECT_NE(Simulation(scene).kernel(), "csr");
  scene.material.mass = Mass::consistent;
  EXPECT_THROW(Simulation(scene, {.kernel = Kernel::edge}), Error);
  EXPECT_EQ(Simulation(scene).kernel(), "csr");
}

}  // namespace
}  // namespace rheo::test
