// Several materials in one mesh: every kernel and integrator against the matrix exponential, each other, and
// what is known of layers in series and in parallel; energy, momentum, threads.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rheo/dense_flow.hpp"
#include "rheo/error.hpp"
#include "rheo/live.hpp"
#include "rheo/simulation.hpp"
#include "support/exact.hpp"
#include "support/sanitized.hpp"
#include "support/scenes.hpp"
#include "support/whole_materials.hpp"

namespace rheo::test {
namespace {

const std::vector<double> times{0.1, 0.4, 0.8};

// Triangles of all of them strewn over the mesh.
void strew(Scene& scene, std::vector<Material> materials, std::mt19937& random) {
  scene.material = materials.front();
  scene.regions.clear();
  for (std::size_t k = 1; k < materials.size(); ++k) {
    materials[k].mass = scene.material.mass;
    scene.regions.push_back({"part", materials[k], {}, "[[region]]"});
  }
  scene.region_of_triangle.clear();
  for (std::size_t e = 0; e < scene.mesh.triangles.size(); ++e) {
    const auto any = static_cast<std::size_t>(random()) % materials.size();
    scene.region_of_triangle.push_back(static_cast<std::int32_t>(e < materials.size() ? e : any));
  }
}

// Loads and motions that come and go, on a small irregular body of random materials.
Scene random_scene(std::mt19937& random, Mass mass, int materials = 2, int columns = 3, int rows = 3) {
  Scene scene;
  scene.mesh = rectangle({1.0, 0.6}, columns, rows, Diagonal::alternating);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double shift = 0.15 / columns;
  for (Vec2& p : scene.mesh.points) p.x += shift * unit(random), p.y += 0.5 * shift * unit(random);
  prepare(scene.mesh);
  std::vector<Material> all;
  for (int k = 0; k < materials; ++k)
    all.push_back(random_material(random, 0.2 * std::pow(3.0, unit(random)), 4.0, 10.0));
  all.front().mass = mass;
  strew(scene, all, random);
  scene.body_acceleration = {0.2, -0.5};
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, "left"});
  scene.tractions.push_back(
      {scene.mesh.edge_groups.at("right"), {{0.0, {1.0, 0.0}}, {0.3, {0.4, 0.3}}}, {0.0, 0.45}, "pull"});
  scene.moves.push_back({{columns * rows - 1},
                         Axis::y,
                         {0.2, 0.7},
                         {{0.2, {}, {}}, {0.5, {0.0, 0.05}, {}}},
                         Profile::smooth,
                         "lift"});
  scene.time.duration = 0.8;
  scene.time.frame_rate = 20.0;
  return scene;
}

