// The kernels against the assembled reference: one operator, whatever the way to the force.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "assembled_body.hpp"
#include "body_choice.hpp"
#include "kernels/edge_body.hpp"
#include "schedule.hpp"
#include "support/exact.hpp"
#include "support/kernel_cases.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

class Kernels : public testing::TestWithParam<SimdLevel> {};

TEST_P(Kernels, AgreeWithTheAssembledForm) {
  if (!has_simd_level(GetParam())) GTEST_SKIP() << "this processor has no " << name_of(GetParam());
  // Rectangles with holes, wheels with hubs of up to 29 spokes, disks: boundaries of all kinds.
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Scene scene = random_scene(seed, Shapes::all);
    const Model model(scene.mesh, scene.material);
    Schedule schedule(scene, model);
    const Interval interval = schedule.interval(0);
    const std::vector<double> y = random_state(model, seed + 1000);
    Vector base = Vector::Zero(static_cast<Eigen::Index>(model.layout.part));

    AssembledBody assembled(model, 0.0);
    const EdgeForce force(std::make_shared<EdgeForm>(scene.mesh, combined(scene.material)), GetParam());
    EdgeBody edges(model, force, 1);
    const Outcome a = outcome(assembled, interval, base, y, 0.7);
    const Outcome b = outcome(edges, interval, base, y, 0.7);
    expect_alike(a, b, scene, model.layout.part, "seed " + std::to_string(seed));
  }
}

TEST_P(Kernels, GiveOneRunOverWholeScenes) {
  if (!has_simd_level(GetParam())) GTEST_SKIP() << "this processor has no " << name_of(GetParam());
  Scene scene = paper_beam(Mass::lumped);
  Simulation csr(scene, {.kernel = Kernel::csr}), edge(scene, {.kernel = Kernel::edge});
  EXPECT_EQ(csr.kernel(), "csr");
  EXPECT_EQ(edge.kernel(), "edge");
  ASSERT_FALSE(csr.advance(2.0));
  ASSERT_FALSE(edge.advance(2.0));
  for (std::size_t i = 0; i < csr.u().size(); ++i) EXPECT_NEAR(csr.u()[i], edge.u()[i], 1e-12);
  EXPECT_EQ(csr.counters().steps, edge.counters().steps);
}

// What an edge keeps of its level is a matter of speed alone: the same bits.
TEST_P(Kernels, GiveTheSameBitsWhetherLevelsAreKeptOrSummed) {
  if (!has_simd_level(GetParam())) GTEST_SKIP() << "this processor has no " << name_of(GetParam());
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Scene scene = random_scene(seed);
    const Model model(scene.mesh, scene.material);
    Schedule schedule(scene, model);
    const Interval interval = schedule.interval(0);
    std::mt19937 random(seed + 3000);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::vector<double> y(model.layout.size());
    for (double& x : y) x = unit(random);
    Vector base = Vector::Zero(static_cast<Eigen::Index>(model.layout.part));
    const auto of = [&](Level level) {
      const auto form = std::make_shared<EdgeForm>(scene.mesh, std::nullopt, level);
      EXPECT_EQ(form->level_row, level == Level::ready ? 4 : 2);
      const EdgeForce force(form, GetParam());
      EdgeBody body(model, force, 1);
      return outcome(body, interval, base, y, 0.7);
    };
    if (!model.layout.lambda || !model.layout.mu) continue;  // combined
    const Outcome ready = of(Level::ready), summed = of(Level::summed);
    EXPECT_EQ(ready.swept, summed.swept) << "seed " << seed;
    EXPECT_EQ(ready.sample.stored, summed.sample.stored) << "seed " << seed;
    EXPECT_EQ(ready.sample.dissipated_rate, summed.sample.dissipated_rate) << "seed " << seed;
    EXPECT_EQ((ready.reaction - summed.reaction).norm(), 0.0) << "seed " << seed;
  }
}

// Branches of one rate, one branch alone and branches that never relax take fewer numbers and the same
// course.
struct CombinedCase {
  const char* name;
  Material material;
  std::int64_t branches;  // advanced an evaluation
};

class CombinedBranches : public testing::TestWithParam<CombinedCase> {};

