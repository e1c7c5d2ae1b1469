// The element kernel with several materials in one mesh, against dense matrices summed over the regions.
//
//   M v' = f - sum over regions r of (J_lambda,r w_lambda,r + J_mu,r w_mu,r),  M = sum of M_r
//   w_lambda,r' = lambda_ela,r v - lambda_rate,r w_lambda,r, w_mu,r likewise

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <random>
#include <unsupported/Eigen/MatrixFunctions>

#include "kernels/element_body.hpp"
#include "schedule.hpp"
#include "support/exact.hpp"
#include "support/kernel_cases.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Patches of three materials that meet in lines and points, with some triangles of another one strewn in.
Regions random_regions(const Mesh& mesh, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto decades = [&](double n) { return std::pow(10.0, n * unit(random)); };
  Regions regions;
  for (int r = 0; r < 3; ++r)
    regions.materials.push_back({decades(3), decades(3), decades(3), decades(3), decades(2), Mass::lumped});
  regions.materials[1].lambda_ela = 0.0;
  regions.materials[2].mu_vis = forever;
  double low = mesh.points[0].x, high = low;
  for (const Vec2& p : mesh.points) low = std::min(low, p.x), high = std::max(high, p.x);
  for (const Triangle& t : mesh.triangles) {
    const double x = (mesh.points[t[0]].x - low) / (high - low);
    const int patch = x < 0.3 ? 0 : x < 0.7 ? 1 : 2;
    regions.of_triangle.push_back(unit(random) > 0.9 ? 2 - patch : patch);
  }
  return regions;
}

// Dense matrices of each region's triangles on all of the mesh's nodes.
struct RegionMatrices {
  RegionMatrices(const Mesh& mesh, const Regions& regions) {
    mass = MatrixXd::Zero(2 * mesh.node_count(), 2 * mesh.node_count());
    for (std::size_t r = 0; r < regions.materials.size(); ++r) {
      Mesh part = mesh;
      part.triangles.clear();
      for (std::size_t e = 0; e < mesh.triangles.size(); ++e) {
        if (regions.of_triangle[e] == static_cast<int>(r)) part.triangles.push_back(mesh.triangles[e]);
      }
      by_region.push_back(dense_matrices(part, regions.materials[r]));
      mass += by_region.back().mass;
    }
  }
  std::vector<DenseMatrices> by_region;
  MatrixXd mass;
};

// A body of several regions with a random state, in the kernel's order and as dense vectors.
struct RegionBody {
  RegionBody(Scene s, Regions r, SimdLevel level, int threads)
      : scene(std::move(s)),
        regions(std::move(r)),
        model(scene.mesh, regions),
        schedule(scene, model),
        interval(schedule.interval(0)),
        form(std::make_shared<ElementForm>(scene.mesh, regions)),
        force(form, level),
        body(model, force, threads),
        base(Vector::Zero(static_cast<Eigen::Index>(model.layout.part))) {
    body.enter(interval, base);
    const Eigen::Index d = base.size();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto any = [&](Eigen::Index) { return unit(random); };
    u = VectorXd::NullaryExpr(d, any);
    v = VectorXd::NullaryExpr(d, any);
    for (const HeldDof& h : interval.eliminated) v[h.dof] = 0.0;
    for (std::size_t k = 0; k < regions.materials.size(); ++k) {
      l.push_back(VectorXd::NullaryExpr(d, any));
      m.push_back(VectorXd::NullaryExpr(d, any));
    }
    for_each_number([](double& kernel, double& dense) { kernel = dense; });
  }

  // Each number of the body's state with the one of the dense vectors.
  template <class Visit>
  void for_each_number(const Visit& visit) {
    for (int slot = 0; slot < form->slots; ++slot) {
      const int node = form->mesh_node[form->slot_node[slot]], r = form->slot_region[slot];
      for (int axis = 0; axis < 2; ++axis) {
        visit(body.state()[body.p() + 4 * slot + axis], l[r][2 * node + axis]);
        visit(body.state()[body.p() + 4 * slot + 2 + axis], m[r][2 * node + axis]);
      }
    }
    for (int k = 0; k < form->nodes; ++k) {
      for (int axis = 0; axis < 2; ++axis) {
        visit(body.state()[body.v() + 2 * k + axis], v[2 * form->mesh_node[k] + axis]);
        visit(body.state()[body.u() + 2 * k + axis], u[2 * form->mesh_node[k] + axis]);
      }
    }
  }

  Scene scene;
  Regions regions;
  Model model;
  Schedule schedule;
  Interval interval;
  std::shared_ptr<ElementForm> form;
  ElementForce force;
  ElementBody body;
  Vector base;
  VectorXd u, v;
  std::vector<VectorXd> l, m;  // by region; meaningless where a region does not touch a node
};