Eigen::VectorXd vector_of(std::span<const double> x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

std::vector<ExactState> run(const Scene& scene, Kernel kernel) {
  Simulation simulation(scene, {.kernel = kernel});
  std::vector<ExactState> states;
  for (const double t : times) {
    EXPECT_FALSE(simulation.advance(t));
    states.push_back({t, vector_of(simulation.u()), vector_of(simulation.v()),
                      vector_of(simulation.w_lambda()), vector_of(simulation.w_mu())});
  }
  return states;
}

constexpr int exact_scenes = is_sanitized ? 1 : 2;

TEST(SeveralMaterials, EveryKernelAndIntegratorFollowsTheExactSolution) {
  std::mt19937 random(31);
  for (int k = 0; k < exact_scenes; ++k) {
    const Mass mass = k % 2 == 0 ? Mass::lumped : Mass::consistent;
    Scene scene = random_scene(random, mass, 2, 3, 2);
    const auto exact = ExactSolution(scene).at(times);
    std::vector<Kernel> kernels{Kernel::csr};
    if (mass == Mass::lumped) kernels.push_back(Kernel::element);
    for (const Kernel kernel : kernels) {
      scene.time.step = 0.0;
      scene.time.integrator = IntegratorKind::exponential;
      scene.time.tolerance = 1e-11;
      EXPECT_LT(run_error(exact, run(scene, kernel)), 1e-9) << k;
      scene.time.integrator = IntegratorKind::rk4;
      const double stable = Simulation(scene, {.kernel = kernel}).stable_step();
      std::vector<double> errors;
      for (const double parts : {8.0, 32.0}) {
        scene.time.step = stable / parts;
        errors.push_back(run_error(exact, run(scene, kernel)));
      }
      EXPECT_NEAR(std::log2(errors[0] / errors[1]) / 2, 4.0, 0.25) << k << ": " << errors[0];
      scene.time.integrator = IntegratorKind::euler;
      scene.time.step = 0.0;
      const double euler_stable = Simulation(scene, {.kernel = kernel}).stable_step();
      errors.clear();
      for (const double parts : {4.0, 16.0}) {
        scene.time.step = euler_stable / parts;
        errors.push_back(run_error(exact, run(scene, kernel)));
      }
      EXPECT_NEAR(std::log2(errors[0] / errors[1]) / 2, 1.0, 0.1) << k << ": " << errors[0];
    }
    scene.time.integrator = IntegratorKind::implicit;
    scene.time.step = 0.0025;
    EXPECT_LT(run_error(exact, run(scene, Kernel::automatic)), 1e-5) << k;
    const auto flow = dense_flow(scene, times);
    std::vector<ExactState> states;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const Eigen::VectorXd y = vector_of(flow[i]);
      const Eigen::Index d = y.size() / 4;
      states.push_back(
          {times[i], y.segment(0, d), y.segment(d, d), y.segment(2 * d, d), y.segment(3 * d, d)});
    }
    EXPECT_LT(run_error(exact, states), 1e-9) << k;
  }
}

constexpr int constraint_scenes = is_sanitized ? 1 : 2;

TEST(SeveralMaterials, GeneralConstraintsAndBaumgarteToo) {
  std::mt19937 random(32);
  for (int k = 0; k < constraint_scenes; ++k) {
    Scene scene = random_scene(random, k % 2 == 0 ? Mass::lumped : Mass::consistent, 2, 3, 2);
    scene.moves.clear();
    scene.constraints.push_back({{{5, Axis::x, 1.0}, {1, Axis::x, -1.0}}, 0.01, "tie"});
    if (k == 1) scene.time.constraints = ConstraintMethod::baumgarte;
    const auto exact = ExactSolution(scene).at(times);
    scene.time.step = Simulation(scene).stable_step() / 16;
    EXPECT_LT(run_error(exact, run(scene, Kernel::automatic)), 1e-4) << k;
    scene.time.integrator = IntegratorKind::implicit;
    scene.time.step = 0.0025;
    EXPECT_LT(run_error(exact, run(scene, Kernel::automatic)), 1e-5) << k;
  }
}

TEST(SeveralMaterials, AnAccuracyAskedForIsKept) {
  std::mt19937 random(33);
  Scene scene = random_scene(random, Mass::lumped, 2, 3, 2);
  const auto exact = ExactSolution(scene).at(times);
  for (const double accuracy : {1e-3, 1e-8}) {
    scene.time.accuracy = accuracy;
    EXPECT_LT(run_error(exact, run(scene, Kernel::automatic)), accuracy);
  }
}

