// The element kernel against the assembled form and the edge kernel, on one material.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "assembled_body.hpp"
#include "kernels/edge_body.hpp"
#include "kernels/element_body.hpp"
#include "kernels/node_order.hpp"
#include "schedule.hpp"
#include "support/event_scenes.hpp"
#include "support/kernel_cases.hpp"

namespace rheo::test {
namespace {

ElementForce element_force(const Scene& scene, SimdLevel level) {
  return {std::make_shared<ElementForm>(scene.mesh, Regions{{scene.material}, {}}), level};
}

class Element : public testing::TestWithParam<SimdLevel> {
 protected:
  void SetUp() override {
    if (!has_simd_level(GetParam())) GTEST_SKIP() << "this processor has no " << name_of(GetParam());
  }
};

TEST_P(Element, AgreesWithTheAssembledFormAndTheEdgeKernel) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Scene scene = random_scene(seed, Shapes::all);
    const Model model(scene.mesh, scene.material);
    Schedule schedule(scene, model);
    const Interval interval = schedule.interval(0);
    const std::vector<double> y = random_state(model, seed + 1000);
    const Vector base = Vector::Zero(static_cast<Eigen::Index>(model.layout.part));

    AssembledBody assembled(model, 0.0);
    const EdgeForce by_edges(std::make_shared<EdgeForm>(scene.mesh, combined(scene.material)), GetParam());
    EdgeBody edge(model, by_edges, 1);
    const ElementForce by_triangles = element_force(scene, GetParam());
    ElementBody element(model, by_triangles, 1);
    const Outcome a = outcome(assembled, interval, base, y, 0.7);
    const Outcome b = outcome(edge, interval, base, y, 0.7);
    const Outcome c = outcome(element, interval, base, y, 0.7);
    const std::string name = "seed " + std::to_string(seed);
    expect_alike(a, c, scene, model.layout.part, name + ", element to csr");
    expect_alike(b, c, scene, model.layout.part, name + ", element to edge");
  }
}

// The vectors' order of sums is another one: some roundings, no more.
TEST_P(Element, AgreesWithBaselineToTheRounding) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const Scene scene = random_scene(seed, Shapes::all);
    const ElementForce plain = element_force(scene, SimdLevel::baseline);
    const ElementForce vectors = element_force(scene, GetParam());
    std::vector<double> p(4 * static_cast<std::size_t>(plain.form().slots)), a(p.size() / 2), b(p.size() / 2);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (double& x : p) x = unit(random);
    plain.apply(p.data(), a.data());
    vectors.apply(p.data(), b.data());
    EXPECT_LT(difference(a, b, 0, a.size()), 2e-15) << seed;
  }
}

TEST_P(Element, RigidMotionsGiveNoForce) {
  const Scene scene = random_scene(3, Shapes::all);
  const ElementForce force = element_force(scene, GetParam());
  const auto n = static_cast<std::size_t>(force.form().slots);
  std::vector<double> p(4 * n), f(2 * n);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t c = 0; c < 4; ++c) p[4 * k + c] = 1.0 + static_cast<double>(c);
  }
  force.apply(p.data(), f.data());
  for (const double x : f) EXPECT_EQ(x, 0.0) << "differences of equal numbers are exactly zero";
}

INSTANTIATE_TEST_SUITE_P(Levels, Element,
                         testing::Values(SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512),
                         [](const auto& c) { return std::string(name_of(c.param)); });

