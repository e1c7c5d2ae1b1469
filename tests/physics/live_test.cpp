// A scene under hands is the scene that says the same by keys.

#include "rheo/live.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "model.hpp"
#include "rheo/error.hpp"
#include "support/exact.hpp"
#include "support/live_scenes.hpp"

namespace rheo::test {
namespace {

void expect_same_bits(const Simulation& a, const Simulation& b) {
  const auto same = [](std::span<const double> x, std::span<const double> y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end());
  };
  EXPECT_TRUE(same(a.u(), b.u()));
  EXPECT_TRUE(same(a.v(), b.v()));
  EXPECT_TRUE(same(a.w_lambda(), b.w_lambda()));
  EXPECT_TRUE(same(a.w_mu(), b.w_mu()));
}

// Runs a session's scene with outputs at the ticks.
Simulation run_again(const Scene& scene, const SimulationOptions& options) {
  Simulation simulation(scene, options);
  for (std::int64_t k = 0; k < output_count(scene.time); ++k) {
    EXPECT_FALSE(simulation.advance(output_time(scene.time, k)));
  }
  return simulation;
}

TEST(Live, IsItsSessionWrittenAsAScene) {
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    for (const Kernel kernel : {Kernel::edge, Kernel::element, Kernel::csr}) {
      if (mass == Mass::consistent && kernel != Kernel::csr) continue;
      LiveSettings settings = live_settings(live_block(mass));
      settings.simulation.kernel = kernel;
      Live live(live_block(mass), settings);
      for (int k = 0; k < 200; ++k) {
        act(live, k);
        ASSERT_FALSE(live.tick());
      }
      ASSERT_TRUE(live.session_is_complete());
      const Scene scene = live.session();
      EXPECT_GE(scene.moves.size(), 3u);
      EXPECT_EQ(scene.tractions.size(), 4u);  // the scene's own and three pushes
      const Simulation again = run_again(scene, settings.simulation);
      expect_same_bits(live.simulation(), again);
      EXPECT_EQ(live.simulation().counters().steps, again.counters().steps);
      EXPECT_EQ(live.simulation().energies().work, again.energies().work);
    }
  }
}

// A traction that is there at once, then eased off, is a scene's whose first key is not zero.
TEST(Live, APressActsFromItsFirstMomentOn) {
  const LiveSettings settings = live_settings(live_block(Mass::lumped));
  Live live(live_block(Mass::lumped), settings);
  const auto tick = [&](int count) {
    for (int k = 0; k < count; ++k) ASSERT_FALSE(live.tick());
  };
  tick(10);
  EXPECT_TRUE(live.press(push_handle, {5.0, -20.0}));
  tick(1);
  EXPECT_EQ(live.traction(push_handle), (Vec2{5.0, -20.0}));
  EXPECT_FALSE(live.press(push_handle, {1.0, 0.0})) << "it pushes already";
  tick(9);
  live.push(push_handle, {});
  tick(20);
  Scene by_hand = live_block(Mass::lumped);
  by_hand.tractions.push_back(
      {by_hand.mesh.edge_groups.at("top"),
       {{10 / 250.0, {5.0, -20.0}}, {20 / 250.0, {5.0, -20.0}}, {21 / 250.0, {0.0, 0.0}}},
       {10 / 250.0, 22 / 250.0},
       "press"});
  by_hand.time.frame_rate = settings.rate;
  by_hand.time.duration = 40 / settings.rate;
  expect_same_bits(live.simulation(), run_again(by_hand, settings.simulation));
  const Scene session = live.session();
  EXPECT_EQ(session.tractions.back().keys.front().p, (Vec2{5.0, -20.0}));
  expect_same_bits(live.simulation(), run_again(session, settings.simulation));
}

TEST(Live, TheSameBitsOnTwoThreads) {
  // The second's longer blocks keep two threads busy on a larger mesh only.
  for (const auto& [kernel, nx, ny] :
       {std::tuple{Kernel::edge, 61, 41}, std::tuple{Kernel::element, 121, 21}}) {
    const Scene scene = live_block(Mass::lumped, nx, ny);
    LiveSettings settings = live_settings(scene);
    settings.simulation.kernel = kernel;
    settings.simulation.threads = 1;
    Live one(scene, settings);
    settings.simulation.threads = 2;
    Live two(scene, settings);
    ASSERT_EQ(two.simulation().threads(), 2);
    for (int k = 0; k < 50; ++k) {
      act(one, k);
      act(two, k);
      ASSERT_FALSE(one.tick());
      ASSERT_FALSE(two.tick());
      EXPECT_EQ(one.read(grab_handle).force, two.read(grab_handle).force);
    }
    expect_same_bits(one.simulation(), two.simulation());
    EXPECT_EQ(one.simulation().energies().work, two.simulation().energies().work);
  }
}