TEST_P(CombinedBranches, GiveTheRunOfTheAssembledForm) {
  std::mt19937 random(11);
  Scene scene = random_scene(4);
  scene.material = GetParam().material;
  scene.moves[0].keys = {{0, {0, 0}, {}}, {0.02, {0.01, 0}, {}}};
  scene.moves[0].window.until = 0.03;
  scene.time.duration = 0.05;
  const double size = scene.mesh.points[1].x - scene.mesh.points[0].x;
  const double density = 2e-7 * (scene.material.lambda_ela + scene.material.mu_ela) / (size * size);
  scene.material.density = density;  // some hundred steps, whatever the mesh's size
  Simulation csr(scene, {.kernel = Kernel::csr}), edge(scene, {.kernel = Kernel::edge});
  ASSERT_FALSE(csr.advance(0.05));
  ASSERT_FALSE(edge.advance(0.05));
  ASSERT_GT(csr.counters().steps, 20);
  const auto near = [](std::span<const double> a, std::span<const double> b) {
    return difference({a.begin(), a.end()}, {b.begin(), b.end()}, 0, a.size());
  };
  // Where nothing relaxes the edge kernel has w = ela u, imposed u included; the reference integrates both,
  // and differs by RK4's error over these steps.
  const double apart = GetParam().branches == 0 ? 1e-9 : 1e-11;
  EXPECT_LT(near(csr.u(), edge.u()), apart);
  EXPECT_LT(near(csr.v(), edge.v()), apart);
  EXPECT_LT(near(csr.w_lambda(), edge.w_lambda()), apart);
  EXPECT_LT(near(csr.w_mu(), edge.w_mu()), apart);
  const Energies a = csr.energies(), b = edge.energies();
  const double energy = a.kinetic + a.stored + std::abs(a.work);
  EXPECT_NEAR(a.kinetic, b.kinetic, 10 * apart * energy);
  EXPECT_NEAR(a.stored, b.stored, 10 * apart * energy);
  EXPECT_NEAR(a.dissipated, b.dissipated, 10 * apart * energy);
  EXPECT_NEAR(a.work, b.work, 10 * apart * energy);
  EXPECT_EQ(edge.counters().branch_updates, GetParam().branches * edge.counters().force_evaluations);
  EXPECT_NEAR(edge.spectrum().omega_max, csr.spectrum().omega_max, 1e-9 * csr.spectrum().omega_max);
}

INSTANTIATE_TEST_SUITE_P(
    Materials, CombinedBranches,
    testing::Values(CombinedCase{"TwoRates", {7, 5, 4, 2, 1, Mass::lumped}, 2},
                    CombinedCase{"OneRate", {7, 5, 14, 10, 1, Mass::lumped}, 1},
                    CombinedCase{"OnlyLambda", {7, 0, 4, 2, 1, Mass::lumped}, 1},
                    CombinedCase{"OnlyMu", {0, 5, 4, 2, 1, Mass::lumped}, 1},
                    CombinedCase{"HalfElastic", {7, 5, forever, 2, 1, Mass::lumped}, 2},
                    CombinedCase{"Elastic", {7, 5, forever, forever, 1, Mass::lumped}, 0},
                    CombinedCase{"OnlyMuElastic", {0, 5, 4, forever, 1, Mass::lumped}, 0}),
    [](const auto& c) { return std::string(c.param.name); });

TEST(Displacement, IsAdvancedOnceAStepWhereNothingFeedsOnIt) {
  const Scene lumped = paper_beam(Mass::lumped), consistent = paper_beam(Mass::consistent);
  Scene baumgarte = lumped;
  baumgarte.time.constraints = ConstraintMethod::baumgarte;
  for (const auto& [scene, often] : {std::pair{lumped, 1}, {consistent, 1}, {baumgarte, 4}}) {
    Simulation simulation(scene);
    ASSERT_FALSE(simulation.advance(0.5));
    const Counters& c = simulation.counters();
    // RK4's first evaluation of a step may be known from the energies' sample.
    EXPECT_GE(c.displacement_updates, often == 1 ? c.steps : 3 * c.steps);
    EXPECT_LE(c.displacement_updates, often * c.steps);
  }
}