// Moves, tractions with keys, body force, holds that begin and end between steps.
TEST(ElementRuns, AreThoseOfTheOtherKernels) {
  const Mass lumped = Mass::lumped;
  std::vector<Scene> scenes{off_grid_beam(lumped),
                            ramped(lumped),
                            roller(lumped),
                            caught(lumped),
                            moved(lumped, Profile::smooth),
                            moved(lumped, Profile::linear),
                            moved(lumped, Profile::hermite)};
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    Scene& scene = scenes[k];
    scene.body_acceleration = {0.3, -1.0};
    scene.time.step = 2e-3;
    const Probe probe{"right", right_nodes(scene), {}, ""};
    for (const Kernel kernel : {Kernel::csr, Kernel::edge}) {
      Simulation other(scene, {.kernel = kernel});
      Simulation one(scene, {.kernel = Kernel::element});
      EXPECT_EQ(one.kernel(), "element");
      EXPECT_NEAR(other.stable_step(), one.stable_step(), 1e-3 * other.stable_step())
          << "Lanczos with another rounding";
      for (const double t : {0.3, 0.5, 1.0}) {
        ASSERT_FALSE(one.advance(t));
        ASSERT_FALSE(other.advance(t));
        const auto near = [](std::span<const double> a, std::span<const double> b) {
          return difference({a.begin(), a.end()}, {b.begin(), b.end()}, 0, a.size());
        };
        EXPECT_LT(near(other.u(), one.u()), 1e-11) << k;
        EXPECT_LT(near(other.v(), one.v()), 1e-11) << k;
        EXPECT_LT(near(other.w_lambda(), one.w_lambda()), 1e-11) << k;
        EXPECT_LT(near(other.w_mu(), one.w_mu()), 1e-11) << k;
        EXPECT_LT(near(other.reaction(), one.reaction()), 1e-11) << k;
        EXPECT_LT(near(other.external_force(), one.external_force()), 1e-15) << k;
        const Energies a = other.energies(), b = one.energies();
        const double turnover = std::abs(a.work) + a.kinetic + a.stored + a.dissipated;
        EXPECT_NEAR(a.kinetic, b.kinetic, 1e-11 * turnover) << k;
        EXPECT_NEAR(a.stored, b.stored, 1e-11 * turnover) << k;
        EXPECT_NEAR(a.dissipated, b.dissipated, 1e-11 * turnover) << k;
        EXPECT_NEAR(a.work, b.work, 1e-11 * turnover) << k;
        EXPECT_NEAR(other.read(probe).force.x, one.read(probe).force.x,
                    1e-11 * (1.0 + std::abs(other.read(probe).force.x)));
      }
      EXPECT_EQ(other.counters().steps, one.counters().steps);
    }
  }
}