// The same course by matrices and by triangles, to what rounding adds up to over some thousand steps.
TEST(SeveralMaterials, KernelsAgree) {
  std::mt19937 random(34);
  for (int k = 0; k < 12; ++k) {
    Scene scene = random_scene(random, Mass::lumped, 2 + k % 3, 7, 6);
    if (k % 4 == 3) {  // one branch each: the kernel of its own
      strew(scene,
            {{.lambda_ela = 7, .mu_ela = 5, .lambda_vis = 4, .mu_vis = 2, .density = 0.2},
             {.lambda_ela = 0, .mu_ela = 50, .lambda_vis = 4, .mu_vis = 30, .density = 0.4},
             {.lambda_ela = 9, .mu_ela = 1, .lambda_vis = 2, .density = 0.1}},
            random);
    }
    Simulation csr(scene, {.kernel = Kernel::csr}), element(scene);
    EXPECT_EQ(element.kernel(), "element");
    ASSERT_FALSE(csr.advance(0.4));
    ASSERT_FALSE(element.advance(0.4));
    const auto near = [&](std::span<const double> a, std::span<const double> b, const char* what) {
      const Eigen::VectorXd x = vector_of(a), y = vector_of(b);
      EXPECT_LE((x - y).norm(), 1e-11 * x.norm()) << what << ' ' << k;
    };
    near(csr.u(), element.u(), "u");
    near(csr.v(), element.v(), "v");
    near(csr.w_lambda(), element.w_lambda(), "w_lambda");
    near(csr.w_mu(), element.w_mu(), "w_mu");
    near(csr.pull_mu(), element.pull_mu(), "pull");
    near(csr.w_mu(0), element.w_mu(0), "of a branch");
    near(csr.reaction(), element.reaction(), "reaction");
    std::vector<double> a(3 * scene.mesh.triangles.size()), b(a);
    csr.stress(a);
    element.stress(b);
    near(a, b, "stress");
    const Energies e = csr.energies(), f = element.energies();
    EXPECT_NEAR(e.kinetic, f.kinetic, 1e-11 * e.kinetic) << k;
    EXPECT_NEAR(e.stored, f.stored, 1e-11 * e.stored) << k;
    EXPECT_NEAR(e.dissipated, f.dissipated, 1e-11 * e.dissipated) << k;
    EXPECT_NEAR(e.work, f.work, 1e-11 * std::abs(e.work) + 1e-13 * e.dissipated) << k;
  }
}

// Where all regions are of one material nothing changes, bit for bit.
TEST(SeveralMaterials, EqualOnesAreOne) {
  std::mt19937 random(35);
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    Scene one = random_scene(random, mass);
    one.regions.clear();
    one.region_of_triangle.clear();
    Scene split = one;
    strew(split, {one.material, one.material, one.material}, random);
    const auto a = run(one, Kernel::automatic), b = run(split, Kernel::automatic);
    EXPECT_EQ(run_error(a, b), 0.0);
  }
}

double balance(const Energies& e) {
  return e.kinetic + e.stored + e.dissipated - e.work;
}

TEST(SeveralMaterials, EnergyBalanceHasOrderFourAndDissipationNeverFalls) {
  std::mt19937 random(36);
  for (int k = 0; k < 4; ++k) {
    Scene scene = random_scene(random, k % 2 == 0 ? Mass::lumped : Mass::consistent, 3);
    const double stable = Simulation(scene).stable_step();
    std::vector<double> drifts;
    for (const double refinement : {4.0, 8.0, 16.0}) {
      scene.time.step = stable / 4;
      scene.time.refinement = refinement;
      Simulation simulation(scene);
      double worst = 0.0, scale = 0.0, before = 0.0;
      for (int i = 1; i <= 40; ++i) {
        ASSERT_FALSE(simulation.advance(i / 50.0));
        const Energies e = simulation.energies();
        EXPECT_GE(e.dissipated, before);
        before = e.dissipated;
        worst = std::max(worst, std::abs(balance(e)));
        scale = std::max({scale, std::abs(e.work), e.stored});
      }
      drifts.push_back(worst / scale);
    }
    // Fast rates come to the order late; beside 1e-11 rounding shows.
    if (drifts.front() > 1e-10) {
      EXPECT_GE(std::log2(drifts.front() / drifts.back()) / 2, 3.5) << k << ": " << drifts.front();
    }
    EXPECT_LT(drifts.back(), 1e-9) << k;
  }
}