// Large enough for several blocks, so that the sweeps of a step follow each other through the mesh.
TEST(EdgeBody, SweepsThatFollowEachOtherGiveTheSameStep) {
  Scene scene;
  scene.mesh = rectangle({2.0, 1.0}, 61, 41, Diagonal::alternating);
  scene.material = {7, 5, 4, 2, 0.2, Mass::lumped};
  scene.body_acceleration = {0.1, -0.2};
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
  ASSERT_GE(EdgeForm(scene.mesh).blocks.size(), 6u);
  Simulation csr(scene, {.kernel = Kernel::csr}), edge(scene, {.kernel = Kernel::edge});
  ASSERT_FALSE(csr.advance(0.2));
  ASSERT_FALSE(edge.advance(0.2));
  const auto near = [](std::span<const double> a, std::span<const double> b) {
    return difference({a.begin(), a.end()}, {b.begin(), b.end()}, 0, a.size());
  };
  EXPECT_LT(near(csr.u(), edge.u()), 1e-12);
  EXPECT_LT(near(csr.v(), edge.v()), 1e-12);
  EXPECT_LT(near(csr.w_lambda(), edge.w_lambda()), 1e-12);
  EXPECT_LT(near(csr.w_mu(), edge.w_mu()), 1e-12);
  const Energies a = csr.energies(), b = edge.energies();
  EXPECT_NEAR(a.kinetic, b.kinetic, 1e-11 * a.kinetic);
  EXPECT_NEAR(a.stored, b.stored, 1e-11 * a.stored);
  EXPECT_NEAR(a.dissipated, b.dissipated, 1e-11 * a.dissipated);
  EXPECT_NEAR(a.work, b.work, 1e-11 * a.work);
}

// Bit for bit, with any number of threads, also more than this machine has processors.
TEST(EdgeBody, ThreadsDoNotChangeTheResult) {
  Scene scene;
  scene.mesh = rectangle({3.0, 1.0}, 181, 41, Diagonal::alternating);
  scene.material = {7, 5, 4, 2, 0.2, Mass::lumped};
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
  ASSERT_GE(EdgeForm(scene.mesh).blocks.size(), 24u);
  Simulation one(scene, {.threads = 1});
  EXPECT_EQ(one.threads(), 1);
  ASSERT_FALSE(one.advance(0.05));
  for (int threads : {2, 3, 4, 5}) {
    Simulation several(scene, {.threads = threads});
    EXPECT_EQ(several.threads(), threads);
    ASSERT_FALSE(several.advance(0.05));
    for (std::size_t i = 0; i < one.u().size(); ++i) {
      ASSERT_EQ(one.u()[i], several.u()[i]) << threads;
      ASSERT_EQ(one.v()[i], several.v()[i]) << threads;
      ASSERT_EQ(one.w_lambda()[i], several.w_lambda()[i]) << threads;
      ASSERT_EQ(one.w_mu()[i], several.w_mu()[i]) << threads;
    }
    EXPECT_EQ(one.energies().stored, several.energies().stored);
    EXPECT_EQ(one.energies().dissipated, several.energies().dissipated);
    EXPECT_EQ(one.energies().work, several.energies().work);
  }
}

TEST(BodyChoice, TakesTheFasterKernelForTheProcessor) {
  Scene scene = paper_beam(Mass::lumped);
  const auto chosen = [&](Kernel kernel, SimdLevel level) { return assembly_for(scene, kernel, level); };
  EXPECT_EQ(chosen(Kernel::automatic, SimdLevel::avx2), Assembly::edges);
  EXPECT_EQ(chosen(Kernel::automatic, SimdLevel::avx512), Assembly::edges);
  EXPECT_EQ(chosen(Kernel::automatic, SimdLevel::baseline), Assembly::elements);
  EXPECT_EQ(chosen(Kernel::edge, SimdLevel::baseline), Assembly::edges);
  EXPECT_EQ(chosen(Kernel::csr, SimdLevel::baseline), Assembly::matrices);
  scene.material.mu_ela = 0.0;  // one branch: two numbers a node
  EXPECT_EQ(chosen(Kernel::automatic, SimdLevel::baseline), Assembly::edges);
  scene.material.mass = Mass::consistent;
  EXPECT_EQ(chosen(Kernel::automatic, SimdLevel::baseline), Assembly::matrices);
}

TEST(EdgeBody, SmallMeshesHaveOneThread) {
  EXPECT_EQ(Simulation(paper_beam(Mass::lumped)).threads(), 1);
  EXPECT_EQ(Simulation(paper_beam(Mass::lumped), {.threads = 4}).threads(), 1)
      << "one block cannot be shared";
}