TEST(ElementRuns, ThreadsDoNotChangeTheResult) {
  Scene scene;
  scene.mesh = rectangle({3.0, 1.0}, 181, 31, Diagonal::alternating);
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
  Simulation one(scene, {.kernel = Kernel::element, .threads = 1});
  EXPECT_EQ(one.threads(), 1);
  ASSERT_FALSE(one.advance(0.02));
  // Several blocks: the sweeps of a step follow each other through the mesh.
  ASSERT_GE(ElementForm(scene.mesh, {{scene.material}, {}}).blocks(256).size(), 12u);
  Simulation csr(scene, {.kernel = Kernel::csr});
  ASSERT_FALSE(csr.advance(0.02));
  const auto near = [](std::span<const double> a, std::span<const double> b) {
    return difference({a.begin(), a.end()}, {b.begin(), b.end()}, 0, a.size());
  };
  EXPECT_LT(near(csr.u(), one.u()), 1e-12);
  EXPECT_LT(near(csr.v(), one.v()), 1e-12);
  EXPECT_LT(near(csr.w_lambda(), one.w_lambda()), 1e-12);
  EXPECT_LT(near(csr.w_mu(), one.w_mu()), 1e-12);
  for (const int threads : {2, 3, 4}) {
    Simulation several(scene, {.kernel = Kernel::element, .threads = threads});
    EXPECT_EQ(several.threads(), threads);
    ASSERT_FALSE(several.advance(0.02));
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

TEST(NodeOrder, HasEveryNodeOnceAndNeighboursNear) {
  // Two pieces, numbered in turns.
  Mesh mesh = rectangle({1, 1}, 20, 20);
  const int n = mesh.node_count();
  Mesh both;
  for (const Vec2& p : mesh.points) both.points.insert(both.points.end(), {p, {p.x + 2, p.y}});
  for (const Triangle& t : mesh.triangles) {
    both.triangles.push_back({2 * t[0], 2 * t[1], 2 * t[2]});
    both.triangles.push_back({2 * t[0] + 1, 2 * t[1] + 1, 2 * t[2] + 1});
  }
  prepare(both);
  const std::vector<std::int32_t> order = narrow_order(both);
  std::vector<int> place(2 * n, -1);
  for (std::size_t k = 0; k < order.size(); ++k) {
    EXPECT_EQ(place[order[k]], -1);
    place[order[k]] = static_cast<int>(k);
  }
  ASSERT_EQ(order.size(), both.points.size());
  for (const Triangle& t : both.triangles) {
    const auto [low, high] = std::minmax({place[t[0]], place[t[1]], place[t[2]]});
    // A level of the breadth-first order is a diagonal of the square: 20 nodes, or both ends of two of them.
    EXPECT_LE(high - low, 41);
  }
}

TEST(ElementForm, BlocksShareOutNodesAndTriangles) {
  const Mesh mesh = rectangle({1, 1}, 60, 60, Diagonal::alternating);
  const ElementForm form(mesh, {{{7, 5, 4, 2, 0.2, Mass::lumped}}, {}});
  EXPECT_EQ(form.slots, form.nodes);
  // A level of the breadth-first order is about a diagonal of the square; a triangle reaches one level on.
  EXPECT_LT(form.bandwidth, 3 * 60);
  for (const std::int32_t smallest : {1, 100, 500, 10000}) {
    const auto blocks = form.blocks(smallest);
    std::int32_t node = 0;
    std::int64_t triangle = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      EXPECT_EQ(blocks[b].first_node, node);
      EXPECT_EQ(blocks[b].first_triangle, triangle);
      node = blocks[b].last_node;
      triangle = blocks[b].last_triangle;
      for (std::int64_t e = blocks[b].first_triangle; e < blocks[b].last_triangle; ++e) {
        const std::int32_t end = b + 1 < blocks.size() ? blocks[b + 1].last_node : node;
        for (const std::uint32_t corner : form.offset[e]) {
          EXPECT_GE(static_cast<std::int32_t>(corner / 4), blocks[b].first_node);
          EXPECT_LT(static_cast<std::int32_t>(corner / 4), end);
          const bool reaches = b + 1 < blocks.size() && static_cast<std::int32_t>(corner / 4) >= node;
          EXPECT_TRUE(!reaches || e >= blocks[b + 1].reaching) << "into the next block";
        }
      }
    }
    EXPECT_EQ(node, mesh.node_count());
    EXPECT_EQ(triangle, mesh.triangle_count());
  }
}

TEST(ElementForce, IsTheStiffnessOfTheAssembledForm) {
  const Scene scene = random_scene(6);
  const Model matrices(scene.mesh, scene.material);
  const Model elements(scene.mesh, scene.material, Assembly::elements);
  const Vector x = Vector::Random(2 * scene.mesh.node_count());
  const double lambda = scene.material.lambda_ela, mu = scene.material.mu_ela;
  const Vector expected = matrices.stiffness({Moduli{lambda, mu}}, x);
  EXPECT_LT((elements.stiffness({Moduli{lambda, mu}}, x) - expected).norm(), 1e-13 * expected.norm());
}

TEST(ElementKernel, IsRefusedWhereTheSceneDoesNotAllowIt) {
  for (const Scene& scene :
       {paper_beam(Mass::consistent), tied(Mass::lumped), baumgarte(paper_beam(Mass::lumped))}) {
    try {
      Simulation(scene, {.kernel = Kernel::element});
      ADD_FAILURE() << "not refused";
    } catch (const std::runtime_error& e) {
      EXPECT_STREQ(
          e.what(),
          "kernel element needs mass = \"lumped\" and constraints = \"auto\" without [[constraint]]: "
          "use auto or csr");
    }
  }
}

}  // namespace
}  // namespace rheo::test