// Runs a session and compares it with matrix exponentials.
double error_of_session(const TimeSettings& time, Kernel kernel) {
  Scene scene = live_block(Mass::lumped, 2, 3);
  scene.time = time;
  LiveSettings settings = live_settings(scene);
  settings.rate = 100.0;
  settings.simulation.kernel = kernel;
  Live live(scene, settings);
  for (int k = 0; k < 30; ++k) {
    act(live, k);
    EXPECT_FALSE(live.tick());
  }
  const Simulation& s = live.simulation();
  const auto vector = [](std::span<const double> x) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  const ExactState state{live.time(), vector(s.u()), vector(s.v()), vector(s.w_lambda()), vector(s.w_mu())};
  // What a hand holds goes on in the session; the exact state at an event is the one just after it, here that
  // of letting go, which changes none.
  Scene session = live.session();
  for (Move& move : session.moves) move.window.until = std::min(move.window.until, live.time());
  return run_error(ExactSolution(session).at({live.time()}), {state});
}

TEST(Live, IsTheExactSolutionOfItsSession) {
  TimeSettings time = live_block(Mass::lumped).time;
  const double coarse = error_of_session(time, Kernel::edge);
  time.step /= 2;
  EXPECT_LT(coarse, 1e-3);
  EXPECT_NEAR(std::log2(coarse / error_of_session(time, Kernel::edge)), 4.0, 0.25);
  time.step = 0.0;
  time.integrator = IntegratorKind::exponential;
  for (const Kernel kernel : {Kernel::edge, Kernel::element})
    EXPECT_LT(error_of_session(time, kernel), 1e-9);  // its tolerance is 1e-10 in each unit of the state
}

// Neither place nor velocity of any node jumps where a hand takes hold of a moving body, drags it or lets go,
// and no impulse is booked.
TEST(Live, AGrabBeginsSmoothly) {
  Scene scene = live_block(Mass::lumped);
  LiveSettings settings = live_settings(scene);
  settings.rate = 1000.0;
  Live live(scene, settings);
  std::vector<double> v(live.simulation().v().begin(), live.simulation().v().end());
  double largest = 0.0, before_grab = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double t = live.time();
    if (k < 40) live.push(push_handle, {800.0, 0.0});
    if (k == 40) live.push(push_handle, {});
    if (k == 60) {
      EXPECT_GT(live.grab(grab_handle), 0);
    }
    if (k > 60 && k < 160) live.drag(grab_handle, {2e-3 * (1 - std::cos(20.0 * (t - 0.06))), 0.0});
    if (k == 160) {
      EXPECT_TRUE(live.release(grab_handle));
    }
    ASSERT_FALSE(live.tick());
    double change = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i)
      change = std::max(change, std::abs(live.simulation().v()[i] - v[i]));
    v.assign(live.simulation().v().begin(), live.simulation().v().end());
    if (k >= 41 && k < 60) before_grab = std::max(before_grab, change);
    if (k >= 60) largest = std::max(largest, change);
  }
  EXPECT_EQ(live.simulation().counters().projections, 0);
  // v0 goes over in 20 ticks, at most 4 v0 / T fast (the approach's largest acceleration).
  EXPECT_LT(largest, 6.0 * before_grab);
}

TEST(Live, EnergyBalances) {
  for (const Kernel kernel : {Kernel::edge, Kernel::element}) {
    double imbalance[2];
    for (int halvings = 0; halvings < 2; ++halvings) {
      Scene scene = live_block(Mass::lumped);
      scene.time.step = 4e-4 / (1 << halvings);
      LiveSettings settings = live_settings(scene);
      settings.simulation.kernel = kernel;
      Live live(scene, settings);
      double worst = 0.0, most = 0.0;
      for (int k = 0; k < 120; ++k) {
        act(live, k);
        ASSERT_FALSE(live.tick());
        const Energies e = live.simulation().energies();
        worst = std::max(worst, std::abs(e.kinetic + e.stored + e.dissipated - e.work));
        most = std::max(most, e.kinetic + e.stored + e.dissipated);
      }
      EXPECT_GT(most, 0.0);
      imbalance[halvings] = worst / most;
    }
    EXPECT_LT(imbalance[0], 1e-3);
    EXPECT_NEAR(std::log2(imbalance[0] / imbalance[1]), 4.0,
                0.5);  // the order of the steps and of the quadrature
  }
}

