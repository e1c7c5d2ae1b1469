// The quick part of the stress matrix (rheo_stress runs all of it).

#include <gtest/gtest.h>

#include "stability/runs/stress_run.hpp"

namespace rheo::test {
namespace {

class Stress : public testing::TestWithParam<IntegratorKind> {};

StressScene settled_scene(int number) {
  StressScene scene = stress_scene(1, number);
  for (const Broken& each : settle(scene).broken) ADD_FAILURE() << number << ": " << each.text;
  return scene;
}

TEST_P(Stress, NoPromiseIsBroken) {
  for (int number = 0; number < 40; ++number) {
    const StressScene scene = settled_scene(number);
    const StressOutcome outcome = stress(scene, TrueSpectrum(scene.scene), GetParam(), {2000, 100, 20});
    for (const Broken& each : outcome.broken)
      ADD_FAILURE() << number << " (" << scene.mesh << ", " << scene.material << ", " << scene.constraints
                    << "): " << each.text;
  }
}

// Modes of tiny triangles that hardly had a share in Lanczos' start; a tridiagonal matrix over so many
// decades that QR iteration does not end; several materials that were too many for their eigenvalues; loads
// that constraints cancel, whose turnover excused what grew.
TEST(StressOfRk4, NoPromiseIsBrokenWhereOneWas) {
  for (const int number : {1405, 1625, 1629, 2309, 208, 555}) {
    const StressScene scene = settled_scene(number);
    const StressOutcome outcome = stress(scene, TrueSpectrum(scene.scene), IntegratorKind::rk4);
    for (const Broken& each : outcome.broken) ADD_FAILURE() << number << ": " << each.text;
  }
}

// Shears beside lambda's 1e8 times larger springs, whose stiffness was rounding (6, 261), and their damping
// (531); constraints that hold all of the body, with rounding's eigenvalues (447) or none (47); a
// constraint's own unstable pole, that the work excused (557).
TEST(StressOfEuler, NoPromiseIsBrokenWhereOneWas) {
  for (const int number : {6, 47, 261, 447, 531, 557}) {
    const StressScene scene = settled_scene(number);
    const StressOutcome outcome = stress(scene, TrueSpectrum(scene.scene), IntegratorKind::euler);
    for (const Broken& each : outcome.broken) ADD_FAILURE() << number << ": " << each.text;
  }
}

INSTANTIATE_TEST_SUITE_P(Explicit, Stress, testing::Values(IntegratorKind::rk4, IntegratorKind::euler),
                         [](const auto& i) { return i.param == IntegratorKind::rk4 ? "Rk4" : "Euler"; });

}  // namespace
}  // namespace rheo::test
