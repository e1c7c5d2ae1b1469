// The quick part of the stress matrix (rheo_stress runs all of it).

#include <gtest/gtest.h>

#include "stress_run.hpp"

namespace rheo::test {
namespace {

class Stress : public testing::TestWithParam<IntegratorKind> {};

TEST_P(Stress, NoPromiseIsBroken) {
  for (int number = 0; number < 40; ++number) {
    const StressScene scene = stress_scene(1, number);
    const StressOutcome outcome = stress(scene, GetParam(), {2000, 20});
    for (const std::string& text : outcome.broken)
      ADD_FAILURE() << number << " (" << scene.mesh << ", " << scene.material << ", " << scene.constraints
                    << "): " << text;
  }
}

// Modes of tiny triangles that hardly had a share in Lanczos' start; a tridiagonal matrix over so many
// decades that QR iteration does not end.
TEST(StressOfRk4, NoPromiseIsBrokenWhereOneWas) {
  for (const int number : {1405, 1625, 1629, 2309}) {
    const StressOutcome outcome = stress(stress_scene(1, number), IntegratorKind::rk4, {2000, 20});
    for (const std::string& text : outcome.broken) ADD_FAILURE() << number << ": " << text;
  }
}

INSTANTIATE_TEST_SUITE_P(Explicit, Stress, testing::Values(IntegratorKind::rk4),
                         [](const auto& i) { return i.param == IntegratorKind::rk4 ? "Rk4" : "Euler"; });

}  // namespace
}  // namespace rheo::test