// On a free body the hand's impulse is all of its momentum.
TEST(Live, TheHandsForceIsTheBodysMomentum) {
  for (const Kernel kernel : {Kernel::edge, Kernel::element, Kernel::csr}) {
    Scene scene = live_block(Mass::lumped);
    scene.fixes.clear();
    scene.tractions.clear();
    scene.body_acceleration = {};
    LiveSettings settings = live_settings(scene);
    settings.rate = 2000.0;
    settings.simulation.kernel = kernel;
    Live live(scene, settings);
    const Model model(scene.mesh, scene.material);
    ASSERT_GT(live.grab(grab_handle), 0);
    live.push(push_handle, {3.0, 0.0});  // along its edges' line: 3 Pa over 0.1 m x 0.05 m
    double impulse = 0.0, before = 0.0, largest = 0.0;
    for (int k = 0; k < 400; ++k) {
      const double t = live.time() + 1.0 / settings.rate;
      live.drag(grab_handle, {5e-3 * (1 - std::cos(20 * t)), 0.0}, {0.1 * std::sin(20 * t), 0.0});
      ASSERT_FALSE(live.tick());
      const double force = live.read(grab_handle).force.x + live.read(push_handle).force.x;
      impulse += 0.5 * (before + force) / settings.rate;
      before = force;
      double momentum = 0.0;
      for (int node = 0; node < scene.mesh.node_count(); ++node)
        momentum += model.node_mass[node] * live.simulation().v()[2 * node];
      largest = std::max(largest, std::abs(momentum));
      // The trapezium rule, and b'' that jumps a little from tick to tick.
      ASSERT_NEAR(impulse, momentum, 1e-2 * std::max(largest, 1e-3)) << k;
    }
    EXPECT_GT(largest, 5e-3);
    EXPECT_NEAR(live.read(push_handle).force.x, 3.0 * 0.1 * 0.05, 1e-15);
  }
}

TEST(Live, TheStableStepHoldsWhateverIsGrabbed) {
  for (const double rate : {0.0, 40.0}) {  // 1/s, of relaxation beside that of the material
    Scene scene = live_block(Mass::lumped);
    scene.material.lambda_vis = 1.0 / (1.0 / scene.material.lambda_vis + rate / scene.material.lambda_ela);
    scene.time.step = 0.0;
    LiveSettings settings = live_settings(scene);
    settings.rate = 10.0;  // several of the largest steps
    settings.simulation.stable_share = 0.99;
    settings.handles[brush_handle].capacity = scene.mesh.node_count();
    Live live(scene, settings);
    unsigned random = 1;
    const auto next = [&](unsigned below) {
      random = random * 1664525u + 1013904223u;
      return (random >> 8) % below;
    };
    for (int k = 0; k < 400; ++k) {
      if (k % 8 == 0) {
        live.release(brush_handle);
        std::vector<int> nodes;
        for (int node = 0; node < scene.mesh.node_count(); ++node) {
          if (next(4) < static_cast<unsigned>(k / 8 % 4)) nodes.push_back(node);
        }
        ASSERT_TRUE(live.pick(brush_handle, nodes, {}));
        live.grab(brush_handle);
      }
      live.drag(brush_handle, {1e-3 * std::sin(0.3 * k), 1e-3 * std::cos(0.3 * k)});
      const auto diverged = live.tick();
      ASSERT_FALSE(diverged) << diverged->t;
    }
  }
}

TEST(Live, HandsTakeOnlyWhatTheSceneLeavesThem) {
  Scene scene = live_block(Mass::lumped);
  LiveSettings settings = live_settings(scene);
  settings.handles.push_back({"floor", {}, scene.mesh.edge_groups.at("bottom")});
  settings.handles.push_back({"again", {}, scene.mesh.edge_groups.at("right")});
  const int floor = static_cast<int>(settings.handles.size()) - 2;
  Live live(scene, settings);
  EXPECT_EQ(live.grab(floor), 0);  // fixed for ever
  const int all = live.grab(grab_handle);
  EXPECT_GT(all, 0);
  EXPECT_EQ(live.grab(floor + 1), 0);  // another hand has them
  EXPECT_FALSE(live.drag(floor + 1, {}));
  EXPECT_FALSE(live.drag(grab_handle, {std::nan(""), 0.0}));
  EXPECT_FALSE(live.pick(grab_handle, {}, {}));  // busy
  ASSERT_FALSE(live.tick());
  EXPECT_TRUE(live.release(grab_handle));
  EXPECT_FALSE(live.release(grab_handle));
  EXPECT_EQ(live.grab(floor + 1), all);
  EXPECT_FALSE(live.pick(brush_handle, std::vector<int>{-1}, {}));
  EXPECT_FALSE(live.pick(brush_handle, std::vector<int>(1000, 3), {}));
}

TEST(Live, DivergenceIsAStatus) {
  Scene scene = live_block(Mass::lumped);
  scene.time.step = 0.05;
  LiveSettings settings = live_settings(scene);
  settings.simulation.allow_unstable = true;
  settings.rate = 20.0;
  Live live(scene, settings);
  std::optional<Divergence> diverged;
  for (int k = 0; k < 2000 && !diverged; ++k) {
    act(live, k);
    diverged = live.tick();
  }
  ASSERT_TRUE(diverged);
  live.push(push_handle, {1.0, 1.0});
  EXPECT_EQ(live.tick()->t, diverged->t);
  EXPECT_EQ(live.time(), diverged->t);
  for (const double x : live.simulation().u()) EXPECT_TRUE(std::isfinite(x));
}

TEST(Live, AMistakeInAHandleIsOneLine) {
  LiveSettings settings = live_settings(live_block(Mass::lumped));
  settings.handles[0].nodes = {100000};
  try {
    Live live(live_block(Mass::lumped), settings);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "handle \"tool\": node 100000: the nodes are numbered 0 to 76");
  }
}

}  // namespace
}  // namespace rheo::test
