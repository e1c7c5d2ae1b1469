// A body that decays towards the smallest numbers leaves none of the denormal ones, which processors are slow
// with.

#include <gtest/gtest.h>

#include <cmath>
#include <span>

#include "kernels/flush_denormals.hpp"
#include "rheo/simulation.hpp"
#include "support/scenes.hpp"

namespace rheo::test {
namespace {

TEST(Denormals, AreLeftByNoIntegratorAndNoKernel) {
  {
    const FlushDenormals flush;
    if (!FlushDenormals::is_on()) GTEST_SKIP() << "this processor does not take denormal numbers for zero";
  }
  struct Way {
    IntegratorKind integrator;
    Kernel kernel;
    Mass mass;
  };
  for (const Way& way : {Way{IntegratorKind::rk4, Kernel::edge, Mass::lumped},
                         Way{IntegratorKind::rk4, Kernel::element, Mass::lumped},
                         Way{IntegratorKind::rk4, Kernel::csr, Mass::consistent},
                         Way{IntegratorKind::euler, Kernel::automatic, Mass::lumped},
                         Way{IntegratorKind::exponential, Kernel::automatic, Mass::lumped},
                         Way{IntegratorKind::implicit, Kernel::automatic, Mass::lumped}}) {
    Scene scene = paper_beam(way.mass);
    scene.mesh = rectangle({1.0, 0.25}, 13, 4);
    scene.fixes[0].nodes = nodes_of(scene.mesh.edge_groups.at("left"));
    scene.tractions[0] = {scene.mesh.edge_groups.at("right"), {{0.0, {1e-303, 1e-304}}}, {0.0, 0.2}, "pull"};
    scene.time.integrator = way.integrator;
    scene.time.duration = 4.0;
    Simulation simulation(scene, {.kernel = way.kernel, .energies = false});
    double smallest = 1.0;
    for (int k = 1; k <= 40; ++k) {
      ASSERT_FALSE(simulation.advance(0.1 * k));
      for (const std::span<const double> part :
           {simulation.u(), simulation.v(), simulation.w_lambda(), simulation.w_mu()}) {
        for (const double x : part) {
          ASSERT_NE(std::fpclassify(x), FP_SUBNORMAL) << x << " at " << simulation.time();
          if (x != 0.0) smallest = std::fmin(smallest, std::fabs(x));
        }
      }
    }
    EXPECT_LT(smallest, 1e-306);  // near enough to have met them
  }
}

}  // namespace
}  // namespace rheo::test
