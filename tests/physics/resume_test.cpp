// A simulation goes on from another one's state, with its own parameters.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/live_scenes.hpp"

namespace rheo::test {
namespace {

double largest_difference(std::span<const double> a, std::span<const double> b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

// A clamp that ends, a traction with keys and a motion under way: all go on where they were.
TEST(Resume, WithTheSameParametersIsTheSameRun) {
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    Scene scene = live_block(mass);
    Move move;
    move.nodes = {scene.mesh.node_count() - 1};
    move.keys = {{0.0, {0.0, 0.0}, {}}, {0.2, {0.004, 0.002}, {}}};
    scene.moves.push_back(move);
    Simulation straight(scene), first(scene), second(scene);
    // 0.036 s: in the middle of all of it; 0.08 s: after the clamp; both at ends of steps.
    for (const double t : {0.036, 0.08}) {
      ASSERT_FALSE(straight.advance(t));
      ASSERT_FALSE(first.advance(t));
      second.resume(first.save());
      EXPECT_EQ(second.time(), t);
      std::swap(first, second);
    }
    ASSERT_FALSE(straight.advance(0.15));
    ASSERT_FALSE(first.advance(0.15));
    // Alike but for rounding: bases of motions are worked out anew.
    EXPECT_LT(largest_difference(straight.u(), first.u()), 1e-15);
    EXPECT_LT(largest_difference(straight.w_lambda(), first.w_lambda()), 1e-10);
    EXPECT_EQ(straight.held_dofs(), first.held_dofs());
  }
}

TEST(Resume, AnotherMaterialBeginsWithTheSameState) {
  const Scene scene = live_block(Mass::lumped);
  Live live(scene, live_settings(scene));
  for (int k = 0; k < 30; ++k) ASSERT_FALSE(live.tick());
  Scene other = scene;
  other.material.mu_ela *= 4.0;
  other.material.density *= 2.0;
  SavedState saved = live.simulation().save();
  saved.energies = live.simulation().energies();
  Live next(other, live_settings(other), saved);
  EXPECT_EQ(next.ticks(), 30);
  EXPECT_EQ(next.time(), live.time());
  EXPECT_EQ(largest_difference(live.simulation().u(), next.simulation().u()), 0.0);
  EXPECT_EQ(largest_difference(live.simulation().w_mu(), next.simulation().w_mu()), 0.0);
  const auto balance = [](const Live& of) {
    const Energies e = of.simulation().energies();
    return e.kinetic + e.stored + e.dissipated - e.work;
  };
  const Energies start = next.simulation().energies();
  const double before = start.kinetic + start.stored;
  EXPECT_NEAR(balance(next), balance(live), 1e-14 * start.work);
  for (int k = 0; k < 100; ++k) ASSERT_FALSE(next.tick());
  EXPECT_EQ(next.ticks(), 130);
  // RK4's order in its quadrature: what one step of a thirtieth of the fastest period makes of it.
  EXPECT_NEAR(balance(next), balance(live), 1e-3 * before);
}

// What the energies jump by is work of the change: twice the density, twice the kinetic energy; twice the
// moduli, half of what the same residual forces hold.
TEST(Resume, AChangesEnergyIsItsWork) {
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    const Scene scene = live_block(mass);
    Live live(scene, live_settings(scene));
    for (int k = 0; k < 30; ++k) {
      act(live, k);
      ASSERT_FALSE(live.tick());
    }
    const Energies before = live.simulation().energies();
    EXPECT_GT(before.kinetic, 0.0);
    EXPECT_GT(before.dissipated, 0.0);
    Scene heavy = scene, stiff = scene;
    heavy.material.density *= 2.0;
    stiff.material.lambda_ela *= 2.0, stiff.material.mu_ela *= 2.0;
    const auto after = [&](const Scene& other) {
      SavedState saved = live.simulation().save();
      saved.energies = before;
      return Live(other, live_settings(other), saved).simulation().energies();
    };
    const Energies with_mass = after(heavy), with_moduli = after(stiff), as_before = after(scene);
    const double rounding = 1e-13 * (before.work + before.kinetic + before.stored);
    EXPECT_NEAR(with_mass.work - before.work, before.kinetic, rounding);
    EXPECT_NEAR(with_moduli.work - before.work, -0.5 * before.stored, rounding);
    EXPECT_NEAR(as_before.work, before.work, rounding);
    for (const Energies& e : {with_mass, with_moduli, as_before}) EXPECT_EQ(e.dissipated, before.dissipated);
  }
}

}  // namespace
}  // namespace rheo::test