TEST(Energies, WhereNotAskedForAreNotANumberAndChangeNothing) {
  const Scene scene = paper_beam(Mass::lumped);
  Simulation with(scene), without(scene, {.energies = false});
  ASSERT_FALSE(with.advance(1.5));
  ASSERT_FALSE(without.advance(1.5));
  EXPECT_TRUE(std::isnan(without.energies().dissipated));
  EXPECT_TRUE(std::isnan(without.energies().work));
  EXPECT_EQ(with.energies().kinetic, without.energies().kinetic);
  EXPECT_EQ(with.energies().stored, without.energies().stored);
  for (std::size_t i = 0; i < with.u().size(); ++i) EXPECT_EQ(with.u()[i], without.u()[i]);
}

INSTANTIATE_TEST_SUITE_P(Levels, Kernels,
                         testing::Values(SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512),
                         [](const auto& c) { return std::string(name_of(c.param)); });

TEST(EdgeForm, RenumbersEveryNodeOnceAndKeepsNeighboursNear) {
  const Mesh mesh = rectangle({1, 1}, 60, 60, Diagonal::alternating);
  const EdgeForm form(mesh);
  std::vector<int> seen(form.nodes, 0);
  for (std::int32_t node : form.mesh_node) ++seen[node];
  for (int count : seen) EXPECT_EQ(count, 1);
  std::int64_t edges = 0;
  for (const EdgeForm::Run& run : form.runs)
    edges += static_cast<std::int64_t>(run.last - run.first) * run.valence;
  // A run begins at an even edge.
  EXPECT_GE(static_cast<std::int64_t>(form.offset.size()), edges);
  EXPECT_LE(form.offset.size(), static_cast<std::size_t>(edges) + form.runs.size());
  // Euler's formula: edges = nodes + triangles - 1 on a disk, each twice here.
  EXPECT_EQ(edges, 2 * (mesh.node_count() + mesh.triangle_count() - 1));
  EXPECT_EQ(form.level_row, 4) << "in a core's cache";
  EXPECT_EQ(EdgeForm(rectangle({1, 1}, 160, 160, Diagonal::alternating)).level_row, 2) << "beyond it";
  // A level of the breadth-first order is about a row; swaps inside windows add to it.
  EXPECT_LT(form.bandwidth, 3 * 60 + 2 * 128);
}

TEST(EdgeForce, IsTheStiffnessOfTheAssembledForm) {
  std::mt19937 random(3);
  const Mesh mesh = random_mesh(random);
  const Material material{7, 5, 4, 2, 0.2, Mass::lumped};
  const Model matrices(mesh, material), edges(mesh, material, Assembly::edges);
  const Vector x = Vector::Random(2 * mesh.node_count());
  const Vector expected = matrices.stiffness({Moduli{7.0, 5.0}}, x);
  EXPECT_LT((edges.stiffness({Moduli{7.0, 5.0}}, x) - expected).norm(), 1e-13 * expected.norm());
}

TEST(Model, ElementBoundIsTheLargestEigenvalueOfAnElement) {
  std::mt19937 random(4);
  for (int k = 0; k < 20; ++k) {
    Mesh mesh = random_mesh(random);
    const Material material{k % 3 == 0 ? 0.0 : 7.0 * k,
                            k % 3 == 1 ? 0.0 : 5.0,
                            4,
                            2,
                            0.2,
                            k % 2 == 0 ? Mass::lumped : Mass::consistent};
    double largest = 0.0;
    for (const Triangle& t : mesh.triangles) {
      Mesh one;
      one.points = {mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
      one.triangles = {{0, 1, 2}};
      one.thickness = mesh.thickness;
      prepare(one);
      const DenseMatrices m = dense_matrices(one, material);
      const Eigen::MatrixXd k_e = material.lambda_ela * m.j_lambda + material.mu_ela * m.j_mu;
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(k_e, m.mass,
                                                                             Eigen::EigenvaluesOnly);
      largest = std::max(largest, solver.eigenvalues().maxCoeff());
    }
    EXPECT_NEAR(Model(mesh, material).element_omega, std::sqrt(largest), 1e-9 * std::sqrt(largest));
  }
}

TEST(Kernel, ThatTheSceneDoesNotAllowIsRefused) {
  const Scene scene = paper_beam(Mass::consistent);
  EXPECT_THROW(Simulation(scene, {.kernel = Kernel::edge}), std::runtime_error);
  EXPECT_EQ(Simulation(scene).kernel(), "csr");
}

}  // namespace
}  // namespace rheo::test