// Tractions and holds of a random scene, none that moves.
Scene still_scene(unsigned seed) {
  Scene scene = random_scene(seed, Shapes::all);
  scene.moves.clear();
  return scene;
}

class Regioned : public testing::TestWithParam<SimdLevel> {
 protected:
  void SetUp() override {
    if (!has_simd_level(GetParam())) GTEST_SKIP() << "this processor has no " << name_of(GetParam());
  }
};

TEST_P(Regioned, SweepsAndEnergiesAreSumsOverTheRegions) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Scene scene = still_scene(seed);
    std::mt19937 random(seed + 50);
    const Regions regions = random_regions(scene.mesh, random);
    RegionBody run(scene, regions, GetParam(), 1);
    ASSERT_GT(run.form->slots, run.form->nodes);
    const RegionMatrices matrices(scene.mesh, regions);

    VectorXd forces = VectorXd::Zero(run.v.size());
    double stored = 0.0, dissipated = 0.0;
    for (std::size_t r = 0; r < regions.materials.size(); ++r) {
      const Material& m = regions.materials[r];
      const VectorXd fl = matrices.by_region[r].j_lambda * run.l[r],
                     fm = matrices.by_region[r].j_mu * run.m[r];
      forces += fl + fm;
      // A branch that is off holds nothing of either, whatever its numbers.
      if (m.lambda_ela > 0.0) {
        stored += 0.5 * run.l[r].dot(fl) / m.lambda_ela;
        dissipated += run.l[r].dot(fl) / m.lambda_vis;
      }
      stored += 0.5 * run.m[r].dot(fm) / m.mu_ela;
      dissipated += run.m[r].dot(fm) / m.mu_vis;
    }
    VectorXd external;
    run.body.external_force(0.0, external);
    const VectorXd inverse = matrices.mass.diagonal().cwiseInverse();
    VectorXd a = inverse.cwiseProduct(external - forces), reaction = VectorXd::Zero(a.size());
    for (const HeldDof& h : run.interval.eliminated) {
      a[h.dof] = 0.0;
      reaction[h.dof] = forces[h.dof] - external[h.dof];
    }

    const EnergySample sample = run.body.sample(0.0);
    EXPECT_NEAR(sample.kinetic, 0.5 * run.v.dot(matrices.mass * run.v), 1e-12 * sample.kinetic);
    EXPECT_NEAR(sample.stored, stored, 1e-12 * stored) << seed;
    EXPECT_NEAR(sample.dissipated, dissipated, 1e-12 * dissipated) << seed;
    Vector got;
    run.body.reaction(0.0, got);
    EXPECT_LT((got - reaction).lpNorm<Eigen::Infinity>(), 1e-12 * forces.lpNorm<Eigen::Infinity>());

    const double h = 0.7;
    std::vector<double> out(run.body.size());
    run.body.fma(h, run.body.state(), run.body.state(), {0.0, {1.0, 0.0, 0.0, 0.0}}, out, Result::step);
    std::copy(out.begin(), out.end(), run.body.state().begin());
    const VectorXd v = run.v;
    run.u += h * v;
    run.v += h * a;
    for (std::size_t r = 0; r < regions.materials.size(); ++r) {
      const Material& m = regions.materials[r];
      run.l[r] += h * (m.lambda_ela * v - m.lambda_rate() * run.l[r]);
      run.m[r] += h * (m.mu_ela * v - m.mu_rate() * run.m[r]);
    }
    // Velocities, whose force is a sum, to the largest of them; the others, sums of two numbers, to
    // themselves.
    const double fastest = run.v.lpNorm<Eigen::Infinity>();
    const double* first_v = run.body.state().data() + run.body.v();
    run.for_each_number([&](double& kernel, double& dense) {
      const bool is_v = &kernel >= first_v && &kernel < first_v + 2 * run.form->nodes;
      const double size = is_v ? fastest : std::abs(dense) + h * v.lpNorm<Eigen::Infinity>();
      EXPECT_NEAR(kernel, dense, 1e-12 * size) << seed;
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, Regioned,
                         testing::Values(SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512),
                         [](const auto& c) { return std::string(name_of(c.param)); });

// A small body of two materials against the exponential of its dense operator.
TEST(Regions, Rk4HasOrderFour) {
  Scene scene;
  scene.mesh = rectangle({1.0, 0.6}, 4, 3, Diagonal::alternating);
  scene.material = {7, 5, 4, 2, 0.2, Mass::lumped};
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, ""});
  scene.time.duration = 1.0;
  Regions regions{{scene.material, {2, 9, 1, 30, 0.5, Mass::lumped}}, {}};
  for (int e = 0; e < scene.mesh.triangle_count(); ++e) regions.of_triangle.push_back(e % 3 == 0 ? 1 : 0);
  const RegionMatrices matrices(scene.mesh, regions);

  std::vector<double> errors;
  for (const double h : {1e-3, 5e-4, 2.5e-4}) {
    RegionBody run(scene, regions, best_simd_level(), 1);
    const Eigen::Index d = run.v.size();
    MatrixXd a = MatrixXd::Zero(6 * d, 6 * d);  // u, v, l_0, m_0, l_1, m_1
    VectorXd y(6 * d);
    y << run.u, run.v, run.l[0], run.m[0], run.l[1], run.m[1];
    a.block(0, d, d, d).setIdentity();
    MatrixXd inverse = matrices.mass.diagonal().cwiseInverse().asDiagonal();
    for (const HeldDof& held : run.interval.eliminated) inverse(held.dof, held.dof) = 0.0;
    for (Eigen::Index r = 0; r < 2; ++r) {
      const Material& m = regions.materials[r];
      const Eigen::Index l = (2 + 2 * r) * d, mu = (3 + 2 * r) * d;
      a.block(d, l, d, d) = -inverse * matrices.by_region[r].j_lambda;
      a.block(d, mu, d, d) = -inverse * matrices.by_region[r].j_mu;
      a.block(l, d, d, d).diagonal().setConstant(m.lambda_ela);
      a.block(l, l, d, d).diagonal().setConstant(-m.lambda_rate());
      a.block(mu, d, d, d).diagonal().setConstant(m.mu_ela);
      a.block(mu, mu, d, d).diagonal().setConstant(-m.mu_rate());
    }
    const double end = 0.4;
    const VectorXd exact = MatrixXd(end * a).exp() * y;
    const auto integrator = make_integrator(IntegratorKind::rk4, run.body.size());
    const auto steps = static_cast<int>(std::lround(end / h));
    for (int k = 0; k < steps; ++k) integrator->step(run.body, k * h, h, run.body.state(), {});
    double error = 0.0;
    run.u = exact.segment(0, d);
    run.v = exact.segment(d, d);
    for (Eigen::Index r = 0; r < 2; ++r) {
      run.l[r] = exact.segment((2 + 2 * r) * d, d);
      run.m[r] = exact.segment((3 + 2 * r) * d, d);
    }
    run.for_each_number(
        [&](double& kernel, double& dense) { error = std::max(error, std::abs(kernel - dense)); });
    errors.push_back(error);
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[2]) / 2, 4.0, 0.1);
  EXPECT_LT(errors[2], 1e-6);
}

