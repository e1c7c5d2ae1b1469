// Several bodies in one scene move as each does alone.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rheo/io/scene_file.hpp"
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

TEST(Bodies, OfOneMaterialAreServedByTheEdgeKernel) {
  const Simulation both(parse("[[body]]\n" + piece(block, "body.") + "[[body]]\n" + piece(wheel, "body.")));
  EXPECT_EQ(std::string(both.kernel()), "edge");
}

}  // namespace
}  // namespace rheo
