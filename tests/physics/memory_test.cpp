// Memory a triangle: bounded, the same for a mesh of any size.

#include <gtest/gtest.h>

#include <ostream>

#include "rheo/shapes.hpp"
#include "rheo/simulation.hpp"
#include "support/allocation_count.hpp"

namespace rheo::test {
namespace {

Scene square(int cells) {
  Scene scene;
  scene.mesh = rectangle({1, 1}, cells + 1, cells + 1, Diagonal::alternating);
  scene.material = {7, 5, 4, 2, 0.2, Mass::lumped};
  scene.fixes.push_back({nodes_of(scene.mesh.edge_groups.at("left")), Axis::both, {}, ""});
  scene.tractions.push_back({scene.mesh.edge_groups.at("right"), {{0, {1, 0}}}, {}, ""});
  scene.time.duration = 1.0;
  return scene;
}

// Of a simulation that has made a step, its copy of the scene included.
Allocations memory_of(const Scene& scene, Kernel kernel) {
  const AllocationCount count;
  Simulation simulation(scene, {.kernel = kernel, .threads = 1});
  EXPECT_FALSE(simulation.advance(simulation.step_bound()));
  return count.so_far();
}

struct Bound {
  Kernel kernel;
  const char* name;
  double held;  // [bytes a triangle]
  double most;  // likewise, while it is made
};
void PrintTo(const Bound& bound, std::ostream* out) {
  *out << bound.name;
}

class MemoryATriangle : public ::testing::TestWithParam<Bound> {};

TEST_P(MemoryATriangle, IsBoundedForAMeshOfAnySize) {
  if (!can_count_allocations()) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  for (const int cells : {23, 71, 141}) {  // 1k, 10k, 40k triangles
    const Scene scene = square(cells);
    const Allocations memory = memory_of(scene, GetParam().kernel);
    const double triangles = scene.mesh.triangle_count();
    const double held = static_cast<double>(memory.held) / triangles;
    const double most = static_cast<double>(memory.most) / triangles;
    EXPECT_LE(held, GetParam().held) << triangles << " triangles";
    EXPECT_LE(most, GetParam().most) << triangles << " triangles";
    // The bound says something.
    EXPECT_GE(held, 0.7 * GetParam().held) << triangles << " triangles";
    EXPECT_GE(most, 0.7 * GetParam().most) << triangles << " triangles";
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, MemoryATriangle,
                         ::testing::Values(Bound{Kernel::edge, "edge", 650, 650},
                                           Bound{Kernel::element, "element", 560, 560},
                                           Bound{Kernel::csr, "csr", 900, 1450}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace rheo::test
