// The ways to the exact solution that bench takes for larger scenes, on one that the dense way still manages.
#include "bench_reference.hpp"

#include <gtest/gtest.h>

#include "rheo/shapes.hpp"
#include "support/exact.hpp"

namespace app_tests {
namespace {

// 66 nodes: just beyond what bench takes the dense way for.
rheo::Scene beam() {
  rheo::Scene scene;
  scene.mesh = rheo::rectangle({1.0, 0.25}, 22, 3);
  scene.material = {7, 5, 4, 2, 0.2, rheo::Mass::lumped};
  scene.fixes.push_back({rheo::nodes_of(scene.mesh.edge_groups.at("left")), rheo::Axis::both, {}, "left"});
  scene.tractions.push_back({scene.mesh.edge_groups.at("right"), {{0.0, {5.0, 1.0}}}, {0.0, 0.1}, "right"});
  scene.time.duration = 0.2;
  scene.time.frame_rate = 20;  // the traction ends on an output: few exponentials
  return scene;
}

double difference(const rheo::Scene& scene, app::Reference& reference) {
  app::Progress progress(app::Verbosity::quiet);
  reference = app::make_reference(scene, {}, 10.0, progress);
  app::check_reference(reference, scene, {}, 5.0, progress);
  app::Trajectory dense{reference.exact.times, {}};
  for (const auto& state : rheo::test::ExactSolution(scene).at(reference.exact.times)) {
    std::vector<double>& all = dense.states.emplace_back();
    for (const auto* part : {&state.u, &state.v, &state.w_lambda, &state.w_mu})
      all.insert(all.end(), part->begin(), part->end());
  }
  return app::run_error(dense, reference.exact);
}

TEST(BenchReference, ExponentialIsTheDenseSolution) {
  app::Reference reference;
  EXPECT_LT(difference(beam(), reference), 5e-12);  // the dense way's own rounding
  EXPECT_TRUE(reference.by_exponential());
  // What the check measured is what the reference says of itself, not the tolerance that it was asked for.
  const std::size_t at = reference.check.find("agrees to ");
  ASSERT_NE(at, std::string::npos) << reference.check;
  const double measured = std::stod(reference.check.substr(at + 10));
  EXPECT_NEAR(reference.uncertainty, std::max(measured, rheo::finest_tolerance), 0.06 * measured);
  EXPECT_LT(reference.uncertainty, 1e-7);
}

TEST(BenchReference, ExtrapolatedRk4IsAsExactAsItSays) {
  rheo::Scene scene = beam();
  scene.constraints.push_back({{{65, rheo::Axis::x, 1.0}, {21, rheo::Axis::x, -1.0}}, 0.0, "tie"});
  app::Reference reference;
  EXPECT_LT(difference(scene, reference), reference.uncertainty + 5e-12);
  EXPECT_LT(reference.uncertainty, 1e-6);
  EXPECT_FALSE(reference.by_exponential());
}

TEST(BenchReference, AnEventOffTheStepsDoesNotSpoilTheExtrapolation) {
  rheo::Scene scene = beam();
  scene.constraints.push_back({{{65, rheo::Axis::x, 1.0}, {21, rheo::Axis::x, -1.0}}, 0.0, "tie"});
  scene.tractions[0].window.until = 0.0871;
  app::Reference reference;
  EXPECT_LT(difference(scene, reference), reference.uncertainty + 5e-12);
  EXPECT_LT(reference.uncertainty, 1e-6);
}

}  // namespace
}  // namespace app_tests