TEST(SeveralMaterials, AFreeBodyKeepsItsMomentum) {
  std::mt19937 random(37);
  for (const IntegratorKind integrator :
       {IntegratorKind::rk4, IntegratorKind::exponential, IntegratorKind::implicit}) {
    Scene scene = random_scene(random, Mass::lumped, 3);
    scene.fixes.clear();
    scene.moves.clear();
    scene.body_acceleration = {};
    scene.tractions[0].keys.resize(1);
    scene.tractions[0].window = {0.0, 0.2};
    scene.time.integrator = integrator;
    Simulation simulation(scene);
    Eigen::VectorXd mass = Eigen::VectorXd::Zero(2 * scene.mesh.node_count());
    for (const DenseMatrices& m : matrices_by_region(scene)) mass += m.mass.diagonal();
    // Px, Py and the angular momentum about the reference position (linear theory).
    const auto momenta = [&] {
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      for (int i = 0; i < scene.mesh.node_count(); ++i) {
        const double px = mass[2 * i] * simulation.v()[2 * i], py = mass[2 * i] * simulation.v()[2 * i + 1];
        const Vec2 x = scene.mesh.points[i];
        p += Eigen::Vector3d(px, py, x.x * py - x.y * px);
      }
      return p;
    };
    ASSERT_FALSE(simulation.advance(0.2));
    const Eigen::Vector3d begin = momenta();
    ASSERT_FALSE(simulation.advance(0.8));
    EXPECT_GT(begin.norm(), 1e-3);
    EXPECT_LT((momenta() - begin).norm(), 1e-11 * begin.norm());
  }
}

TEST(SeveralMaterials, ThreadsDoNotChangeABit) {
  std::mt19937 random(38);
  for (const bool one_branch : {true, false}) {
    Scene scene = random_scene(random, Mass::lumped, 3, 181, 31);
    if (one_branch) {
      strew(scene,
            {{.lambda_ela = 7, .mu_ela = 5, .lambda_vis = 4, .mu_vis = 2, .density = 0.2},
             {.lambda_ela = 3, .mu_ela = 50, .lambda_vis = 4, .mu_vis = 30, .density = 0.4}},
            random);
    }
    std::vector<double> first;
    for (const int threads : {1, 2, 3}) {
      Simulation simulation(scene, {.threads = threads});
      EXPECT_EQ(simulation.threads(), threads);
      ASSERT_FALSE(simulation.advance(20 * simulation.step_bound()));
      std::vector<double> state(simulation.v().begin(), simulation.v().end());
      state.insert(state.end(), simulation.w_mu().begin(), simulation.w_mu().end());
      state.push_back(simulation.energies().dissipated);
      if (first.empty()) first = state;
      EXPECT_TRUE(state == first) << threads;
    }
  }
}

TEST(SeveralMaterials, HandsPushAndGrabAndTheSessionGivesTheSameBits) {
  std::mt19937 random(39);
  Scene scene = random_scene(random, Mass::lumped);
  scene.moves.clear();
  LiveSettings settings;
  settings.rate = 100.0;
  settings.record = 1000;
  settings.handles.push_back({"tip", {8}, scene.mesh.edge_groups.at("right")});
  Live live(scene, settings);
  ASSERT_GT(live.grab(0), 0);
  for (int k = 0; k < 20; ++k) {
    live.drag(0, {0.002 * k, 0.001 * k});
    ASSERT_FALSE(live.tick());
  }
  live.release(0);
  live.push(0, {0.5, 0.2});
  for (int k = 0; k < 20; ++k) ASSERT_FALSE(live.tick());
  Simulation again(live.session());
  for (int k = 1; k <= 40; ++k) ASSERT_FALSE(again.advance(k / 100.0));
  for (std::size_t i = 0; i < again.u().size(); ++i) {
    EXPECT_EQ(again.u()[i], live.simulation().u()[i]);
    EXPECT_EQ(again.w_mu()[i], live.simulation().w_mu()[i]);
  }
}

