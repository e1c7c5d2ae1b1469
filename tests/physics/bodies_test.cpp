// Several bodies in one scene move as each does alone.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rheo/error.hpp"
#include "rheo/io/scene_file.hpp"
#include "rheo/io/scene_text.hpp"
#include "rheo/simulation.hpp"

namespace rheo {
namespace {

struct Piece {
  std::string mesh;
  std::string items;  // with {0} in the place of "" or "body."
};

const Piece block{"shape = \"rectangle\"\nsize = [1.0, 0.5]\nnodes = [7, 4]\n",
                  "[[{0}fix]]\nedges = \"left\"\n[[{0}traction]]\nedges = \"right\"\nvector = [2.0, 1.0]\n"
                  "until = 0.3\n"};
const Piece wheel{"shape = \"disk\"\nradius = 0.4\nrings = 3\n",
                  "[[{0}move]]\nnodes = [0]\nkeys = [[0, 0, 0], [0.5, 0.1, 0.05]]\n"};

std::string material(const std::string& owner) {
  return fmt::format(
      "[{}material]\nlambda_ela = 70\nmu_ela = 50\nlambda_vis = 40\nmu_vis = 20\ndensity = 0.5\n", owner);
}

std::string piece(const Piece& p, const std::string& owner) {
  return fmt::format("[{}mesh]\n{}{}{}", owner, p.mesh, material(owner),
                     fmt::format(fmt::runtime(p.items), owner));
}

Scene parse(const std::string& text) {
  return parse_scene(text + "[body_force]\nacceleration = [0.0, -1.0]\n[time]\nduration = 1.0\nstep = 1e-3\n",
                     "bodies.toml", {});
}

double largest(std::span<const double> values) {
  double size = 0.0;
  for (const double x : values) size = std::max(size, std::abs(x));
  return size;
}

std::string error_of_kernel(const Scene& scene, Kernel kernel) {
  try {
    Simulation(scene, {.kernel = kernel});
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(Bodies, MoveAsEachDoesAlone) {
  Simulation both(parse("[[body]]\nposition = [3.0, -2.0]\n" + piece(block, "body.") +
                        "[[body]]\nposition = [-1.0, 0.5]\n" + piece(wheel, "body.")));
  std::size_t first = 0;
  for (const Piece& p : {block, wheel}) {
    Simulation alone(parse(piece(p, "")));
    for (const double t : {0.25, 0.5, 1.0}) {
      Simulation together(both.scene());
      ASSERT_FALSE(together.advance(t));
      ASSERT_FALSE(alone.advance(t));
      const auto compare = [&](const char* name, std::span<const double> one, std::span<const double> all) {
        const double size = largest(one);
        EXPECT_GT(size, 0.0) << name;
        // A thousand steps of rounding, and coordinates that differ in their last digits by the position.
        for (std::size_t i = 0; i < one.size(); ++i)
          ASSERT_NEAR(all[first + i], one[i], 1e-11 * size) << name << " " << i << " at " << t;
      };
      compare("u", alone.u(), together.u());
      compare("v", alone.v(), together.v());
      compare("w_lambda", alone.w_lambda(), together.w_lambda());
      compare("w_mu", alone.w_mu(), together.w_mu());
    }
    first += alone.u().size();
  }
}

// Thickness moves nothing, but weighs masses, forces and energies.
TEST(Bodies, OfDifferentThicknessWeighWhatEachDoesAlone) {
  const auto text = [](const Piece& p, const std::string& owner, const char* thickness) {
    return fmt::format("[{}mesh]\nthickness = {}\n{}{}{}", owner, thickness, p.mesh, material(owner),
                       fmt::format(fmt::runtime(p.items), owner));
  };
  const Scene scene =
      parse("[[body]]\nposition = [3.0, -2.0]\n" + text(block, "body.", "0.02") +
            "[[body.probe]]\nname = \"left\"\nedges = \"left\"\n[[body]]\n" + text(wheel, "body.", "0.7"));
  EXPECT_NE(error_of_kernel(scene, Kernel::edge).find("one thickness"), std::string::npos);
  for (const IntegratorKind integrator : {IntegratorKind::rk4, IntegratorKind::exponential}) {
    const auto alone = [&](Scene one) {
      one.time.integrator = integrator;
      Simulation simulation(std::move(one));
      EXPECT_FALSE(simulation.advance(0.4));
      return simulation;
    };
    Simulation thin =
        alone(parse(text(block, "", "0.02") + "[[probe]]\nname = \"left\"\nedges = \"left\"\n"));
    Simulation thick = alone(parse(text(wheel, "", "0.7")));
    const Energies a = thin.energies(), b = thick.energies();
    EXPECT_GT(b.kinetic + b.stored, a.kinetic + a.stored);
    for (const Kernel kernel : {Kernel::automatic, Kernel::csr, Kernel::element}) {
      Scene all = scene;
      all.time.integrator = integrator;
      Simulation both(all, {.kernel = kernel});
      ASSERT_FALSE(both.advance(0.4));
      const Energies e = both.energies();
      const double size = a.kinetic + a.stored + b.kinetic + b.stored;
      EXPECT_NEAR(e.kinetic, a.kinetic + b.kinetic, 1e-9 * size);
      EXPECT_NEAR(e.stored, a.stored + b.stored, 1e-9 * size);
      const Vec2 one = thin.read(thin.scene().probes[0]).force,
                 same = both.read(both.scene().probes[0]).force;
      EXPECT_NEAR(same.x, one.x, 1e-9 * std::abs(one.x));
      EXPECT_NEAR(same.y, one.y, 1e-9 * std::abs(one.y));
    }
  }
  // As a hand's session is saved: one mesh, a thickness a node.
  const Scene again = parse_scene(scene_text(scene), "again.toml", {});
  EXPECT_EQ(again.mesh.thickness_of_node, scene.mesh.thickness_of_node);
}

TEST(Bodies, OfOneMaterialAreServedByTheEdgeKernel) {
  const Simulation both(parse("[[body]]\n" + piece(block, "body.") + "[[body]]\n" + piece(wheel, "body.")));
  EXPECT_EQ(std::string(both.kernel()), "edge");
}

}  // namespace
}  // namespace rheo
