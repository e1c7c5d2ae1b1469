// [time] accuracy on random scenes with general constraints: what is asked for is met against exact
// solutions. Materials of one or two branches with or without an elastic part, moves of every profile,
// catches, tractions that change, constraints that begin violated, Baumgarte's equation for all or for the
// general ones.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "rheo/simulation.hpp"
#include "support/event_scenes.hpp"
#include "support/exact.hpp"
#include "support/sanitized.hpp"

namespace rheo::test {
namespace {

constexpr int stride = is_sanitized ? 5 : 1;

class Draw {
 public:
  explicit Draw(int seed) : random_(static_cast<unsigned>(seed)) {}
  double between(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  double decades(double low, double high) { return std::pow(10.0, between(low, high)); }
  int whole(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
  bool one_in(int n) { return whole(1, n) == 1; }

 private:
  std::mt19937 random_;
};

Scene constrained_scene(int seed) {
  Draw draw(seed);
  Scene scene = paper_beam(draw.one_in(3) ? Mass::consistent : Mass::lumped);
  const int columns = 3, rows = draw.whole(2, 3);
  scene.mesh =
      rectangle({2.0, 1.0}, columns, rows, draw.one_in(2) ? Diagonal::falling : Diagonal::alternating);
  for (Vec2& p : scene.mesh.points) p = {p.x + draw.between(-0.1, 0.1), p.y + draw.between(-0.1, 0.1)};
  prepare(scene.mesh);
  scene.fixes[0].nodes = nodes_of(scene.mesh.edge_groups.at("left"));

  Material& m = scene.material;
  m.lambda_ela = draw.decades(0.0, 1.5), m.mu_ela = draw.decades(0.0, 1.0);
  m.lambda_vis = draw.decades(-0.5, 1.5), m.mu_vis = draw.decades(-0.5, 1.5);
  if (draw.one_in(2)) m.more_branches.push_back({3.0, 2.0, draw.decades(-0.5, 1.0), draw.decades(-0.5, 1.0)});
  if (draw.one_in(2)) m.elastic = {draw.between(0.0, 3.0), draw.between(0.1, 3.0)};

  const int last = scene.mesh.node_count() - 1, corner = columns - 1;
  scene.constraints.push_back({{{last, Axis::x, 1.0}, {corner, Axis::x, draw.between(-2.0, -0.5)}},
                               draw.one_in(2) ? draw.between(-0.02, 0.02) : 0.0,
                               "tie"});
  if (draw.one_in(2)) {
    scene.constraints.push_back(
        {{{last, Axis::y, 1.0}, {1, Axis::x, draw.between(-1.0, 1.0)}, {corner, Axis::y, 0.7}},
         draw.one_in(3) ? 0.01 : 0.0,
         "tie of three"});
  }
  if (draw.one_in(2)) {  // a node beside those
    const Profile profile = std::vector{Profile::smooth, Profile::linear, Profile::hermite}[draw.whole(0, 2)];
    const double from = draw.between(0.0, 0.2), until = draw.between(0.5, 0.7);
    scene.moves.push_back({{last - 1},
                           Axis::both,
                           {from, until},
                           {{from, {0, 0}, {0, 0}},
                            {draw.between(0.3, 0.4), {draw.between(-0.1, 0.1), 0.02}, {0.3, -0.1}},
                            {until, {0.05, 0}, {0, 0}}},
                           profile,
                           "grip"});
  } else if (draw.one_in(2)) {
    scene.fixes.push_back({{last - 1}, Axis::x, {draw.between(0.2, 0.4), draw.between(0.5, 0.8)}, "catch"});
  }
  Traction& traction = scene.tractions[0];
  traction.edges = scene.mesh.edge_groups.at("right");
  traction.keys = {{0.1, {draw.between(-5.0, 5.0), 0.0}},
                   {draw.between(0.2, 0.6), {1.0, draw.between(-3.0, 3.0)}}};
  traction.window = {draw.between(0.0, 0.2), draw.between(0.4, 0.9)};
  if (draw.one_in(3)) scene.time.constraints = ConstraintMethod::baumgarte;
  scene.time.baumgarte = draw.decades(0.5, 1.5);
  scene.time.duration = 0.8;
  scene.time.frame_rate = draw.whole(10, 60);
  scene.time.integrator = IntegratorKind::automatic;
  scene.time.accuracy = draw.decades(-9.0, -2.5);
  return scene;
}

class AccuracyOfConstraints : public testing::TestWithParam<int> {};

TEST_P(AccuracyOfConstraints, IsMet) {
  const Scene scene = constrained_scene(GetParam());
  std::vector<double> times;
  const std::int64_t last = output_count(scene.time) - 1;
  for (std::int64_t k = last; k > 0; k -= std::max<std::int64_t>(1, last / 6))
    times.push_back(output_time(scene.time, k));
  std::reverse(times.begin(), times.end());
  const auto exact = ExactSolution(scene).at(times);
  Simulation simulation(scene, {.energies = false});
  const AccuracyPlan plan = simulation.plan().value();
  std::vector<ExactState> states;
  for (std::int64_t k = 1; k <= last && states.size() < times.size(); ++k) {
    const double t = output_time(scene.time, k);
    ASSERT_FALSE(simulation.advance(t));
    if (t != times[states.size()]) continue;
    const auto vector = [](std::span<const double> x) {
      return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())).eval();
    };
    states.push_back({t, vector(simulation.u()), vector(simulation.v()), vector(simulation.w_lambda()),
                      vector(simulation.w_mu())});
  }
  const double error = run_error(exact, states);
  RecordProperty("integrator", static_cast<int>(plan.integrator));
  RecordProperty("log10_error_over_request", std::to_string(std::log10(error / scene.time.accuracy)));
  EXPECT_LE(error, scene.time.accuracy) << "estimate " << plan.estimate;
  EXPECT_LE(plan.estimate, scene.time.accuracy);
}

INSTANTIATE_TEST_SUITE_P(Seeds, AccuracyOfConstraints, testing::Range(1, 51, stride));

}  // namespace
}  // namespace rheo::test