TEST(Regions, ThreadsDoNotChangeTheResult) {
  Scene scene;
  scene.mesh = rectangle({3.0, 1.0}, 181, 31, Diagonal::alternating);
  scene.material = {7, 5, 4, 2, 0.2, Mass::lumped};
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, ""});
  scene.time.duration = 1.0;
  std::mt19937 random(5);
  const Regions regions = random_regions(scene.mesh, random);
  std::vector<double> first;
  for (const int threads : {1, 2, 3}) {
    RegionBody run(scene, regions, best_simd_level(), threads);
    EXPECT_EQ(run.body.threads(), threads);
    const auto integrator = make_integrator(IntegratorKind::rk4, run.body.size());
    for (int k = 0; k < 20; ++k) integrator->step(run.body, 0.0, 1e-6, run.body.state(), {});
    const std::vector<double> state(run.body.state().begin(), run.body.state().end());
    if (first.empty()) first = state;
    EXPECT_TRUE(state == first) << threads;
  }
}

// With one material everywhere, however the mesh is divided, nothing changes but the slots.
TEST(Regions, OfEqualMaterialAreOneBody) {
  const Scene scene = still_scene(4);
  std::mt19937 random(9);
  Regions parts = random_regions(scene.mesh, random);
  parts.materials.assign(3, scene.material);
  RegionBody several(scene, parts, best_simd_level(), 1);
  RegionBody one(scene, {{scene.material}, {}}, best_simd_level(), 1);
  EXPECT_EQ(one.form->slots, one.form->nodes);
  for (std::size_t r = 0; r < 3; ++r) several.l[r] = one.l[0], several.m[r] = one.m[0];
  several.u = one.u, several.v = one.v;
  several.for_each_number([](double& kernel, double& dense) { kernel = dense; });
  const double step = 0.2 / one.model.element_omega;
  for (RegionBody* run : {&one, &several}) {
    const auto integrator = make_integrator(IntegratorKind::rk4, run->body.size());
    for (int k = 0; k < 50; ++k) integrator->step(run->body, k * step, step, run->body.state(), {});
    run->for_each_number([](double& kernel, double& dense) { dense = kernel; });
  }
  EXPECT_LT((one.u - several.u).lpNorm<Eigen::Infinity>(), 1e-12 * one.u.lpNorm<Eigen::Infinity>());
  EXPECT_LT((one.v - several.v).lpNorm<Eigen::Infinity>(), 1e-12 * one.v.lpNorm<Eigen::Infinity>());
}

}  // namespace
}  // namespace rheo::test