TEST(SeveralMaterials, SeparateBodiesMoveAsIfAlone) {
  std::mt19937 random(40);
  Scene left = random_scene(random, Mass::lumped, 1), right = random_scene(random, Mass::lumped, 1);
  Scene both = left;
  const int n = left.mesh.node_count();
  both.mesh.edge_groups.clear();
  for (const Vec2& p : right.mesh.points) both.mesh.points.push_back({p.x + 3.0, p.y});
  both.region_of_triangle.assign(left.mesh.triangles.size(), 0);
  for (const Triangle& t : right.mesh.triangles) {
    both.mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
    both.region_of_triangle.push_back(1);
  }
  prepare(both.mesh);
  both.regions = {{"right", right.material, {}, "right"}};
  for (Fix fix : right.fixes) {
    for (int& node : fix.nodes) node += n;
    both.fixes.push_back(fix);
  }
  for (Move move : right.moves) {
    for (int& node : move.nodes) node += n;
    both.moves.push_back(move);
  }
  for (Traction traction : right.tractions) {
    for (Edge& edge : traction.edges) edge = {edge[0] + n, edge[1] + n};
    both.tractions.push_back(traction);
  }
  left.region_of_triangle.clear();
  right.region_of_triangle.clear();
  for (Scene* scene : {&left, &right, &both}) {
    scene->time.integrator = IntegratorKind::exponential;
    scene->time.tolerance = 1e-12;
  }
  const auto a = run(left, Kernel::automatic), b = run(right, Kernel::automatic);
  const auto all = run(both, Kernel::automatic);
  for (std::size_t k = 0; k < times.size(); ++k) {
    for (auto block : {&ExactState::u, &ExactState::v, &ExactState::w_lambda, &ExactState::w_mu}) {
      const Eigen::VectorXd &x = a[k].*block, &y = b[k].*block, &z = all[k].*block;
      const double size = std::max(x.norm(), y.norm());
      EXPECT_LE((z.head(2 * n) - x).norm(), 1e-9 * size);
      EXPECT_LE((z.tail(2 * n) - y).norm(), 1e-9 * size);
    }
  }
}

// A block confined between frictionless walls (u_y = 0), its left end held, triangles of the second material
// where `second` says so of their middle.
template <class Second>
Scene confined_layers(const Material& first, const Material& second_material, const Second& second) {
  Scene scene;
  scene.mesh = rectangle({1.0, 0.5}, 9, 5, Diagonal::alternating);
  scene.material = first;
  scene.regions = {{"second", second_material, {}, "second"}};
  for (const Triangle& t : scene.mesh.triangles) {
    Vec2 middle;
    for (const int node : t) {
      middle.x += scene.mesh.points[node].x / 3;
      middle.y += scene.mesh.points[node].y / 3;
    }
    scene.region_of_triangle.push_back(second(middle) ? 1 : 0);
  }
  std::vector<int> all(scene.mesh.points.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  scene.fixes.push_back({all, Axis::y, {}, "walls"});
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::x, {}, "left"});
  scene.time.frame_rate = 10.0;
  return scene;
}

// Patch test: an elastic layer beside another one, pulled across the interface, has one stress everywhere,
// whatever the moduli; pulled along it, one strain, and each layer its own stress.
TEST(SeveralMaterials, PatchTestAcrossAndAlongAnInterface) {
  Material soft, hard;
  soft.density = 0.1, soft.elastic = {2.0, 1.0}, soft.viscous = {0.4, 0.2};
  hard.density = 0.3, hard.elastic = {300.0, 500.0}, hard.viscous = {60.0, 100.0};
  for (const bool across : {true, false}) {
    Scene scene = confined_layers(soft, hard, [&](Vec2 p) { return across ? p.x > 0.5 : p.y > 0.25; });
    const std::vector<Edge> right = scene.mesh.edge_groups.at("right");
    if (across) {
      scene.tractions.push_back({right, {{0.0, {0.7, 0.0}}}, {}, "pull"});
    } else {
      scene.moves.push_back(
          {nodes_of(right), Axis::x, {}, {{0.0, {}, {}}, {0.5, {0.02, 0.0}, {}}}, Profile::smooth, "pull"});
    }
    scene.time.duration = 6.0;
    scene.time.integrator = IntegratorKind::exponential;
    Simulation simulation(scene);
    ASSERT_FALSE(simulation.advance(6.0));
    std::vector<double> sigma(3 * scene.mesh.triangles.size());
    simulation.stress(sigma);
    for (std::size_t e = 0; e < scene.mesh.triangles.size(); ++e) {
      const Material& m = scene.region_of_triangle[e] == 1 ? hard : soft;
      const double uniaxial = m.elastic.lambda + 2 * m.elastic.mu;
      const double expected = across ? 0.7 : 0.02 * uniaxial;
      EXPECT_NEAR(sigma[3 * e], expected, 1e-8 * expected);
      EXPECT_NEAR(sigma[3 * e + 1], expected * m.elastic.lambda / uniaxial, 1e-8 * expected);
      EXPECT_NEAR(sigma[3 * e + 2], 0.0, 1e-8 * expected);
    }
    for (std::size_t i = 0; across && i < scene.mesh.points.size(); ++i) {
      const double x = scene.mesh.points[i].x;
      const double u = 0.7 * (std::min(x, 0.5) / 4.0 + std::max(x - 0.5, 0.0) / 1300.0);
      EXPECT_NEAR(simulation.u()[2 * i], u, 1e-9);
    }
  }
}

