// The engine's yardstick against the tests' own: two exact solutions that share no line of algebra.
#include "rheo/dense_flow.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "rheo/simulation.hpp"
#include "support/event_scenes.hpp"
#include "support/exact.hpp"

namespace rheo::test {
namespace {

std::vector<double> outputs_of(const Scene& scene) {
  std::vector<double> times;
  for (std::int64_t k = 0; k < output_count(scene.time); ++k) times.push_back(output_time(scene.time, k));
  return times;
}

std::vector<ExactState> dense(const Scene& scene, const std::vector<double>& times) {
  std::vector<ExactState> states;
  const auto flow = dense_flow(scene, times);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto part = static_cast<Eigen::Index>(flow[k].size() / 4);
    const auto block = [&](Eigen::Index i) {
      return Eigen::Map<const Eigen::VectorXd>(flow[k].data() + i * part, part).eval();
    };
    states.push_back({times[k], block(0), block(1), block(2), block(3)});
  }
  return states;
}

// Both are products of some 20 rounded exponentials: 1e-16 each, times the operator's norm, some 500
// (measured: at most 9e-13).
constexpr double rounding = 5e-12;

void expect_agreement(Scene scene, const char* name) {
  scene.time.frame_rate = 3;  // the yardstick takes an exponential an output
  const std::vector<double> times = outputs_of(scene);
  EXPECT_LT(run_error(ExactSolution(scene).at(times), dense(scene, times)), rounding) << name;
}

class DenseFlow : public testing::TestWithParam<Mass> {};

TEST_P(DenseFlow, AgreesWithTheExactSolutionOfTheTests) {
  Scene beam = paper_beam(GetParam());
  beam.time.duration = 1.5;
  expect_agreement(beam, "beam");
  expect_agreement(ramped(GetParam()), "ramped traction");
  for (const Profile profile : {Profile::smooth, Profile::linear, Profile::hermite})
    expect_agreement(moved(GetParam(), profile), "moved");
  expect_agreement(roller(GetParam()), "roller");
  expect_agreement(caught(GetParam()), "caught");
  Scene heavy = off_grid_beam(GetParam());
  heavy.body_acceleration = {0.3, -9.81};
  expect_agreement(heavy, "body force");
}

TEST_P(DenseFlow, AgreesWhereBaumgarteHoldsConstraints) {
  expect_agreement(tied(GetParam()), "tied");
  expect_agreement(pulled_together(GetParam()), "begins violated");
  expect_agreement(baumgarte(moved(GetParam(), Profile::smooth)), "moved, by Baumgarte");
}

TEST_P(DenseFlow, AgreesWithOneModulusAndWithoutRelaxation) {
  Scene scene = off_grid_beam(GetParam());
  scene.material.lambda_ela = 0.0;
  expect_agreement(scene, "mu alone");
  scene = off_grid_beam(GetParam());
  scene.material.lambda_vis = scene.material.mu_vis = INFINITY;
  expect_agreement(scene, "elastic");
}

INSTANTIATE_TEST_SUITE_P(Masses, DenseFlow, testing::Values(Mass::lumped, Mass::consistent),
                         [](const auto& mass) {
                           return mass.param == Mass::lumped ? "Lumped" : "Consistent";
                         });

TEST(DenseFlowStates, GivesTheStateAfterAnEventAtItsTime) {
  Scene scene = caught(Mass::lumped);
  const double times[] = {0.4321};
  const std::vector<double> state = dense_flow(scene, times).front();
  const std::size_t part = state.size() / 4;
  for (const int node : right_nodes(scene)) {
    EXPECT_EQ(state[part + 2 * node], 0.0);
    EXPECT_EQ(state[part + 2 * node + 1], 0.0);
  }
}

TEST(DenseFlowStates, TissueInSiUnitsLosesNothing) {
  Scene scene = off_grid_beam(Mass::lumped);
  scene.mesh = rectangle({0.04, 0.02}, 3, 2);
  scene.material = {4000, 1500, 4000, 750, 1000, Mass::lumped};
  scene.fixes[0].nodes = nodes_of(scene.mesh.edge_groups.at("left"));
  scene.tractions[0].edges = scene.mesh.edge_groups.at("right");
  scene.tractions[0].keys = {{0.0, {100, 0}}};
  expect_agreement(scene, "tissue");
}

}  // namespace
}  // namespace rheo::test