// A spring (modulus E1) and a Maxwell layer (E2, n2) in series, L1 and L2 long, stretched by U(t):
//   C sigma' + L2 / n2 sigma = U',  C = L1 / E1 + L2 / E2
// with the layers' uniaxial moduli lambda + 2 mu; so light that inertia does not count.
TEST(SeveralMaterials, LayersInSeriesRelaxTogether) {
  Material spring, maxwell;
  spring.density = maxwell.density = 1e-7;
  spring.elastic = {4.0, 3.0};
  spring.viscous = {1e-5, 1e-5};  // quiets the waves
  maxwell.lambda_ela = 5.0, maxwell.mu_ela = 2.5;
  maxwell.lambda_vis = 10.0, maxwell.mu_vis = 5.0;
  Scene scene = confined_layers(spring, maxwell, [](Vec2 p) { return p.x > 0.375; });
  const double stretch = 0.01, ramp = 0.8;
  scene.moves.push_back({nodes_of(scene.mesh.edge_groups.at("right")),
                         Axis::x,
                         {},
                         {{0.0, {}, {}}, {ramp, {stretch, 0.0}, {}}},
                         Profile::smooth,
                         "stretch"});
  scene.time.duration = 4.0;
  scene.time.integrator = IntegratorKind::implicit;
  scene.time.step = 0.002;
  const double l1 = 0.375, l2 = 0.625, e1 = 10.0, e2 = 10.0, n2 = 20.0;
  const double c = l1 / e1 + l2 / e2, rate = l2 / (n2 * c);
  Simulation simulation(scene);
  std::vector<double> sigma(3 * scene.mesh.triangles.size());
  for (const double t : {0.4, 0.8, 1.5, 4.0}) {
    ASSERT_FALSE(simulation.advance(t));
    double expected = 0.0;  // the integral of exp(-rate (t - t')) U'(t') / C, by Simpson's rule
    constexpr int pieces = 2000;
    for (int k = 0; k <= pieces; ++k) {
      const double s = std::min(t, ramp) * k / pieces / ramp;
      const double slope = stretch / ramp * 30 * s * s * (1 - s) * (1 - s);
      const double weight = k == 0 || k == pieces ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
      expected += weight * std::exp(-rate * (t - s * ramp)) * slope / c;
    }
    expected *= std::min(t, ramp) / (3 * pieces);
    simulation.stress(sigma);
    for (std::size_t e = 0; e < scene.mesh.triangles.size(); ++e)
      EXPECT_NEAR(sigma[3 * e], expected, 1e-4 * expected) << t;
  }
}

TEST(SeveralMaterials, BadOnesAreRefused) {
  std::mt19937 random(41);
  const Scene good = random_scene(random, Mass::lumped);
  const auto message_of = [](const Scene& scene, Kernel kernel = Kernel::automatic) -> std::string {
    try {
      const Simulation simulation(scene, {.kernel = kernel});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message_of(good), "");
  EXPECT_NE(message_of(good, Kernel::edge).find("one material"), std::string::npos);
  Scene bad = good;
  bad.regions[0].material.mass = Mass::consistent;
  EXPECT_NE(message_of(bad).find("mass = \"consistent\""), std::string::npos);
  bad = good;
  bad.region_of_triangle.pop_back();
  EXPECT_NE(message_of(bad).find("the mesh has"), std::string::npos);
  bad = good;
  bad.region_of_triangle[3] = 2;
  EXPECT_NE(message_of(bad).find("triangle 3: region 2"), std::string::npos);
  bad = good;
  bad.regions[0].material.density = -1.0;
  EXPECT_NE(message_of(bad).find("[[region]]"), std::string::npos);
}

}  // namespace
}  // namespace rheo::test
